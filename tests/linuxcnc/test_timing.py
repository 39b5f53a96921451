"""The motion of a run in time, against LinuxCNC's own planner: the same programs on machines with the same limits.

Feeds are multiplied, so that accelerations count: at its own feeds a program says little about a planner.
"""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.linuxcnc.simulator import ACCELERATION, VELOCITY, Bench, motions, needs_simulator
from tests.support.locations import TESTS
from trunnion.arrays import Floats
from trunnion.machines import Machine, load_machine
from trunnion.model.toolpath import Kind
from trunnion.readers import run_program
from trunnion.timing import TimedRun, time_run

LENGTH = 80.0

BENCH = Bench("xyzac-trt-kins", {"y-offset": 20.0, "z-offset": 10.0}, "XYZAC", (0.0, 0.0, 0.0), LENGTH)

#: The five-axis finish of the YL569's blade with TCP, and without; three axes with circles: each with the factor of its
#: feeds.
PROGRAMS = {"blade": 4.0, "blade_without_tcp": 4.0, "contour": 16.0}

#: What the programs let the control round off, mm: G64 P.
TOLERANCE = 0.06


def with_feeds(name: str, factor: float) -> str:
    """A golden program with other feeds, for the one tool of the simulator."""
    text = (TESTS / "golden" / "linuxcnc" / f"{name}.expected.ngc").read_text(encoding="utf-8")
    text = re.sub(r"F(\d+\.?\d*)", lambda feed: f"F{float(feed[1]) * factor:.4f}", text)
    return re.sub(r"H\d+", "H1", re.sub(r"T\d+ M6", "T1 M6", text))


def machine() -> Machine:
    """The machine with the limits of the simulator."""
    found = load_machine("xyzac_trt", {"workpiece": {"zero_mm": [0.0, 0.0, 0.0]}})
    axes = (
        replace(axis, rapid=60.0 * VELOCITY["ANGULAR" if axis.is_rotary else "LINEAR"], acceleration=ACCELERATION)
        for axis in found.axes
    )
    return replace(found, axes=tuple(axes), tool_length=LENGTH)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[TimedRun, Floats]]:
    """Each program in time, and the joints that LinuxCNC moves, one row a millisecond, in the machine's order."""
    folder, here = tmp_path_factory.mktemp("timing"), machine()
    texts = {name: with_feeds(name, factor) for name, factor in PROGRAMS.items()}
    recorded = motions(BENCH, list(texts.values()), 120.0)
    order = [BENCH.letters.index(axis.name) for axis in here.axes]
    found = {}
    for (name, text), joints in zip(texts.items(), recorded, strict=True):
        path = Path(folder / f"{name}.ngc")
        path.write_text(text, encoding="utf-8")
        found[name] = time_run(run_program(path, here)), joints[:, order]
    return found


@needs_simulator
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_takes_as_long_as_on_linuxcnc(runs: dict[str, tuple[TimedRun, Floats]], name: str) -> None:
    timed, joints = runs[name]
    moving = (np.abs(np.diff(joints, axis=0)).max(axis=1) > 1e-9).sum() / 1000.0
    ours = (timed.ends - timed.begins).sum()
    print(f"{name}: LinuxCNC {moving:.3f} s, here {ours:.3f} s")
    assert ours == pytest.approx(moving, rel=0.05)


@needs_simulator
@pytest.mark.parametrize("name", PROGRAMS)
def test_at_equal_ways_the_axes_are_where_linuxcnc_has_them(
    runs: dict[str, tuple[TimedRun, Floats]], name: str
) -> None:
    """Within the tolerance that the program gives the control, from the first cut to the last."""
    timed, joints = runs[name]
    cuts = np.flatnonzero(timed.run.kind != Kind.RAPID)
    first, last = timed.begins[cuts[0]], timed.ends[cuts[-1]]
    ours = timed.at(np.arange(first, last, 2e-4)).joints
    theirs = joints[nearest(joints, ours[0]) : nearest(joints, ours[-1]) + 1]
    assert len(theirs) > 1000
    worst = max(away(theirs, ours))
    print(f"{name}: {worst:.4f} mm or degrees from the path in {len(theirs)} samples")
    assert worst <= TOLERANCE


def nearest(joints: Floats, to: Floats) -> int:
    """The row that is nearest to a position."""
    return int(np.abs(joints - to).max(axis=1).argmin())


def away(theirs: Floats, ours: Floats) -> list[float]:
    """How far each of their positions is from our path, whose positions follow each other closely."""
    found, at = [], 0
    for joints in theirs[:: max(1, len(theirs) // 4000)]:
        part = ours[max(at - 500, 0) : at + 2000]
        distance = np.abs(part - joints).max(axis=1)
        at = max(at - 500, 0) + int(distance.argmin())
        found.append(float(distance.min()))
    return found
