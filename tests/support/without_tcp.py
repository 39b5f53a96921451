"""Paths posted without TCP, and how far the tool goes off them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from hypothesis import strategies as st

from tests.support.machines import at_zero, five_axis_machines
from trunnion.arrays import Floats
from trunnion.controls import load_control
from trunnion.errors import Severity
from trunnion.jobs.post.expected_values import expectation
from trunnion.machines import Machine, load_machine
from trunnion.model.motion import Plan
from trunnion.model.run import Run
from trunnion.model.subdivision import subdivide
from trunnion.model.toolpath import Kind, LoadTool, Operation, SpindleOn, Toolpath
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.output.validation import check_program
from trunnion.planning import PlanOptions, plan
from trunnion.readers import run_program
from trunnion.verification import ExpectedValues, Tolerances, Verification, verify

NAMES = sorted(five_axis_machines())
SINUMERIK = load_machine("yl569").control


def machine(name: str) -> Machine:
    """A machine with long slides, a part off its rotary axes, and a tool length if a head turns the tool."""
    model = at_zero(name)
    axes = tuple(axis if axis.is_rotary else replace(axis, low=-np.inf, high=np.inf) for axis in model.axes)
    length = 83.7 if model.has_rotary_head else None
    return replace(model, axes=axes, control=SINUMERIK, workpiece_zero=(37.0, -21.0, 110.0), tool_length=length)


def toolpath(operation: Operation) -> Toolpath:
    events = (LoadTool(0, 1, 1), SpindleOn(0, 1, 1000.0), *operation.events)
    return Toolpath("part.cls", (replace(operation, events=events, intol=0.01, outtol=0.01),))


@dataclass(frozen=True, eq=False)
class Posted:
    """A program with its run and its verification."""

    plan: Plan
    text: str
    run: Run
    found: Verification
    allowed: Sequence[Tolerances]
    settings: ExpectedValues


def post(model: Machine, path: Toolpath, options: PlanOptions) -> Posted:
    """Plan, write, read back and prove, whatever the problems of the plan."""
    control = load_control(model.control)
    planned = plan([path], model, control.arcs.chord_tolerance, options)
    program = Program(model, control, planned.motions, {}, "part.cls")
    assert [p for p in check_program(program) if p.severity is Severity.ERROR] == []
    with TemporaryDirectory() as folder:
        file = Path(folder) / "part.mpf"
        with file.open("wb") as sink:
            write_program(program, sink)
            expected = expectation(program, options)
        run = run_program(file, model)
        found = verify(run, [path], tolerances=expected.tolerances, settings=expected.settings)
        return Posted(planned, file.read_text(encoding="utf-8"), run, found, expected.tolerances, expected.settings)


def rows_of_points(run: Run, tip: Floats, axis: Floats) -> list[int]:
    """The row of the run that ends at each point, in their order."""
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
    """How far tip (mm) and, in cuts, tool axis (degrees) are off the CAM's path, at fifty places of every block."""
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


steps = st.tuples(st.floats(-30.0, 30.0), st.floats(-30.0, 30.0), st.floats(-20.0, 20.0))
