"""Where a part fits, and what a machine reaches of it, stands on the tool's centre and not on points of the contour."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.compensation.centre_runs import run_of_centre
from trunnion.compensation.stretches import compensated_stretches
from trunnion.jobs.inputs.driven_paths import centres_of
from trunnion.jobs.observer import SILENT, Remembering
from trunnion.model.toolpath import Kind

FOLDER = Path(__file__).parents[1] / "golden/compensation"

#: The contour of a pocket of 92 by 60 mm, the path of the centre of its cutter of 12 mm, and a boss of 40 by 30 mm.
CONTOUR, CENTRE, BOSS = (FOLDER / f"{name}.cls" for name in ("contour_pocket", "pocket", "contour_boss"))


def used(found: trunnion.Placement) -> dict[str, float]:
    """How far each linear axis goes at the best place, mm."""
    assert found.best is not None
    return {each.axis: each.greatest_mm - each.least_mm for each in found.best.axes}


@pytest.mark.parametrize("machine", ["yl569", "haas_umc750", "dmu65", "linuxcnc_5axis"])
def test_a_contour_is_placed_by_the_path_of_the_centre(machine: str) -> None:
    inside = [used(trunnion.place(cl, machine=machine, turns=[0.0])) for cl in (CONTOUR, CENTRE)]
    assert inside[0] == pytest.approx(inside[1], abs=1e-3)


@pytest.mark.parametrize("machine", ["yl569", "haas_umc750", "dmu65", "linuxcnc_5axis"])
def test_the_rows_of_a_contour_are_those_of_the_program_that_is_proven(machine: str, tmp_path: Path) -> None:
    """Outside, where each control rounds corners in its own way: the path is that of the reader's program."""
    program = tmp_path / "boss.nc"
    trunnion.post(BOSS, machine=machine, output=program, settings={"radius_register": "radius"})
    run = trunnion.read_program(program, machine=machine)
    (stretch,) = compensated_stretches(run)
    driven = run_of_centre(run, [(stretch, 6.0)]).run
    (toolpath,), problems = centres_of([trunnion.read_cl(BOSS)], run.machine)
    assert not problems
    moves = toolpath.operations[0].moves
    cut = driven.tip[(driven.kind != Kind.RAPID) & ~driven.machine_frame]
    mine = moves.tip[moves.kind != Kind.RAPID]
    for points, others in ((cut, mine), (mine, cut)):
        apart = np.linalg.norm(points[:, None] - others[None], axis=2).min(axis=1)
        assert apart.max() < 2e-3, machine


def test_the_reach_is_that_of_the_centre() -> None:
    """The linear axes reach 54.7 mm from the table's centre: the centre of the tool in the pocket, not its wall."""
    machine = replace(trunnion.load_machine("yl569"), workpiece_zero=(0.0, 0.0, 0.0), tool_length=100.0)
    axes = [
        replace(axis, low=-most, high=most)
        for axis, name in zip(machine.axes, machine.names, strict=True)
        for most in ({"X": 42.0, "Y": 35.0}.get(name, 1000.0),)
    ]
    narrow = replace(machine, axes=tuple(axes))
    for cl in (CENTRE, CONTOUR):
        (found,) = trunnion.reach(narrow, cl=[cl], step=30).paths
        assert (found.no_axis, found.no_travel) == (0, 0), cl


def test_what_is_not_known_is_reported(tmp_path: Path) -> None:
    told, cl = Remembering(SILENT), tmp_path / "boss.cls"
    cl.write_text(re.sub(r"TLDATA.*\n", "", BOSS.read_text()))
    trunnion.reach("yl569", cl=[cl], observer=told, step=30)
    assert "the radius of the tool is not known: they are taken for those of the tool's centre" in " ".join(
        map(str, told.found)
    )
    told = Remembering(SILENT)
    trunnion.reach("hs664rt", cl=[BOSS], observer=told, step=30)
    assert [each.code for each in told.found if "radius compensation" in each.what] == ["SIM164"]


def test_a_program_is_placed_by_the_path_of_the_centre_or_with_a_warning(tmp_path: Path) -> None:
    program, tool = tmp_path / "pocket.mpf", "1=flat:12,length=75,flutes=30"
    trunnion.post(CONTOUR, machine="yl569", output=program, settings={"radius_register": "radius"})
    for given, tools, width, codes in (
        ({"radius_register": "radius"}, [tool], 80.0, []),
        ({"settings": {"radius_register": "radius"}}, [tool], 80.0, []),
        ({"radius_register": "radius"}, [], 92.0, ["SIM147"]),
        ({}, [tool], 92.0, ["SIM147"]),
    ):
        found = trunnion.place(program, machine="yl569", turns=[0.0], tools=tools, tool_length=120, **given)
        assert used(found)["X"] == pytest.approx(width, abs=0.01)
        assert [each.code for each in found.remarks if each.code in ("SIM147", "SIM164")] == codes
