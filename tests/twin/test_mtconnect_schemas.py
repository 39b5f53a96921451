"""What MTConnect is told holds by the published schemas of the standard."""

from datetime import UTC, datetime
from types import SimpleNamespace
from typing import Any, cast

import pytest

from tests.support.agents import NOW, with_agent
from tests.support.mtconnect_schemas import schema_faults
from tests.support.twins import HUB_ROUGH
from trunnion.jobs.twin.serving import twin_program
from trunnion.machines import load_machine, shipped_machines
from trunnion.twin.mtconnect.agent import MTConnectAgent
from trunnion.twin.mtconnect.device import device_xml
from trunnion.twin.mtconnect.request_errors import RequestError
from trunnion.twin.snapshots import TwinProgram

#: Requests of all kinds; some are refused.
REQUESTS = (
    "/probe", "/current", "/current?at=100", "/current?path=//Linear", "/sample", "/sample?count=5000",
    "/sample?count=-7", "/sample?from=3&to=9", "/sample?path=//Controller", "/assets", "/nothing", "/other/probe",
    "/assets/1", "/current?at=0", "/current?path=//Nothing", "/current?path=", "/sample?count=x", "/sample?from=99999",
    "/current?frequency=1", "/%00%01<>&?a=%22",
)  # fmt: skip

#: Texts that a document of a program or of a client may hold.
HARMFUL = "\x00<!--|--&]]>\ufffe\ud800\r\n\t'\"" + "é部" * 200

#: What a document says, and what no document may.
FAULTS = {
    "ACTIVE": "RUNNING", 'sequence="5"': 'sequence="0"', "Samples>": "Sample>", "Condition>": "Conditions>",
    'nextSequence="': 'next="', "dataItemId=": "item=", "<Header ": "<Head ",
}  # fmt: skip


@pytest.fixture(scope="module")
def program() -> TwinProgram:
    return twin_program(HUB_ROUGH, machine="yl569")


def answer(agent: MTConnectAgent, target: str) -> bytes:
    try:
        found = agent.respond(target)
    except RequestError as refusal:
        return agent.error(refusal)
    assert isinstance(found, bytes)
    return found


def test_all_documents_of_an_agent_are_valid(program: TwinProgram) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        stamp = datetime.fromtimestamp(NOW, UTC)
        await agent.alarm("travel B", HARMFUL, stamp)
        await agent.alarm(HARMFUL, HARMFUL, stamp)
        await agent.message(HARMFUL, stamp)
        found = {target: schema_faults(answer(agent, target)) for target in REQUESTS}
        assert {target: faults for target, faults in found.items() if faults} == {}

    with_agent(program, judge, run=True)


def test_the_devices_of_all_machines_are_valid(program: TwinProgram) -> None:
    found = {}
    for key in shipped_machines():
        of_machine = cast("TwinProgram", SimpleNamespace(machine=load_machine(key)))
        found[key] = schema_faults(device_xml(of_machine).encode())
    assert {key: faults for key, faults in found.items() if faults} == {}


def test_the_schemas_find_what_is_wrong(program: TwinProgram) -> None:
    async def judge(agent: MTConnectAgent) -> None:
        document = answer(agent, "/sample?count=5000").decode()
        changed: dict[str, Any] = {
            right: schema_faults(_changed(document, right, wrong).encode()) for right, wrong in FAULTS.items()
        }
        assert [right for right, faults in changed.items() if not faults] == []

    with_agent(program, judge, run=True)


def _changed(document: str, right: str, wrong: str) -> str:
    assert right in document
    return document.replace(right, wrong)
