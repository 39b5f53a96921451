// An OPC UA client of others looks at the twin: it finds the machine by types, follows its axes while the program runs,
// operates it, and reads what was. What it has seen goes to a file as JSON; the test compares it with the program.
//
//   node judge.js ADDRESS FILE
"use strict";
const fs = require("fs");
const {
  AttributeIds, BrowseDirection, ClientSubscription, DataType, MessageSecurityMode, NodeClass,
  OPCUAClient, SecurityPolicy, TimestampsToReturn, Variant, constructEventFilter,
} = require("node-opcua-client");

const address = process.argv[2];
const SAMPLING = 20;
const CNC = "http://opcfoundation.org/UA/CNC";

const pause = (ms) => new Promise((done) => setTimeout(done, ms));

async function references(session, nodeId, direction = BrowseDirection.Forward, referenceTypeId = "HierarchicalReferences") {
  const found = await session.browse({
    nodeId, browseDirection: direction, referenceTypeId, includeSubtypes: true, nodeClassMask: 0, resultMask: 63,
  });
  return found.references;
}

/** All objects below a node whose type has a browse name, with their names. */
async function ofType(session, root, wanted, depth = 4) {
  const found = [];
  for (const child of await references(session, root)) {
    if (child.nodeClass !== NodeClass.Object) continue;
    const types = await references(session, child.nodeId, BrowseDirection.Forward, "HasTypeDefinition");
    if (types.some((type) => type.browseName.name === wanted)) found.push(child);
    else if (depth > 0) found.push(...(await ofType(session, child.nodeId, wanted, depth - 1)));
  }
  return found;
}

async function child(session, nodeId, ...names) {
  let node = nodeId;
  for (const name of names) {
    const next = (await references(session, node)).find((each) => each.browseName.name === name);
    if (!next) throw new Error(`${node} has no ${name}`);
    node = next.nodeId;
  }
  return node;
}

const read = async (session, nodeId) => (await session.read({ nodeId, attributeId: AttributeIds.Value })).value.value;

const step = (what) => process.stderr.write(`${what}\n`);

async function main() {
  const client = OPCUAClient.create({
    endpointMustExist: false, connectionStrategy: { maxRetry: 1 },
    securityMode: MessageSecurityMode.None, securityPolicy: SecurityPolicy.None,
  });
  await client.connect(address);
  const session = await client.createSession();
  const seen = { axes: {}, positions: {}, lost: 0, messages: [] };
  seen.namespaces = await session.readNamespaceArray();

  step("find");
  const [cnc] = await ofType(session, "i=85", "CncInterfaceType", 0);
  const axes = await ofType(session, cnc.nodeId, "CncAxisType");
  const [channel] = await ofType(session, cnc.nodeId, "CncChannelType");
  const [spindle] = await ofType(session, cnc.nodeId, "CncSpindleType");
  const [machine] = await ofType(session, "i=85", "MachineToolType");
  seen.machine = machine.browseName.name;
  seen.tools = (await ofType(session, machine.nodeId, "ToolType")).map((each) => each.browseName.name);
  seen.job = (await ofType(session, machine.nodeId, "ProductionJobType")).length;
  seen.prognosis = await read(
    session, await child(session, machine.nodeId, "Notification", "Prognoses", "JobEnd", "PredictedTime"));
  seen.sinumerik = {};
  for (const path of ["/Channel/GeometricAxis/actToolBasePos[u1,1]", "/Channel/MachineAxis/name[u1,4]",
    "/Channel/Spindle/actSpeed[u1,1]", "/Channel/ProgramInfo/block[u1,2]"]) {
    const value = await session.read({ nodeId: `ns=2;s=${path}`, attributeId: AttributeIds.Value });
    seen.sinumerik[path] = value.statusCode.name;
  }

  // The client first learns the structure of positions, for which it browses all data types.
  seen.structure = await read(session, await child(session, axes[0].nodeId, "PosDirect"));
  step("subscribe");
  const subscription = ClientSubscription.create(session, {
    requestedPublishingInterval: SAMPLING, requestedLifetimeCount: 1000, requestedMaxKeepAliveCount: 50,
    maxNotificationsPerPublish: 0, publishingEnabled: true, priority: 1,
  });
  const monitor = (itemToMonitor, parameters) =>
    subscription.monitor(itemToMonitor, { discardOldest: true, ...parameters }, TimestampsToReturn.Both);
  const microseconds = (value) => value.sourceTimestamp.getTime() * 1000 + (value.sourcePicoseconds || 0) / 1e6;
  const follow = async (nodeId, into, extract) => {
    const item = await monitor({ nodeId, attributeId: AttributeIds.Value }, { samplingInterval: SAMPLING, queueSize: 1000 });
    item.on("changed", (value) => {
      if (value.statusCode.hasOverflowBit) seen.lost += 1;
      into.push([microseconds(value), extract(value.value.value)]);
    });
    return item;
  };
  // The client decodes structures of one message while it takes the next one, and may tell that first: the order in
  // which values came is that of the messages.
  const messages = [];
  subscription.on("raw_notification", (message) => messages.push(message));
  const numbersInOrder = (item) => messages
    .flatMap((message) => message.notificationData).flatMap((told) => told.monitoredItems || [])
    .filter((told) => told.clientHandle === item.monitoringParameters.clientHandle)
    .map(({ value }) => [microseconds(value), value.value.value]);
  const items = {};
  for (const axis of axes) {
    const name = axis.browseName.name;
    seen.axes[name] = { rotational: await read(session, await child(session, axis.nodeId, "IsRotational")), values: [] };
    seen.positions[name] = [];
    const position = await child(session, axis.nodeId, "PosDirect");
    items[name] = await follow(await child(session, position, "ActPos"), seen.axes[name].values, (value) => value);
    await follow(position, seen.positions[name], (value) => [value.actPos, value.remDist]);
  }
  seen.speeds = [];
  await follow(await child(session, spindle.nodeId, "ActSpeed"), seen.speeds, (value) => value);
  seen.blocks = [];
  await follow(await child(session, channel.nodeId, "ActProgramBlock"), seen.blocks, (value) => value);
  seen.status = [];
  const statusNode = await child(session, channel.nodeId, "ActProgramStatus");
  await follow(statusNode, seen.status, (value) => value);
  const filter = constructEventFilter(["Message", "EventType"]);
  const events = await monitor(
    { nodeId: channel.nodeId, attributeId: AttributeIds.EventNotifier }, { samplingInterval: 0, queueSize: 100, filter });
  events.on("changed", (fields) => seen.messages.push(fields[0].value.text));

  const [twin] = (await references(session, "i=85")).filter((each) => each.browseName.name === "Twin");
  const call = async (name) => {
    const methodId = await child(session, twin.nodeId, name);
    return (await session.call({ objectId: twin.nodeId, methodId, inputArguments: [] })).statusCode.name;
  };
  const write = async (nodeId, value, dataType = DataType.Double) =>
    (await session.write({
      nodeId, attributeId: AttributeIds.Value, value: { value: new Variant({ dataType, value }) },
    })).name;
  const override = await child(session, channel.nodeId, "CmdOverride");

  step("operate");
  const started = Date.now();
  seen.calls = { holdBefore: await call("Hold") };
  // With the override at 0 the program runs and goes nowhere, so that nothing here depends on how fast the computer is.
  seen.writes = { none: await write(override, 0) };
  seen.calls.start = await call("Start");
  seen.calls.again = await call("Start");
  seen.runningStatus = await read(session, statusNode);
  seen.calls.hold = await call("Hold");
  seen.heldStatus = await read(session, statusNode);
  const timeNode = await child(session, twin.nodeId, "ProgramTime");
  Object.assign(seen.writes, {
    half: await write(override, 50), actual: await read(session, await child(session, channel.nodeId, "ActOverride")),
    tooMuch: await write(override, 101), text: await write(override, "50", DataType.String), full: await write(override, 100),
    position: await write(await child(session, axes[0].nodeId, "PosDirect", "ActPos"), 1),
    name: (await session.write({
      nodeId: override, attributeId: AttributeIds.DisplayName,
      value: { value: new Variant({ dataType: DataType.LocalizedText, value: { text: "x" } }) },
    })).name,
  });
  step("go on");
  seen.calls.goOn = await call("Start");
  const duration = await read(session, await child(session, twin.nodeId, "Duration"));
  const deadline = Date.now() + 60000;
  while ((await read(session, await child(session, twin.nodeId, "State"))) !== "ended") {
    if (Date.now() > deadline) throw new Error(`not ended after a minute: ${await read(session, timeNode)} of ${duration} s`);
    await pause(50);
  }
  step("ended");
  seen.duration = duration;
  seen.end = await read(session, timeNode);
  seen.history = {};
  for (const axis of axes) {
    const name = axis.browseName.name;
    const nodeId = await child(session, axis.nodeId, "PosDirect", "ActPos");
    const result = await session.readHistoryValue({ nodeId }, new Date(started - 1000), new Date(Date.now() + 1000));
    const values = result.historyData.dataValues.map((value) => value.value.value);
    seen.history[name] = values;
    // What has been told may still be on its way when the program has ended.
    const arrived = () => [seen.axes[name].values, seen.positions[name].map(([at, [value]]) => [at, value])]
      .every((told) => told.length > 0 && told[told.length - 1][1] === values[values.length - 1]);
    while (!arrived() && Date.now() < deadline) await pause(50);
    seen.axes[name].values = numbersInOrder(items[name]);
    seen.positions[name].sort(([one], [other]) => one - other);
  }
  const blockNode = await child(session, channel.nodeId, "ActProgramBlock");
  const ran = await session.readHistoryValue({ nodeId: blockNode }, new Date(started - 1000), new Date(Date.now() + 1000));
  seen.ran = ran.historyData.dataValues.map((value) => [microseconds(value), value.value.value]);
  step("reset");
  seen.calls.reset = await call("Reset");
  seen.afterReset = await read(session, timeNode);
  seen.status.sort(([one], [other]) => one - other);
  await subscription.terminate();
  await session.close();
  await client.disconnect();
  fs.writeFileSync(process.argv[3], JSON.stringify(seen));
}

main().then(() => process.exit(0), (error) => { console.error(error); process.exit(1); });
