"""What a machine's definition leaves open is said by every program that takes it for granted."""

import pytest

import trunnion
from tests.support.locations import YL569
from tests.support.machines import five_axis_machines

CL = YL569 / "3_blade_finish.cls"


def travel_and_warnings(
    machine: str, zero: tuple[float, float, float] | None = None, length: float | None = None
) -> tuple[str, list[str]]:
    result = trunnion.post(CL, machine=machine, settings={"zero": zero, "tool_length": length}, columns=False)
    travel = next(check.told for check in result.checks if check.key == "travel")
    return travel, [str(problem) for problem in result.problems if problem.file == machine]


@pytest.mark.parametrize("machine", ["ucp800", "hs664rt"])
def test_slides_without_a_stated_travel_are_named(machine: str) -> None:
    travel, warnings = travel_and_warnings(machine, (0.0, 0.0, 5000.0))
    assert travel.startswith("no travel of X, Y, Z stated; ")
    unlimited = f"{machine}: warning: travel of X, Y, Z is not stated: nothing checks it"
    assert [text for text in warnings if text.startswith(unlimited)]


def test_a_home_that_is_assumed_is_said() -> None:
    _, warnings = travel_and_warnings("ucp800")
    assumed = "ucp800: warning: home of X, Y, Z is not stated: 0 is assumed, and the program goes there"
    assert [text for text in warnings if text.startswith(assumed)]


@pytest.mark.parametrize("machine", ["generic_head_head_ca", "generic_head_table_bc", "linuxcnc_5axis"])
def test_a_home_in_the_midst_of_the_travel_that_is_assumed_is_said(machine: str) -> None:
    _, warnings = travel_and_warnings(machine)
    assumed = f"{machine}: warning: home of Z is assumed, in the midst of its travel: the program retracts there"
    assert [text for text in warnings if text.startswith(assumed)]


def test_a_program_that_does_not_go_home_along_the_slides_says_nothing_of_it() -> None:
    _, warnings = travel_and_warnings("hs664rt")
    assert not [text for text in warnings if "home" in text]


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "mikron_600u", "matsuura_mx330"])
def test_a_definition_that_states_everything_is_not_warned_of(machine: str) -> None:
    assert travel_and_warnings(machine)[1] == []


def test_a_travel_that_is_only_compared_in_length_is_said() -> None:
    travel, _ = travel_and_warnings("yl569")
    assert travel.startswith("no workpiece zero stated; no tool length stated; ")
    assert travel.count("it needs") == 3
    travel, _ = travel_and_warnings("yl569", (0.0, 0.0, 0.0))
    assert travel.startswith("no tool length stated; ")
    assert (travel.count("it needs"), "Z" in travel.split(", it needs")[0]) == (1, True)
    assert "needs" not in travel_and_warnings("yl569", (0.0, 0.0, 0.0), 100.0)[0]


def test_where_a_head_turns_the_tool_its_length_moves_all_slides() -> None:
    travel, _ = travel_and_warnings("generic_head_head_ca", (0.0, 0.0, -300.0))
    assert travel.startswith("no tool length stated; ")
    assert travel.count("it needs") == 3


def test_over_travel_with_an_unknown_length_names_the_length() -> None:
    with pytest.raises(trunnion.RefusedError) as beyond:
        travel_and_warnings("matsuura_mx330", (0.0, 0.0, 50.0))
    assert " with a tool 0 mm long, below its limit -560 mm" in str(beyond.value)
    assert "give the length of the tool by setting tool_length=…, shift the workpiece zero or change" in str(
        beyond.value
    )
    assert travel_and_warnings("matsuura_mx330", (0.0, 0.0, 50.0), 150.0)[0].count(" left in ")


@pytest.mark.parametrize("machine", five_axis_machines())
def test_no_axis_is_left_out_in_silence(machine: str) -> None:
    """Each axis has limits, or turns without end, or is named."""
    loaded = trunnion.load_machine(machine)
    travel, _ = travel_and_warnings(machine)
    open_axes = [axis.name for axis in loaded.axes if not axis.endless and not axis.has_limits]
    assert ", ".join(open_axes) in travel
    assert bool(open_axes) is ("no travel of" in travel)
