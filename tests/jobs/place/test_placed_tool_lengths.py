"""Places of programs with tools of several lengths: each row keeps the limits with its own tool."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.brute_clearance import box_body
from tests.support.placed_paths import path_rows
from trunnion.machines import Machine, load_machine
from trunnion.placing.rotary_angles import Obstacle
from trunnion.placing.table_limits import ClampingArea, Standing
from trunnion.placing.travel_limits import CutSet
from trunnion.placing.travel_use import rounded_zero
from trunnion.placing.turns import Choice, TurnedPath

SHORT, LONG = "1=flat:10,length=60,flutes=20,gauge=60", "2=flat:10,length=180,flutes=20,gauge=180"


def mill(low: float, high: float) -> Machine:
    """The tool's side has Z; its limits are given, the others are wide."""
    machine = load_machine("generic_head_head_ca")
    ends = {"X": (-900.0, 900.0), "Y": (-900.0, 900.0), "Z": (low, high)}
    axes = [axis if axis.is_rotary else replace(axis, low=ends[axis.name][0], high=ends[axis.name][1])
            for axis in machine.axes]  # fmt: skip
    table = box_body("table", "X", (-500, -500, -2000), (500, 500, -1900))
    return replace(machine, axes=tuple(axes), bodies=(table,), spindle_point=(0, 0, 0), tool_length=None)


@pytest.fixture
def two_tools(tmp_path: Path) -> Path:
    file = tmp_path / "two.cls"
    parts = []
    for number, height in ((1, 5), (2, 40)):
        parts.append(
            f"TOOL PATH/OP{number},TOOL,T{number}\nTLDATA/MILL,10.0,5.0,70.0,0.0,0.0\nMSYS/0,0,0,1,0,0,0,1,0\n"
            f"LOAD/TOOL,{number}\nSPINDL/RPM,2500,CLW\nRAPID\nGOTO/0,0,{height},0,0,1\nFEDRAT/MMPM,500\n"
            f"GOTO/10,0,{height},0,0,1\nEND-OF-PATH\n"
        )
    file.write_text("".join(parts), "ascii")
    return file


def test_each_row_keeps_the_limits_with_its_own_tool(two_tools: Path) -> None:
    """Z stands at Z0 + 5 + 60 and Z0 + 40 + 180: of 0 to 300 it leaves the same to both ends with Z0 at 7.5."""
    found = trunnion.place(two_tools, machine=mill(0, 300), turns=[0.0], tools=[SHORT, LONG], zero=(0, 0, 0))
    assert found.best is not None
    z = found.best.axes[2]
    assert z.axis == "Z"
    assert [z.least_mm, z.greatest_mm] == pytest.approx([72.5, 227.5])
    assert found.best.zero_mm[2] == pytest.approx(7.5, abs=1e-3)
    assert not any(each.code == "PLC290" for each in found.remarks)
    assert found.present is not None
    assert found.present.axes[2].least_mm == pytest.approx(65.0)
    # Z needs 155 of travel: one length for both would need 35.
    assert not trunnion.place(two_tools, machine=mill(0, 150), turns=[0.0], tools=[SHORT, LONG]).fits
    assert trunnion.place(two_tools, machine=mill(0, 150), turns=[0.0], tool_length=180).fits


def test_lengths_that_cl_files_state_count_without_bodies_too(tmp_path: Path) -> None:
    file = tmp_path / "two.apt"
    lines = ["PARTNO TWO", "UNITS/MM", "MULTAX/ON", "CUTTER/10,5"]
    for number, length, height in ((1, 60, 5), (2, 180, 40)):
        lines += [f"LOADTL/{number},LENGTH,{length}", "SPINDL/2500,RPM,CLW", "RAPID", f"GOTO/0,0,{height},0,0,1"]
        lines += ["FEDRAT/500,MMPM", f"GOTO/10,0,{height},0,0,1"]
    file.write_text("\n".join([*lines, "END", "FINI", ""]), "ascii")
    found = trunnion.place(file, machine=mill(0, 300), turns=[0.0])
    assert found.best is not None
    assert [found.best.axes[2].least_mm, found.best.axes[2].greatest_mm] == pytest.approx([72.5, 227.5])
    assert found.tool_length_mm == 180
    assert not any(each.code == "PLC210" for each in found.remarks)
    assert not trunnion.place(file, machine=mill(0, 150), turns=[0.0]).fits
    # One that is asked for counts for all.
    assert trunnion.place(file, machine=mill(0, 150), turns=[0.0], tool_length=180).fits


def test_a_stated_length_that_is_not_that_of_the_tools_is_told(two_tools: Path) -> None:
    found = trunnion.place(
        two_tools, machine=mill(0, 300), turns=[0.0], tools=[SHORT, LONG], zero=(0, 0, 0), tool_length=60
    )
    told = [each.what for each in found.remarks if each.code == "PLC290"]
    assert told == ["says 60 mm, and places are sought with the lengths of the tools: 2 of 180 mm"]
    assert found.present is not None
    assert found.present.axes[2].greatest_mm == pytest.approx(220.0)


def test_rows_at_the_pole_count_for_each_tool_at_every_turn() -> None:
    """Above the middle of many rows of a short tool one of a long one: the hull of the tips alone has it not."""
    around = [(50.0 * np.cos(a), 50.0 * np.sin(a), 0.0) for a in np.linspace(0.0, 6.28, 100)]
    above = [(50.0 * np.cos(a), 50.0 * np.sin(a), 20.0) for a in np.linspace(0.0, 6.28, 100)]
    tip = np.array([*around, (0.0, 0.0, 10.0), *above])
    rows = path_rows(tip, np.tile([0.0, 0.0, 1.0], (len(tip), 1)), np.zeros(len(tip)), straight=True)
    rows = replace(rows, length=np.where(np.arange(201) == 100, 180.0, 60.0))
    for turn in (0.0, 33.0):
        cuts = TurnedPath.of(mill(-900, 900), Choice.FIRST, rows, np.zeros(3)).at(turn)
        assert not isinstance(cuts, Obstacle)
        assert cuts.at(np.zeros(3)).extremes[2].tolist() == pytest.approx([60.0, 190.0])


def test_a_rounded_place_stays_on_the_table() -> None:
    """An outline from X-12.3456 on a table from X-100: the zero is at -87.6544 or more, and -87.654 is."""
    rows = path_rows(np.zeros((2, 3)), np.tile([0.0, 0.0, 1.0], (2, 1)), np.zeros(2), straight=True)
    outline = np.array([[-12.3456, -5, 0], [12, 5, 0], [12, -5, 0], [-12.3456, 5, 0]])
    stands = Standing(ClampingArea((0.0, 0.0), (200.0, 100.0)), outline)
    cuts = TurnedPath.of(mill(-900, 900), Choice.FIRST, rows, np.zeros(3), stands).at(0.0)
    assert isinstance(cuts, CutSet)
    assert rounded_zero(cuts, np.array([-87.6544, 1.0, 2.0])).tolist() == [-87.654, 1.0, 2.0]
    opposite = np.array([[-12, -5, 0], [12.3456, 5, 0], [12.3456, -5, 0], [-12, 5, 0]])
    cuts = TurnedPath.of(mill(-900, 900), Choice.FIRST, rows, np.zeros(3), replace(stands, points=opposite)).at(0.0)
    assert isinstance(cuts, CutSet)
    assert rounded_zero(cuts, np.array([87.6544, 0.0004, 0.0006])).tolist() == [87.654, 0.0, 0.001]
