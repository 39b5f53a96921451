"""What the steps of an impeller say of themselves in a program."""

from dataclasses import replace

import pytest

from tests.support.locations import ROOT
from tests.support.operations import operation_of
from tests.support.path_strategies import winding
from trunnion.controls import load_control
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.machining import StepPaths
from trunnion.impeller.steps import StepKind
from trunnion.jobs.impeller.settings import operation_settings, program_settings
from trunnion.jobs.impeller.windings import winding_problems
from trunnion.machines import load_machine
from trunnion.model.machining_method import machining_method
from trunnion.model.toolpath import Toolpath
from trunnion.planning import plan

DEFINITION = read_impeller(ROOT / "examples" / "impeller" / "mixed_flow.toml")
STEP, TOOL = DEFINITION.steps[0], DEFINITION.tools[0]
SINUMERIK = load_control(load_machine("yl569").control)


def paths(kind: StepKind, name: str, tolerance: float = 0.01, **values: float) -> StepPaths:
    """A step without its paths."""
    step = replace(STEP, kind=kind, name=name, tolerance=tolerance, **values)  # type: ignore[arg-type]
    return StepPaths(step, TOOL, 0.0, (f"{name}_1", f"{name}_2"), ())


@pytest.mark.parametrize("kind", StepKind)
@pytest.mark.parametrize("tolerance", [0.001, 0.01, 0.05])
@pytest.mark.parametrize("name", ["", "FINISH_IT", "SEMI", "OP"])
def test_the_method_names_the_step_and_means_the_mode_that_its_tolerances_and_name_mean(
    kind: StepKind, tolerance: float, name: str
) -> None:
    one = paths(kind, name or kind.upper().replace(" ", "_"), tolerance)
    found = operation_settings([one], SINUMERIK, {}, {})
    for operation in one.names:
        text = found[operation]["method"]
        assert kind.upper().split()[0] in text
        meant = machining_method(operation, tolerance, tolerance)
        modes = [SINUMERIK.default_for_method("cycle832", each) for each in (text, meant)]
        assert modes[0] == modes[1]


def test_the_stock_of_an_operation_is_the_most_that_it_leaves() -> None:
    one = paths(StepKind.CHANNEL_ROUGHING, "ROUGH", allowance=0.3, hub_allowance=0.4)
    assert operation_settings([one], SINUMERIK, {}, {})["ROUGH_2"]["stock"] == "0.4"
    assert "stock" not in operation_settings([one], load_control(load_machine("xyzac_trt").control), {}, {})["ROUGH_2"]


def test_what_the_user_has_set_stays() -> None:
    one = paths(StepKind.CHANNEL_ROUGHING, "ROUGH", allowance=0.3)
    found = operation_settings([one], SINUMERIK, {"stock": "1"}, {"ROUGH_1": {"method": "MINE", "edge": "2"}})
    assert found["ROUGH_1"] == {"method": "MINE", "edge": "2"}
    assert set(found["ROUGH_2"]) == {"method"}


def test_a_control_whose_programs_have_names_gets_that_of_the_file_and_numbers_stay() -> None:
    assert program_settings(load_control(load_machine("mikron_600u").control), "A B", "A_B")["program"] == "A_B"
    for other in ("matsuura_mx330", "haas_umc750", "yl569"):
        assert "program" not in program_settings(load_control(load_machine(other).control), "A B", "A_B")


@pytest.mark.parametrize(
    ("machine", "said"),
    [("generic_head_table_bc", "10 turns back home"), ("generic_head_head_ca", "rewinds in the cut"), ("yl569", "")],
)
def test_a_tilt_that_winds_or_rewinds_is_told_with_what_helps(machine: str, said: str) -> None:
    loaded = load_machine(machine)
    moves = winding(10.0, 0.0, 3600.0, 900)
    toolpath = Toolpath("part.cls", (operation_of(replace(moves, tip=40.0 * moves.axis)),))
    motions = plan([toolpath], loaded, 0.001).motions
    step = replace(STEP, kind=StepKind.STOCK_FINISHING, tilt=10.0)
    found = list(winding_problems("part.toml", step, motions, loaded))
    assert [said in problem.what and "tilt_deg = 0" in problem.cure for problem in found] == ([True] if said else [])
    assert list(winding_problems("part.toml", replace(step, tilt=0.0), motions, loaded)) == []
