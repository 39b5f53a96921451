"""Programs that really ran: what the reader makes of them is what their CL files asked for."""

import re

import numpy as np
import pytest

from tests.support.locations import YL569
from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.model.toolpath import Kind
from trunnion.readers import run_program

FOLDER = YL569

CASES = ("1_contour_rough", "2_hub_rough", "3_blade_finish")

#: Half of the last digit: three-axis programs have three decimals, five-axis ones five.
ROUNDING = {"1_contour_rough": 5.1e-4, "2_hub_rough": 5.1e-6, "3_blade_finish": 5.1e-6}


def cl_points(name: str) -> tuple[Floats, Floats]:
    """Tips and axes of the GOTO lines of a CL file; the axis is modal."""
    tips, axes = [], []
    axis = [0.0, 0.0, 1.0]
    for line in (FOLDER / f"{name}.cls").read_text(encoding="utf-8").splitlines():
        if line.startswith("GOTO/"):
            numbers = [float(word) for word in line[5:].split(",")]
            axis = numbers[3:6] or axis
            tips.append(numbers[:3])
            axes.append(axis)
    return np.array(tips), np.array(axes)


@pytest.mark.parametrize("name", CASES)
def test_every_cl_point_is_reached_with_the_tool_axis_asked_for(name: str, yl569: Machine) -> None:
    run = run_program(FOLDER / f"{name}.expected.mpf", yl569)
    tips, axes = cl_points(name)
    cut = ~run.machine_frame & ((run.programmed & 7) != 0)
    assert run.diagnostics == ()
    np.testing.assert_allclose(run.tip[cut], tips, rtol=0, atol=ROUNDING[name])
    np.testing.assert_allclose(run.axis[cut], axes, rtol=0, atol=2e-7)


def test_the_modal_state_is_that_of_the_finishing_program(yl569: Machine) -> None:
    run = run_program(FOLDER / "3_blade_finish.expected.mpf", yl569)
    first = int(np.flatnonzero(run.tcp)[0])
    assert run.line[first] == 46
    assert run.block_number[first] == 460
    assert run.kind[first] == Kind.RAPID
    assert run.kind[first + 1] == Kind.LINEAR
    assert np.isnan(run.feed[first])
    assert run.feed[first + 1] == 250.0
    assert set(run.feed_mode) == {94}
    assert run.rpm[first] == 2500.0
    assert run.spindle[first] == 1
    assert run.tools[run.tool[first]] == "2"
    assert run.edge[first] == 1
    assert run.work_offset[first] == 54
    assert not run.tcp[first - 1]
    assert run.machine_frame[[0, 1, 2, 3, -1, -2]].all()
    assert run.spindle[-1] == 1
    assert [e.kind for e in run.events] == [
        "exact_stop", "tool", "tool_change", "message", "cycle832", "tolerance", "orientation_tolerance",
        "exact_stop", "speed",
        "spindle", "cycle832", "tolerance", "orientation_tolerance", "exact_stop", "spindle", "end",
    ]  # fmt: skip
    assert run.events[4].value == (0.06, "_ORI_ROUGH", 1.0)
    assert [c.text for c in run.comments if c.before_row == first] == []
    assert "Cutting" in [c.text for c in run.comments]


def test_angles_are_those_written_but_for_whole_turns(yl569: Machine) -> None:
    path = FOLDER / "3_blade_finish.expected.mpf"
    run = run_program(path, yl569)
    lines = path.read_text(encoding="utf-8").splitlines()
    for row in np.flatnonzero(run.programmed & 24):
        text = lines[run.line[row] - 1]
        if run.machine_frame[row]:
            continue
        for column, letter in enumerate("CB"):
            match = re.search(rf"{letter}([-.\d]+)", text)
            if match:
                turns = (run.joints[row, column] - float(match.group(1))) / 360.0
                assert abs(turns - round(turns)) < 1e-12
    assert np.abs(np.diff(run.joints[run.tcp, 0])).max() < 180.0


def test_circles_of_the_roughing_program_are_the_ones_of_the_cl_file(yl569: Machine) -> None:
    run = run_program(FOLDER / "1_contour_rough.expected.mpf", yl569)
    text = (FOLDER / "1_contour_rough.cls").read_text(encoding="utf-8")
    circles = np.array([[float(w) for w in line[7:].split(",")] for line in text.splitlines() if line[:7] == "CIRCLE/"])
    assert len(run.arcs.row) == len(circles)
    np.testing.assert_allclose(run.arcs.centre, circles[:, :3], rtol=0, atol=1.1e-3)
    np.testing.assert_allclose(run.arcs.normal, circles[:, 3:6], rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.arcs.radius, circles[:, 6], rtol=0, atol=1.1e-3)
    assert (run.kind[run.arcs.row] == Kind.ARC).all()
