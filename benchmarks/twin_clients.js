// Many OPC UA clients follow a twin: node twin_clients.js ADDRESS CLIENTS ITEMS MILLISECONDS SECONDS MODULES FILE
//
// Each client subscribes to as many items, over all numbers of the machine that change. What each was told is compared
// by the time of the value: between the first and the last moment at which all had begun, every client must have every
// value of every node, and all that the history of the axes has. FILE takes the result as JSON.
"use strict";
const fs = require("fs");
const { createRequire } = require("module");
const [address, clients, items, interval, seconds, modules, file] = process.argv.slice(2);
const {
  AttributeIds, ClientSubscription, MessageSecurityMode, OPCUAClient, SecurityPolicy, TimestampsToReturn,
} = createRequire(`${modules}/package.json`)("node-opcua-client");

const PARTS = ["ActPos", "CmdPos", "RemDist"];
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

/** Paths of numbers that change while a five-axis program runs. */
function paths() {
  const found = [];
  for (const axis of ["X", "Y", "Z", "B", "C"])
    for (const measured of ["PosDirect", "PosIndirect"])
      for (const part of PARTS) found.push(`CncInterface.CncAxisList.${axis}.${measured}.${part}`);
  for (const frame of ["Wcs", "Bcs"])
    for (const axis of ["X", "Y", "Z", "B", "C"])
      for (const part of PARTS) found.push(`CncInterface.CncChannelList.Channel1.PosTcp${frame}${axis}.${part}`);
  return [...found, "Twin.ProgramTime", "CncInterface.CncChannelList.Channel1.ActFeedrate"];
}

async function follow(space) {
  const client = OPCUAClient.create({
    endpointMustExist: false, securityMode: MessageSecurityMode.None, securityPolicy: SecurityPolicy.None,
  });
  await client.connect(address);
  const session = await client.createSession();
  const subscription = ClientSubscription.create(session, {
    requestedPublishingInterval: Number(interval), requestedLifetimeCount: 1000, requestedMaxKeepAliveCount: 50,
    maxNotificationsPerPublish: 0, publishingEnabled: true, priority: 1,
  });
  const names = paths();
  const wanted = Array.from({ length: Number(items) }, (_, k) => names[k % names.length]);
  const told = wanted.map(() => []);
  let lost = 0;
  const group = await subscription.monitorItems(
    wanted.map((name) => ({ nodeId: `ns=${space};s=${name}`, attributeId: AttributeIds.Value })),
    { samplingInterval: Number(interval), discardOldest: true, queueSize: 1000 }, TimestampsToReturn.Source);
  group.on("changed", (_item, value, index) => {
    if (value.statusCode.hasOverflowBit) lost += 1;
    told[index].push(value.sourceTimestamp.getTime() * 1000 + (value.sourcePicoseconds || 0) / 1e6, value.value.value);
  });
  return { client, session, subscription, wanted, told, begun: Date.now(), lost: () => lost };
}

/** Times and values in turn that the server has kept of a node, all of them: an answer has 10,000 at most. */
async function history(session, nodeId, first, last) {
  const found = [];
  for (let from = first; ; ) {
    const read = await session.readHistoryValue({ nodeId }, new Date(from / 1000), new Date(last / 1000));
    const values = read.historyData.dataValues.map((value) => [
      value.sourceTimestamp.getTime() * 1000 + (value.sourcePicoseconds || 0) / 1e6, value.value.value,
    ]).filter(([time]) => !found.length || time > found[found.length - 2]);
    if (!values.length) return found;
    found.push(...values.flat());
    from = found[found.length - 2];
  }
}

async function main() {
  const probe = OPCUAClient.create({ endpointMustExist: false, keepSessionAlive: true });
  await probe.connect(address);
  const session = await probe.createSession();
  const space = (await session.readNamespaceArray()).indexOf("urn:trunnion:twin");
  const all = [];
  for (let k = 0; k < Number(clients); k++) all.push(await follow(space));
  await pause(2000);
  const first = Date.now() * 1000;
  await pause(Number(seconds) * 1000);
  const last = (Date.now() - 1000) * 1000;
  // A computer that has other work as well may still have values of the window on their way.
  const whole = (each) => each.told.every((list) => list.length < 4 || list[list.length - 2] > last);
  for (let waited = 0; waited < 60 && !all.every(whole); waited++) await pause(1000);
  const kept = {};
  for (const axis of ["X", "Y", "Z", "B", "C"]) {
    const name = `CncInterface.CncAxisList.${axis}.PosDirect.ActPos`;
    kept[name] = await history(session, `ns=${space};s=${name}`, first, last);
  }
  // Times and values in turn, of the window alone.
  const inWindow = (list) => list.filter((_, k) => first <= list[k - (k % 2)] && list[k - (k % 2)] <= last);
  /** How many pairs of one list are not in another; both are in the order of time. */
  const absent = (wanted, seen) => {
    let count = 0, place = 0;
    for (let k = 0; k < wanted.length; k += 2) {
      while (place < seen.length && seen[place] < wanted[k]) place += 2;
      if (seen[place] !== wanted[k] || seen[place + 1] !== wanted[k + 1]) count += 1;
    }
    return count;
  };
  const reference = new Map();
  let missed = 0, values = 0;
  for (const each of all) each.told = each.told.map(inWindow);
  for (const each of all)
    each.wanted.forEach((name, index) => {
      values += each.told[index].length / 2;
      if (each.told[index].length > (reference.get(name) || []).length) reference.set(name, each.told[index]);
    });
  for (const each of all)
    each.wanted.forEach((name, index) => {
      missed += absent(reference.get(name) || [], each.told[index]) + absent(each.told[index], reference.get(name) || []);
    });
  let behind = 0, compared = 0;
  for (const [name, list] of Object.entries(kept)) {
    const told = reference.get(name) || [], own = inWindow(list);
    behind += absent(own, told) + absent(told, own);
    compared += own.length / 2;
  }
  const lost = all.reduce((sum, each) => sum + each.lost(), 0);
  fs.writeFileSync(file, JSON.stringify({
    values, missed, behind, compared, lost, seconds: (last - first) / 1e6, nodes: reference.size,
    stamps: (reference.get("Twin.ProgramTime") || []).length / 2,
  }));
  process.exit(0);
}

main().catch((error) => { console.error(error); process.exit(1); });
