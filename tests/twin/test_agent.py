"""The MTConnect agent: its documents by the rules of the standard, its numbers, and texts that mean it harm."""

import xml.etree.ElementTree as ET
from contextlib import suppress
from datetime import UTC, datetime

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.support.agents import NOW, Document, asked, with_agent
from tests.support.examples import examples
from tests.support.twins import HUB_ROUGH
from trunnion.jobs.twin.serving import twin_program
from trunnion.twin.mtconnect.agent import MTConnectAgent
from trunnion.twin.mtconnect.buffer import ObservationBuffer
from trunnion.twin.mtconnect.device import device_model
from trunnion.twin.mtconnect.paths import selected
from trunnion.twin.mtconnect.request_errors import RequestError
from trunnion.twin.mtconnect.shdr import shown_text
from trunnion.twin.snapshots import TwinProgram, displayed

#: What some events may say, by the schema.
WORDS = {
    "Availability": {"AVAILABLE", "UNAVAILABLE"},
    "EmergencyStop": {"ARMED", "TRIGGERED", "UNAVAILABLE"},
    "AxisState": {"HOME", "TRAVEL", "PARKED", "STOPPED", "UNAVAILABLE"},
    "Direction": {"CLOCKWISE", "COUNTER_CLOCKWISE", "POSITIVE", "NEGATIVE", "UNAVAILABLE"},
    "ControllerMode": {"AUTOMATIC", "MANUAL", "MANUAL_DATA_INPUT", "SEMI_AUTOMATIC", "EDIT", "UNAVAILABLE"},
    "Execution": {
        "READY", "ACTIVE", "INTERRUPTED", "FEED_HOLD", "STOPPED", "OPTIONAL_STOP", "PROGRAM_STOPPED",
        "PROGRAM_COMPLETED", "WAIT", "UNAVAILABLE",
    },
}  # fmt: skip


@pytest.fixture(scope="module")
def program() -> TwinProgram:
    return twin_program(HUB_ROUGH, machine="yl569")


def refused(agent: MTConnectAgent, target: str) -> tuple[str, int]:
    """Return the code of a refusal, as its document has it, and the status of HTTP."""
    with pytest.raises(RequestError) as raised:
        agent.respond(target)
    (error,) = Document(agent.error(raised.value)).root.iterfind("Errors/Error")
    assert error.text
    return str(error.get("errorCode")), int(raised.value.status)


def test_documents_hold_by_the_standard(program: TwinProgram) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        probe = asked(agent, "/probe").root
        items = {item.get("id", ""): item for item in probe.iter("DataItem")}
        owners = {item.get("id", ""): owner for owner in probe.iter() for item in owner.findall("DataItems/DataItem")}
        identifiers = [each.get("id") for each in probe.iter() if each.get("id")]
        assert len(identifiers) == len(set(identifiers))
        assert {item.get("type") for item in items.values()} >= {
            "AVAILABILITY", "EXECUTION", "PROGRAM", "BLOCK", "LINE_NUMBER", "PATH_FEEDRATE", "ROTARY_VELOCITY",
            "TOOL_NUMBER", "POSITION", "ANGLE", "SYSTEM", "CONTROLLER_MODE",
        }  # fmt: skip
        everything = asked(agent, f"/sample?count={agent.buffer.size}")
        for document in (asked(agent, "/current"), everything):
            (device,) = document.root.iterfind("Streams/DeviceStream")
            assert (device.get("name"), device.get("uuid")) == ("yl569", "trunnion-twin-yl569")
            for component in device:
                for group in component:
                    for each in group:
                        item, owner = items[each.get("dataItemId", "")], owners[each.get("dataItemId", "")]
                        kind = item.get("type", "")
                        assert (component.get("component"), component.get("componentId")) == (
                            owner.tag,
                            owner.get("id"),
                        )
                        assert each.get("subType") == item.get("subType")
                        datetime.strptime(each.get("timestamp", ""), "%Y-%m-%dT%H:%M:%S.%fZ")
                        if item.get("category") == "CONDITION":
                            assert group.tag == "Condition"
                            assert each.tag in ("Normal", "Warning", "Fault", "Unavailable")
                            assert each.get("type") == kind
                            continue
                        assert group.tag == {"SAMPLE": "Samples", "EVENT": "Events"}[item.get("category", "")]
                        assert each.tag == kind.title().replace("_", "")
                        text = each.text or ""
                        assert each.tag not in WORDS or text in WORDS[each.tag]
                        if group.tag == "Samples" and text != "UNAVAILABLE":
                            assert len([float(part) for part in text.split()]) == (
                                3 if "3D" in item.get("units", "") else 1
                            )
        assert {each.get("dataItemId") for each in asked(agent, "/current").observations()} == set(items)
        numbers = [int(each.get("sequence", 0)) for each in everything.observations()]
        assert numbers == list(range(1, agent.buffer.next))
        stamps = [each.get("timestamp", "") for each in everything.observations() if each.get("name") == "line"]
        assert stamps[1:] == sorted(stamps[1:])

    with_agent(program, judge, run=True)


def test_the_history_has_every_end_of_a_block(program: TwinProgram) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        everything, run = asked(agent, f"/sample?count={agent.buffer.size}"), agent.program.run
        for column, axis in enumerate(run.machine.axes):
            told = [float(value) for value in everything.values(f"{axis.name}_actual") if value != "UNAVAILABLE"]
            place = 0
            for wanted in displayed(run.machine, column, run.joints[:, column]).tolist():
                place = next(k for k in range(place, len(told)) if abs(told[k] - wanted) < 1e-9)
        assert everything.values("exec") == ["UNAVAILABLE", "READY", "ACTIVE", "PROGRAM_COMPLETED"]
        assert everything.values("message")[1:] == ["METHOD"]
        assert everything.values("block")[-1] == "N780 M30"
        assert asked(agent, "/current").values("line") == ["78"]
        # The adapter tells the feed in mm/min, which an agent makes mm/s of.
        wanted = max(float(value) for value in agent.program.timed.at(agent.program.timed.ends, None).feed) / 60.0
        assert max(float(value) for value in everything.values("feed")[1:]) == pytest.approx(wanted)

    with_agent(program, judge, run=True)


def test_a_fault_names_its_axis_until_it_is_over(program: TwinProgram) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        await agent.alarm("travel B", "axis B <is> beyond\nits travel", datetime.fromtimestamp(NOW, UTC))
        path = "/current?path=//Rotary[@name='B']"
        (fault,) = (each for each in asked(agent, path).observations() if each.get("type") == "POSITION")
        assert (fault.tag, fault.get("nativeCode"), fault.text) == (
            "Fault",
            "travel B",
            "axis B <is> beyond its travel",
        )
        await agent.alarm_over("travel B", "", datetime.fromtimestamp(NOW, UTC))
        assert [each.tag for each in asked(agent, path).observations() if each.get("type")] == ["Normal"]

    with_agent(program, judge)


@settings(max_examples=examples(60))
@given(
    keys=st.lists(st.sampled_from("abc"), min_size=1, max_size=40), kept=st.integers(1, 12),
    start=st.integers(0, 12), most=st.integers(1, 12), wanted=st.sets(st.sampled_from("abc")),
)  # fmt: skip
def test_numbers_are_those_of_a_list(keys: list[str], kept: int, start: int, most: int, wanted: set[str]) -> None:
    buffer, told = ObservationBuffer(kept), list(enumerate(keys, 1))
    for number, key in told:
        buffer.add(datetime.fromtimestamp(NOW, UTC), key, str(number))
    left = told[-kept:]
    assert (buffer.first, buffer.last, buffer.next) == (left[0][0], len(told), len(told) + 1)
    begin = min(buffer.first + start, buffer.next)
    found, following = buffer.forward(begin, buffer.last, most, wanted)
    of_list = [number for number, key in left if number >= begin and key in wanted]
    assert [each.sequence for each in found] == of_list[:most]
    assert following == (of_list[most - 1] + 1 if len(of_list) >= most else buffer.next)
    # Whoever goes on with the next number reads each observation once.
    read, place = [], buffer.first
    while place < buffer.next:
        found, place = buffer.forward(place, buffer.last, most, wanted)
        read += [each.sequence for each in found]
    assert read == [number for number, key in left if key in wanted]
    back, place = [], buffer.last
    while place != buffer.next:
        found, place = buffer.backward(place, most, wanted)
        back += [each.sequence for each in reversed(found)]
    assert back == read[::-1]
    for at in range(buffer.first, buffer.next):
        latest = {each.key: each.sequence for each in buffer.latest(at)}
        assert latest == {key: number for number, key in told if number <= at}


def test_what_is_no_request_is_refused_as_the_standard_says(program: TwinProgram) -> None:
    wanted = {
        ("INVALID_URI", 404): ["/foo", "/probe/current/sample", "/yl569/foo", "/yl569/yl569/probe"],
        ("INVALID_URI", 400): ["", "probe", "//probe", "*"],
        ("NO_DEVICE", 404): ["/other/probe", "/%3Cother%3E/current"],
        ("ASSET_NOT_FOUND", 404): ["/assets/1", "/asset/x"],
        ("UNSUPPORTED", 400): ["/current?frequency=1", "/probe?deviceType=Agent"],
        ("INVALID_REQUEST", 400): [
            "/probe?at=1", "/current?at=x", "/current?at=", "/current?at", "/current?at=1&at=2", "/current?from=1",
            "/current?at=1&interval=1", "/current?interval=0", "/current?interval=-1", "/sample?count=1.5",
            "/sample?count=\u0663", "/sample?heartbeat=10", "/sample?interval=-1", "/sample?interval=9999999999",
            "/sample?interval=1&heartbeat=0", "/sample?count=-1&interval=1", "/sample?count=-1&to=5",
            "/sample?from=5&to=3", "/sample?from=0x5", "/current?" + "&".join(f"a{k}=1" for k in range(50)),
            "/sample?count=" + "9" * 5000,
        ],
        ("INVALID_PATH", 400): [
            "/current?path=", "/current?path=Axes", "/current?path=//Foo", "/sample?path=//Axes[1]",
            "/current?path=//Axes|", "/current?path=" + "//*" * 500, "/current?path=count(//Axes)",
        ],
        ("OUT_OF_RANGE", 404): [
            "/current?at=0", "/current?at=-1", "/current?at=9999", "/sample?from=9999", "/sample?from=-2",
            "/sample?count=0", "/sample?count=5001", "/sample?count=-5001", "/sample?to=9999",
        ],
    }  # fmt: skip

    async def judge(agent: MTConnectAgent) -> None:
        found = {target: refused(agent, target) for targets in wanted.values() for target in targets}
        assert found == {target: told for told, targets in wanted.items() for target in targets}
        for target in ("/", "/probe", "/yl569", "/yl569/probe/", "/trunnion-twin-yl569/probe"):
            assert asked(agent, target).kind == "Devices"
        assert asked(agent, "/assets").kind == "Assets"
        # The next one may be asked for before it is there.
        following = agent.buffer.next
        assert asked(agent, f"/sample?from={following}").sequences == [1, following - 1, following]
        assert asked(agent, f"/sample?from={following}").observations() == []
        assert refused(agent, f"/sample?from={following + 1}") == ("OUT_OF_RANGE", 404)

    with_agent(program, judge)


def test_what_is_not_kept_any_more_is_out_of_range(program: TwinProgram) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        first = agent.buffer.first
        assert first > 1
        assert refused(agent, f"/sample?from={first - 1}") == ("OUT_OF_RANGE", 404)
        assert refused(agent, f"/current?at={first - 1}") == ("OUT_OF_RANGE", 404)
        oldest = asked(agent, f"/current?at={first}")
        assert len(oldest.observations()) == len(asked(agent, "/current").observations())
        assert asked(agent, "/sample?from=0").sequences == [first, agent.buffer.last, agent.buffer.next]
        assert len(asked(agent, "/sample?count=-40").observations()) == 40
        assert len(asked(agent, "/sample").observations()) == 40

    with_agent(program, judge, 40, run=True)


def test_paths_select_what_xpath_does(program: TwinProgram) -> None:
    model = device_model(program)

    def names(path: str) -> set[str]:
        return {item.get("name", "") for item in selected(model, path)}

    assert names("//Linear[@name='X']") == {"X_actual", "X_state", "X_travel"}
    assert names('//m:Axes//m:Linear/m:DataItems/m:DataItem[@type="POSITION" and @category="SAMPLE"]') == {
        "X_actual", "Y_actual", "Z_actual"
    }  # fmt: skip
    assert names("//DataItem[@type='BLOCK' or @type='EXECUTION']|//*[@id='d_avail']") == {"block", "exec", "avail"}
    assert names("/Device/DataItems/DataItem") == {"avail"}
    assert names("//Path[@name='path']//DataItem[@category='SAMPLE'][@type='PATH_FEEDRATE']") == {"feed"}
    assert names("//Controller") > names("//Path") > {"tool", "line"}
    assert names("//Device") == {item.get("name", "") for item in model.iter("DataItem")}


@settings(max_examples=examples(200))
@given(
    st.lists(
        st.sampled_from(
            ["/", "//", "*", "Axes", "DataItem", "[", "]", "@name", "=", "'X'", '"', "and", "|", " ", ":", "é"]
        ),
        max_size=12,
    ).map("".join)
)
def test_no_path_does_harm(path: str) -> None:
    with suppress(RequestError):
        assert selected(ET.fromstring("<Device><DataItems><DataItem name='X'/></DataItems></Device>"), path)


@settings(max_examples=examples(6))
@given(texts=st.lists(st.text(max_size=20), max_size=10))
@example(texts=['</Message><Fault x="1">&amp;]]>', "\ufffe\0\ud800\x85a\r\n b"])
def test_no_text_of_a_program_changes_a_document(program: TwinProgram, texts: list[str]) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        for text in texts:
            await judge_text(agent, text)

    async def judge_text(agent: MTConnectAgent, text: str) -> None:
        stamp = datetime.fromtimestamp(NOW, UTC)
        agent.tell(stamp, {"block": text, "program": text, "tool": text})
        await agent.message(text, stamp)
        await agent.alarm(text, text, stamp)
        document = asked(agent, "/current")
        for name in ("block", "program", "tool", "message", "system"):
            assert document.values(name) == [shown_text(text)]
        assert len(document.observations()) == len(list(asked(agent, "/probe").root.iter("DataItem")))

    with_agent(program, judge)
