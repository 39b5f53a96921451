"""How fast axes are on arcs: a circle's axes are as fast as its feed, though it ends where it begins."""

import math
from pathlib import Path

import numpy as np
import pytest

from tests.support.reading import close
from trunnion.machines import load_machine
from trunnion.model.subdivision import subdivide
from trunnion.readers import run_program
from trunnion.verification import verify
from trunnion.verification.kinematics.arc_speeds import ArcSpeeds

HEAD = "G54 G17 G90 G94 G710\nT=1\nM6\nD1\nS1000 M3\nTRAORI\nG0 X10 Y0 Z50 B0 C0\nF{0}\n"


def speeds(folder: Path, arcs: str, machine: str = "yl569") -> tuple[ArcSpeeds, Path]:
    path = folder / "A.MPF"
    path.write_text(HEAD.format(3000) + arcs + "\nTRAFOOF\nM5\nM30\n", encoding="utf-8")
    run = run_program(path, load_machine(machine))
    assert run.errors == ()
    return ArcSpeeds.of(run, 0, len(run), run.chunk(0, len(run))), path


def test_a_circle_is_as_fast_as_its_feed(tmp_path: Path) -> None:
    found, path = speeds(tmp_path, "G3 X10 Y0 I-10 J0\nG3 X-10 Y0 I-10 J0\nG3 X10 Y0 Z45 I10 J0 TURN=2")
    slides = [load_machine("yl569").column(name) for name in "XYZ"]
    # By the share of the arc: radius times angle, and radius times its square.
    angle = np.array([2 * math.pi, math.pi, 5 * math.pi])
    close(found.most[:, slides[0]], 10 * angle, rtol=1e-3)
    close(found.most[:, slides[1]], 10 * angle, rtol=1e-3)
    close(found.most[:, slides[2]], [0, 0, 5], atol=1e-9)
    close(found.acceleration[:, slides[0]], 10 * angle**2, rtol=1e-3)
    close(np.abs(found.begin[:, slides[1]]), 10 * angle, rtol=1e-9)
    close(found.begin[:, slides[0]], np.zeros(3), atol=1e-6)
    # 3000 of 5000 mm/min.
    (check,) = (check for check in verify(run_program(path, load_machine("yl569"))).checks if check.key == "speed")
    assert check.worst == pytest.approx(0.6, rel=2e-3)


def test_arcs_along_which_rotary_axes_turn_agree_with_fine_steps(tmp_path: Path) -> None:
    found, path = speeds(tmp_path, "G3 X10 Y0 I-10 J0 B20 C90\nG3 X10 Y0 Z45 I-10 J0 TURN=30 B0 C0")
    run = run_program(path, load_machine("yl569"))
    for k, row in enumerate(found.rows.tolist()):
        pieces = 40_000
        joints = np.vstack((run.joints[row - 1], subdivide(run, pieces, slice(row, row + 1)).joints))
        steps = np.diff(joints, axis=0) * pieces
        close(found.most[k], np.abs(steps).max(axis=0), rtol=5e-3, atol=1e-3)
        # The first and the last step are as fast as the arc half a step from its end.
        change = float(found.acceleration[k].max()) / pieces
        close(found.begin[k], steps[0], atol=change)
        close(found.end[k], steps[-1], atol=change)
        close(found.acceleration[k], np.abs(np.diff(steps, axis=0)).max(axis=0) * pieces, rtol=5e-2, atol=1.0)
