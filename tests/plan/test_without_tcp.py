"""Programs without TCP, read back by the reader's own control: tip and tool axis on the way, and how long it takes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import Phase, assume, event, given, settings
from hypothesis import strategies as st

from tests.plan.naive import moves_of, operation_of
from trunnion.arrays import Floats
from trunnion.cli.post import write
from trunnion.control import Program, check_program, load_control
from trunnion.errors import Severity
from trunnion.machine import Machine, load_machine, shipped
from trunnion.plan import Plan, Wishes, plan
from trunnion.reader import Run, run_program, subdivide
from trunnion.toolpath import Kind, LoadTool, Operation, SpindleOn, Toolpath
from trunnion.verify import Verification, verify

NAMES = sorted(shipped())
SINUMERIK = load_machine("yl569").control


def machine(name: str) -> Machine:
    """A machine with room for its slides, a part off its rotary axes, and a tool where its head turns it."""
    model = load_machine(name)
    axes = tuple(axis if axis.is_rotary else replace(axis, low=-np.inf, high=np.inf) for axis in model.axes)
    length = 83.7 if model.turns_tool else None
    return replace(model, axes=axes, control=SINUMERIK, workpiece_zero=(37.0, -21.0, 110.0), tool_length=length)


def toolpath(operation: Operation) -> Toolpath:
    events = (LoadTool(0, 1, 1), SpindleOn(0, 1, 1000.0), *operation.events)
    return Toolpath("part.cls", (replace(operation, events=events, intol=0.01, outtol=0.01),))


@dataclass(frozen=True, eq=False)
class Posted:
    """A program, run, and what verification says of it."""

    plan: Plan
    text: str
    run: Run
    found: Verification


def post(model: Machine, path: Toolpath, wishes: Wishes) -> Posted:
    """Plan, write, read back and prove, whatever speaks against the plan."""
    control = load_control(model.control)
    planned = plan([path], model, control.chord_tolerance, wishes)
    program = Program(model, control, planned.motions, {}, "part.cls")
    assert [p for p in check_program(program) if p.severity is Severity.ERROR] == []
    with TemporaryDirectory() as folder:
        file = Path(folder) / "part.mpf"
        with file.open("wb") as sink:
            claim = write(program, sink, wishes)
        run = run_program(file, model)
        found = verify(run, [path], allowed=claim.allowed, settings=claim.settings)
        return Posted(planned, file.read_text(encoding="utf-8"), run, found)


def rows_of_points(run: Run, tip: Floats, axis: Floats) -> list[int]:
    """The row of the run that ends at each point, found one after the other."""
    rows, at = [], 0
    for point, look in zip(tip, axis, strict=True):
        near = (np.abs(run.tip - point).max(axis=1) < 3e-5) & (np.abs(run.axis - look).max(axis=1) < 1e-6)
        near &= ~run.machine_frame & ((run.programmed & 7) != 0)
        candidates = np.flatnonzero(near[at:])
        assert len(candidates), "a CL point that the program does not reach"
        rows.append(at + int(candidates[0]))
        at = rows[-1]
    return rows


def great_circle_distance(look: Floats, begin: Floats, end: Floats) -> Floats:
    """Degrees from vectors (n, 3) to the arc of the great circle from ``begin`` to ``end``."""
    pole = np.cross(begin, end)
    length = float(np.linalg.norm(pole))
    if length < 1e-9:
        return apart(look, end)
    pole /= length
    foot = look - np.outer(look @ pole, pole)
    foot /= np.linalg.norm(foot, axis=1)[:, None]
    inside = (np.cross(begin, foot) @ pole >= 0.0) & (np.cross(foot, end) @ pole >= 0.0)
    return np.where(inside, apart(look, foot), np.minimum(apart(look, begin), apart(look, end)))


def apart(look: Floats, other: Floats) -> Floats:
    """Degrees between unit vectors (n, 3)."""
    return np.asarray(np.degrees(2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(look - other, axis=1), 1.0))))


def worst_off(run: Run, tip: Floats, axis: Floats, kind: Sequence[int]) -> tuple[float, float]:
    """How far tip (mm) and, in cuts, tool axis (deg) are off the CAM's way, at fifty places of every block."""
    rows = rows_of_points(run, tip, axis)
    worst_tip = worst_axis = 0.0
    for k in range(1, len(tip)):
        samples = subdivide(run, 50, slice(rows[k - 1] + 1, rows[k] + 1))
        if not len(samples.row):
            continue
        p, way = tip[k - 1], tip[k] - tip[k - 1]
        part = np.clip((samples.tip - p) @ way / max(float(way @ way), 1e-30), 0.0, 1.0)
        off = np.linalg.norm(samples.tip - p - part[:, None] * way, axis=1).max()
        worst_tip = max(worst_tip, float(off))
        if kind[k] != Kind.RAPID:
            worst_axis = max(worst_axis, float(great_circle_distance(samples.axis, axis[k - 1], axis[k]).max()))
    return worst_tip, worst_axis


def minutes(run: Run, rows: Sequence[int]) -> float:
    """How long blocks at feed take, by their F and what it means."""
    total = 0.0
    for row in rows:
        way = float(np.linalg.norm(run.tip[row] - run.tip[row - 1]))
        total += 1.0 / run.feed[row] if run.feed_mode[row] == 93 else way / run.feed[row]
    return total


steps = st.tuples(st.floats(-30.0, 30.0), st.floats(-30.0, 30.0), st.floats(-20.0, 20.0))
lean = st.one_of(st.floats(-0.6, 0.6), st.just(0.0), st.floats(-1e-3, 1e-3))
kinds = st.sampled_from([Kind.LINEAR, Kind.LINEAR, Kind.RAPID])
rough = st.lists(st.tuples(steps, lean, lean, kinds), min_size=2, max_size=4)


@settings(deadline=None, max_examples=60, phases=[Phase.generate])
@given(
    st.sampled_from(NAMES),
    rough,
    st.sampled_from([0.001, 0.01, 0.1]),
    st.sampled_from([0.01, 0.05, 0.5]),
)
def test_the_tool_stays_on_its_way_between_blocks(
    name: str,
    path: list[tuple[tuple[float, float, float], float, float, Kind]],
    tip_tolerance: float,
    axis_tolerance: float,
) -> None:
    tip = np.round(np.cumsum([step for step, _, _, _ in path], axis=0), 5)
    assume(np.linalg.norm(np.diff(tip, axis=0), axis=1).min() > 0.1)
    axis = np.array([[i, j, 1.0] for _, i, j, _ in path])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    assume(np.abs(axis - [0.0, 0.0, 1.0]).max() > 1e-6)
    kind = np.array([Kind.RAPID, *(k for _, _, _, k in path[1:])], np.uint8)
    moves = replace(moves_of(tip, axis), kind=kind)
    done = post(
        machine(name),
        toolpath(operation_of(moves)),
        Wishes(tcp=False, tip_tolerance=tip_tolerance, axis_tolerance=axis_tolerance),
    )
    refused = [problem.what for problem in done.plan.problems if problem.severity is Severity.ERROR]
    event(f"refused: {bool(refused)}")
    if refused:
        return
    failed = [str(check) for check in done.found.checks if not check.passed]
    assert failed == []
    worst_tip, worst_axis = worst_off(done.run, tip, axis, kind.tolist())
    assert worst_tip <= tip_tolerance + 3e-5
    assert worst_axis <= axis_tolerance + 2e-5
    rows = rows_of_points(done.run, tip, axis)
    for k in np.flatnonzero(kind != Kind.RAPID).tolist():
        blocks = list(range(rows[k - 1] + 1, rows[k] + 1))
        way = float(np.linalg.norm(tip[k] - tip[k - 1]))
        at_rest = np.linalg.norm(np.diff(done.run.tip[rows[k - 1] : rows[k] + 1], axis=0), axis=1) < 2e-4
        if not at_rest.any():
            assert minutes(done.run, blocks) == pytest.approx(way / 100.0, rel=2e-3)
