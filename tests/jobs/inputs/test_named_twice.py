"""Values that options state by name, such as ``--zero G54=…``: each name has one."""

from typing import Any

import pytest

import trunnion
from tests.support.locations import GOLDEN
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.machines import load_machine


@pytest.mark.parametrize(
    ("machine", "given", "names"),
    [
        ("matsuura_mx330", {"zero": "G54=1,2,3,G54=4,5,6"}, "G54"),
        ("matsuura_mx330", {"zero": "0,0,1,G55=1,2,3,g55=1,2,3"}, "G55 and g55"),
        ("matsuura_mx330", {"zero": "G54.1 P2=1,2,3,G54.1P2=1,2,4"}, "G54.1"),
        ("yl569", {"tool_length": "1=10,1=20"}, "1"),
        ("yl569", {"tool_length": "5,01=10,1=20"}, "01 and 1"),
        ("dmu65", {"tool_length": {"2": 10.0, "02": 20.0}}, "2 and 02"),
    ],
)
def test_a_tool_or_an_offset_has_one_value(machine: str, given: dict[str, Any], names: str) -> None:
    with pytest.raises(trunnion.InputError) as refused:
        set_up_machine(load_machine(machine), given.get("zero"), given.get("tool_length"))
    assert f"two values for {names}" in str(refused.value)
    assert "write one" in str(refused.value)


def test_one_value_of_each_is_taken() -> None:
    machine = set_up_machine(load_machine("matsuura_mx330"), "0,0,1,G54=1,2,3,G55=4,5,6", "5,1=10,2=20")
    assert len(machine.zeros) == len(machine.tool_lengths) == 2


def test_an_operation_has_one_mode() -> None:
    for mode in ("auto,tcp", "A:tcp,A:3+2"):
        with pytest.raises(trunnion.InputError, match="two values"):
            trunnion.post(GOLDEN / "yl569/3_blade_finish.cls", machine="yl569", settings={"mode": mode})


def test_an_axis_of_a_pose_has_one_angle() -> None:
    with pytest.raises(trunnion.InputError, match="one axis has two angles"):
        trunnion.sensitivity(
            GOLDEN / "yl569/3_blade_finish.expected.mpf", machine="yl569", zero_at="B=0,C=0,B=10", tool_length=100.0
        )
