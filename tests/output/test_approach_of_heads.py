"""From home into a plane of a tilted head: the linear axes in a safe order, not X and Y of the plane."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS
from trunnion.jobs.inputs.settings import SettingValue
from trunnion.jobs.post.result import PostResult

CASES = TESTS / "data" / "cases"
POCKET = TESTS / "data" / "heads" / "tilted_arcs.cls"
PLANES = [
    ("sinumerik_840d", "cycle800"), ("sinumerik_840d", "frames"), ("heidenhain_tnc640", "spatial"),
    ("heidenhain_tnc640", "vector"), ("heidenhain_itnc530", "cycle19"), ("fanuc_31i", None), ("haas_ngc", None),
]  # fmt: skip

#: Zero and tool length on each chain whose head tilts the tool.
CHAINS = {
    "generic_head_head_ca": ((1200, -850, -480), 150),
    "generic_nutated_b45_c": ((0, 0, -225), 100),
    "generic_head_table_bc": ((0, 0, -225), 120),
}
ZERO, LENGTH = (1300.0, -850.0, -480.0), 150.0
ARCS: dict[str, SettingValue] = {"zero": ZERO, "tool_length": LENGTH}


def own_machine(folder: Path, base: str, control: str) -> Path:
    file = folder / "own.toml"
    text = f'schema = 1\nextends = "{base}"\nname = "Own"\n[control]\nextends = "{control}"\n'
    file.write_text(text, encoding="utf-8")
    return file


def post(machine: str | Path, cl: Path, **settings: SettingValue) -> PostResult:
    return trunnion.post(cl, machine=machine, settings={k: v for k, v in settings.items() if v is not None})


@pytest.mark.third
@pytest.mark.parametrize("cl", [POCKET, CASES / "tilted_flood.cls", CASES / "holes.cls"], ids=lambda cl: cl.stem)
@pytest.mark.parametrize(("control", "plane"), PLANES)
def test_every_chain_goes_to_every_plane(control: str, plane: str | None, cl: Path, tmp_path: Path) -> None:
    for base, (zero, length) in CHAINS.items():
        posted = post(own_machine(tmp_path, base, control), cl, zero=zero, tool_length=length, plane=plane)
        assert posted.passed
        travel = next(check for check in posted.checks if check.key == "travel")
        checked, motions = re.findall(r"checked (\d+) of (\d+) motions", travel.told)[0]
        assert checked == motions


def test_the_axis_along_the_spindle_stays_at_home_first(tmp_path: Path) -> None:
    program = tmp_path / "part.mpf"
    trunnion.post(POCKET, machine="generic_head_head_ca", settings=ARCS, output=program)
    lines = program.read_text(encoding="utf-8").splitlines()
    plane = next(k for k, line in enumerate(lines) if "CYCLE800(0" in line)
    assert lines[plane + 1].split(maxsplit=1)[1] == "G0 X4. Y172.64429 Z349.02867 D1"
    assert lines[plane + 2].split(maxsplit=1)[1] == "Y0.0 Z50. S5300 M3 M8"
    machine = trunnion.load_machine("generic_head_head_ca")
    run = trunnion.verify(program, machine=machine, cl=POCKET, zero=ZERO, tool_length=LENGTH).run
    row = int((run.line == plane + 2).argmax())
    z = run.joints[row - 1 : row + 2, machine.column("Z")]
    assert z[:2] == pytest.approx([0.0, -5.0], abs=1e-3)
    assert z[2] < -200.0


def test_x_and_y_of_the_plane_are_a_fault_where_they_lead_through_the_part(tmp_path: Path) -> None:
    program = tmp_path / "part.mpf"
    trunnion.post(POCKET, machine="generic_head_head_ca", settings=ARCS, output=program)
    text = program.read_text(encoding="utf-8")
    text = text.replace("X4. Y172.64429 Z349.02867 D1", "X4. Y0.0").replace("Y0.0 Z50. S5300", "Z50. D1 S5300")
    program.write_text(text, encoding="utf-8")
    found = trunnion.verify(program, machine="generic_head_head_ca", cl=POCKET, zero=ZERO, tool_length=LENGTH)
    assert {check.key for check in found.checks if not check.passed} == {"travel", "modal"}
    modal = next(check for check in found.checks if check.key == "modal")
    assert "the way from home leads through the part at rapid" in modal.summary


@pytest.mark.parametrize("leg", ["X4. Y172.64429 Z300. D1", "X44. Y172.64429 Z349.02867 D1", "X4. Y0. Z349. D1"])
def test_another_way_is_no_first_leg(leg: str, tmp_path: Path) -> None:
    program = tmp_path / "part.mpf"
    trunnion.post(POCKET, machine="generic_head_head_ca", settings=ARCS, output=program)
    text = program.read_text(encoding="utf-8").replace("X4. Y172.64429 Z349.02867 D1", leg)
    program.write_text(text.replace(" Y0.0 Z50. S5300", " X4. Y0.0 Z50. S5300"), encoding="utf-8")
    found = trunnion.verify(program, machine="generic_head_head_ca", cl=POCKET, zero=ZERO, tool_length=LENGTH)
    assert not next(check for check in found.checks if check.key == "order").passed


def test_a_way_that_is_not_known_is_said() -> None:
    posted = post("generic_head_head_ca", POCKET)
    said = [problem for problem in posted.problems if problem.code == "CTL730"]
    assert len(said) == 1
    assert "TILTED_POCKET" in str(said[0])
    assert not [p for p in post("generic_head_head_ca", POCKET, **ARCS).problems if p.code == "CTL730"]
    assert not [p for p in post("yl569", CASES / "tilted_flood.cls").problems if p.code == "CTL730"]
