"""The motion of a run in time, against LinuxCNC's own planner: the same programs on machines with the same limits.

Feeds are multiplied, so that accelerations count: at its own feeds a program says little about a planner.
"""

import re
from collections.abc import Iterator
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

#: How far from the end of a block LinuxCNC itself may pass, mm in an axis: between a circle and a line it takes a
#: little more than G64 allows.
OWN_TOLERANCE = {"blade": TOLERANCE, "blade_without_tcp": TOLERANCE, "contour": 0.065}


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


pytestmark = pytest.mark.nightly  # the controller moves in real time


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
def test_at_equal_path_lengths_the_axes_are_where_linuxcnc_has_them(
    runs: dict[str, tuple[TimedRun, Floats]], name: str
) -> None:
    """Each axis within the tolerance that the program gives the control, from the first cut to the last.

    Rounded corners make LinuxCNC's path shorter than the programmed one, so lengths are counted anew in each block,
    between the places at which it passes the block's ends, and compared as shares of the block. Where it passes an end
    itself farther away than it is allowed to, it is nowhere nearer to ours.
    """
    timed, joints = runs[name]
    blocks = list(compared(timed, joints))
    worst = max(away for away, _ in blocks)
    passed = max(end for _, end in blocks)
    print(f"{name}: {worst:.4f} mm or degrees at equal lengths, ends of {len(blocks)} blocks passed at {passed:.4f}")
    assert len(blocks) > 50
    assert worst <= max(TOLERANCE, passed)
    assert passed <= OWN_TOLERANCE[name]


def compared(timed: TimedRun, joints: Floats) -> Iterator[tuple[float, float]]:
    """For each block, how far an axis of LinuxCNC is from ours at worst, and where it passes the end of the block."""
    rows = cut_rows(timed)
    begin = int(np.abs(joints - block_path(timed, rows[0])[0]).max(axis=1).argmin())
    done = lengths(joints)
    for row in rows:
        ours = block_path(timed, row)
        at = lengths(ours)
        way = at[-1]
        # The end is passed where their way is as long as ours, less what corners at both ends may take off it.
        low, high = np.searchsorted(done, done[begin] + np.array([max(way - 5.0 * TOLERANCE, 0.0), way + TOLERANCE]))
        passed = np.abs(joints[low : high + 1] - ours[-1]).max(axis=1)
        end = int(low + passed.argmin())
        theirs = joints[begin : end + 1]
        shares = lengths(theirs)
        shares /= max(shares[-1], 1e-9)
        wanted = np.column_stack([np.interp(shares, at / way, axis) for axis in ours.T])
        yield float(np.abs(theirs - wanted).max()), float(passed.min())
        begin = end


def cut_rows(timed: TimedRun) -> list[int]:
    """The rows that move, from the first cut to the last."""
    cuts = np.flatnonzero(timed.run.kind != Kind.RAPID)
    rows = np.arange(cuts[0], cuts[-1] + 1)
    moving: list[int] = rows[(timed.ends > timed.begins)[rows]].tolist()
    return moving


def block_path(timed: TimedRun, row: int) -> Floats:
    """The axes while a row runs, closely."""
    return timed.at(np.linspace(timed.begins[row], timed.ends[row], 2000)).joints


def lengths(path: Floats) -> Floats:
    """The way to each position in the space of the axes, where a degree is a millimetre and nothing moves unseen."""
    return np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))))
