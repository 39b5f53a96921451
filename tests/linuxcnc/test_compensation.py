"""Radius compensation in LinuxCNC's own interpreter: its tool goes where ours says that it goes."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import trunnion
from tests.support.examples import examples
from tests.support.linuxcnc.interpreter import RefusedByLinuxcncError, interpret, needs_linuxcnc
from tests.support.plane_figures import Piece, figure, turning_paths
from trunnion.compensation.driven_runs import driven_run
from trunnion.compensation.offsets import CentrePath, centre_path
from trunnion.compensation.plane_path import PlanePath
from trunnion.compensation.stretches import RegisterValue
from trunnion.compensation.styles import STYLES

LINUXCNC = STYLES[4]

START, OUT = -30.0 - 30.0j, -30.0 + 45.0j


def program(path: PlanePath, left: float) -> str:
    """A program along a path, with compensation from its first line on and off for its last one."""
    lines = ["G21 G17 G90 G40 G64", f"G0 X{path.start[0].real} Y{path.start[0].imag} Z0", "F100"]
    for k in range(len(path)):
        word = (
            f"{'G41.1' if left > 0 else 'G42.1'} D{2 * abs(left)} " if k == 0 else "G40 " if k == len(path) - 1 else ""
        )
        end, offset = path.end[k], path.centre[k] - path.start[k]
        move = ("G1", "G3", "G2")[int(path.sense[k])]
        about = f" I{offset.real:.9f} J{offset.imag:.9f}" if path.sense[k] else ""
        lines.append(f"{word}{move} X{end.real:.9f} Y{end.imag:.9f}{about}")
    return "\n".join([*lines, "M2", ""])


def ends(found: CentrePath) -> list[complex]:
    """Where the elements end that lead anywhere."""
    moving = np.abs(found.path.end - found.path.start) > 1e-6
    return [complex(end) for end in found.path.end[moving | (found.path.sense != 0)]]


FIGURES: dict[str, tuple[Piece, ...]] = {
    "square": (0j, 20j, 20 + 20j, 20, 0j, -10 - 10j),
    "acute": (0j, 30 + 4j, 5 + 8j, -10 + 30j),
    "circles": (0j, 20j, (10 + 30j, 10 + 20j, -1), 20 + 30j, (30 + 40j, 20 + 40j, 1), 30 + 60j, 0j + 70j),
    "wave": (0j, (20 + 0j, 10 + 0j, -1), (40 + 0j, 30 + 0j, 1), 50 + 10j, 70 + 10j),
    "corner into a circle": (0j, 20 + 0j, (40 + 0j, 30 + 0j, -1), 60 + 0j, 80 + 20j),
    "full circle": (10 + 0j, (10 + 0j, 0j, 1), 20 + 0j),
}


@needs_linuxcnc
@pytest.mark.parametrize("left", [2.5, -2.5])
@pytest.mark.parametrize("name", FIGURES)
def test_its_interpreter_goes_the_same_way(name: str, left: float, tmp_path: Path) -> None:
    path = figure(START, *FIGURES[name])
    found = centre_path(path, left, LINUXCNC, leaves=True)
    if found.faults:
        with pytest.raises(RefusedByLinuxcncError):
            interpret(program(path, left), tmp_path)
        return
    canon = interpret(program(path, left), tmp_path)
    its = [complex(*move.end[:2]) for move in canon.moves[1:]]
    assert its == pytest.approx(ends(found), abs=1e-4), (name, left)


@needs_linuxcnc
@settings(max_examples=examples(30), deadline=None)
@given(turning_paths(), st.sampled_from([-1.0, 1.0]))
def test_it_goes_the_same_way_along_any_path(contour: list[tuple[complex, complex, int]], left: float) -> None:
    path = figure(START, *contour, contour[-1][0] + OUT)
    found = centre_path(path, left, LINUXCNC, leaves=True)
    with TemporaryDirectory() as folder:
        if found.faults:
            return
        canon = interpret(program(path, left), Path(folder))
    its = [complex(*move.end[:2]) for move in canon.moves[1:]]
    assert its == pytest.approx(ends(found), abs=1e-3)


@needs_linuxcnc
@pytest.mark.parametrize("name", ["contour_boss", "contour_pocket"])
def test_it_drives_a_contour_as_the_twin_and_the_viewer_do(name: str, tmp_path: Path) -> None:
    """With the diameter in its tool table (5.08 mm, which ``interpret`` has), as the head of the program asks for."""
    cl, program = Path(__file__).parents[1] / f"golden/compensation/{name}.cls", tmp_path / "contour.ngc"
    trunnion.post(cl, machine="linuxcnc_5axis", output=program, settings={"radius_register": "radius"})
    run = trunnion.read_program(program, machine="linuxcnc_5axis")
    driven = driven_run(run, RegisterValue.RADIUS, lambda _: 2.54)
    assert not list(driven.missing())
    real = driven.centre.run
    ours = real.tip[np.isclose(real.tip[:, 2], -9.0, atol=1e-6)][:, :2]
    its = np.array([move.end[:2] for move in interpret(program.read_text(), tmp_path).moves if move.end[2] == -9.0])
    assert len(ours) > 6
    moved = [points[np.append(True, np.abs(np.diff(points, axis=0)).max(axis=1) > 1e-6)] for points in (ours, its)]
    assert moved[1] == pytest.approx(moved[0], abs=1e-3)
