"""Five-axis programs of other posts, converted for other machines; the files are not part of the project."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import SHARED
from trunnion.cli import main
from trunnion.machines import load_machine
from trunnion.readers import run_program
from trunnion.simulation.stock.deviation import left_on
from trunnion.simulation.stock.material import Stock
from trunnion.verification.comparison import compare

FOLDER = SHARED / "data" / "linuxcnc"
IMPELLER = FOLDER / "impeller-7bl-xyzac.ngc"

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="shared/data/linuxcnc is not beside the repository")

Capture = pytest.CaptureFixture[str]


def converted(program: Path, machine: str, to: str, target: Path, *arguments: str) -> None:
    machines = ["--machine", machine, "--to-machine", to]
    assert main(["convert", str(program), *machines, "--output", str(target), *arguments]) == 0


def same(one: Path, machine: str, two: Path, to: str, tolerance: str, capfd: Capture) -> None:
    capfd.readouterr()
    machines = ["--machine", machine, "--to-machine", to]
    code = main(["diff", str(one), str(two), *machines, "--tolerance", tolerance])
    said = capfd.readouterr().out
    assert (code, said.split(",")[0]) == (0, "same: 4492 points"), said


def stock_of(program: Path, machine: str) -> Stock:
    """What a program leaves of a cylinder, in cells of 1 mm: it is taken to cut with a ball mill of 6 mm."""
    tool = "1=ball:6,length=75,flutes=60"
    found = trunnion.simulate(program, machine=machine, stock="cylinder:76,34,-8", tools=[tool], cell=1.0)
    assert found.removed == pytest.approx(49060.0, rel=3e-3)
    return found.simulation.stock


@pytest.mark.parametrize(("machine", "tolerance"), [("yl569", "0.00001"), ("dmu65", "0.0001")])
def test_the_impeller_goes_to_another_machine_and_control_and_back(
    machine: str, tolerance: str, tmp_path: Path, capfd: Capture
) -> None:
    program, there, back = tmp_path / "first.ngc", tmp_path / "there.nc", tmp_path / "back.ngc"
    program.write_text("G54\nT1 M6\n" + IMPELLER.read_text())  # it selects no work offset and calls no tool itself
    converted(program, "xyzac_trt", machine, there, "--positions", "tip")  # it calls no length
    same(program, "xyzac_trt", there, machine, tolerance, capfd)
    converted(there, machine, "xyzac_trt", back)
    same(there, machine, back, "xyzac_trt", tolerance, capfd)
    cut = [stock_of(path, each) for path, each in ((program, "xyzac_trt"), (there, machine))]
    apart = [left_on(one, (other.spans(0), other.spans(1), other.spans(2)), 0.0) for one, other in (cut, cut[::-1])]
    # The rapid between two operations turns by 263 degrees there, and by 97 here: it passes the blank elsewhere.
    assert max(each.largest for each in apart) < 1.0
    assert sum(each.volume for each in apart) < 2.0


def test_the_boat_is_one_path_on_two_machines_but_for_what_its_generator_does() -> None:
    """One path for A and C tables and for B and C: either has additional motions, none another position or tool axis.

    The first file has a roughing operation of 303 points before the one in both. The second retracts at five stepovers
    where the first does not, and eight times it rounds an end of the hull in finer steps, or retracts there to rewind.
    Feeds are inverse times of each machine's own axes.
    """
    one, two = (FOLDER / f"boat-{name}.ngc" for name in ("xyzac", "xyzbc"))
    runs = run_program(one, load_machine("xyzac_trt")), run_program(two, load_machine("xyzbc_trt"))
    # The second takes its tool length with the table turned and goes home with TCP on, which its reader tells of.
    assert [[each.code for each in run.diagnostics] for run in runs] == [[], ["NC364", "NC341", "NC341"]]
    found = compare(*runs, 0.001, path=True)
    assert found.points == 1457
    assert found.tip <= 1e-9
    assert found.axis <= 1e-9
    assert found.count == 14
    assert found.first is not None
    assert re.search("the first program has 303 more points", found.first.text)


def test_the_boats_differ_in_more_than_that_when_the_tool_axis_does(tmp_path: Path) -> None:
    text = (FOLDER / "boat-xyzbc.ngc").read_text()
    changed = tmp_path / "boat.ngc"
    changed.write_text(text.replace("C64.398", "C64.410", 1))
    machines = load_machine("xyzac_trt"), load_machine("xyzbc_trt")
    runs = run_program(FOLDER / "boat-xyzac.ngc", machines[0]), run_program(changed, machines[1])
    assert compare(*runs, 0.001, path=True).points < 1457
