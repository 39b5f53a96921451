"""One machine of each family of controls, and toolpaths that go from one to another."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from tests.support.jobs import post_job
from trunnion.controls import Control
from trunnion.conversion import Conversion, convert, transfer_settings
from trunnion.jobs.post.expected_values import Expectation, expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import Machine
from trunnion.model.run import Run
from trunnion.model.toolpath import (
    Arcs,
    Coolant,
    Dwell,
    Frame,
    Kind,
    LoadTool,
    Message,
    Moves,
    Operation,
    Phase,
    Sense,
    SpindleOn,
    Tool,
    Toolpath,
)
from trunnion.output.program_writer import write_program
from trunnion.readers import run_program
from trunnion.verification import failures, restore_rapids, verify
from trunnion.verification.comparison import compare


@dataclass(frozen=True)
class Site:
    """A machine with its control, and half of the last digits it prints, mm and degrees."""

    machine: Machine
    control: Control
    tip: float
    angle: float

    @property
    def rapid_feed(self) -> float | None:
        """The feed of lines that stand for rapids."""
        text = self.control.settings.get("rapid_feed")
        return float(text) if text else None


def roomy(machine: Machine) -> Machine:
    """The machine with long slides and a fast spindle."""
    axes = tuple(axis if axis.is_rotary else replace(axis, low=-5e3, high=5e3) for axis in machine.axes)
    return replace(machine, axes=axes, spindle_max_rpm=None)


@st.composite
def paths(draw: st.DrawFn) -> Toolpath:
    """One or two operations of cuts and rapids, the tool axis turning slowly enough for every machine."""
    return Toolpath("made.cls", tuple(draw(operations(k)) for k in range(draw(st.integers(1, 2)))))


@st.composite
def operations(draw: st.DrawFn, number: int) -> Operation:
    """One operation. Its numbers come from a seed: there are many of them, and none is special."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    n = draw(st.integers(4, 30))
    tip = np.round(random.uniform(-60.0, 60.0, (n, 3)), draw(st.integers(2, 6)))
    lean = np.radians(np.clip(20.0 + np.cumsum(random.uniform(-3.0, 3.0, n)), 6.0, 40.0))
    turn = np.radians(30.0 + np.cumsum(random.uniform(-5.0, 5.0, n)))
    axis = np.column_stack((np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)))
    rapid = random.uniform(size=n) < 0.2
    rapid[0] = True
    feed = np.where(np.arange(n) < n // 2, 500.0, float(draw(st.integers(20, 2900))))
    feed[: int(np.argmin(rapid)) if not rapid.all() else n] = np.nan
    moves = Moves(
        tip=tip,
        axis=axis,
        kind=np.where(rapid, np.uint8(Kind.RAPID), np.uint8(Kind.LINEAR)),
        phase=np.where(rapid, np.uint8(Phase.RAPID), np.uint8(Phase.CUT)),
        feed=feed,
        per_rev=np.zeros(n, bool),
        line=np.arange(1, n + 1, dtype=np.int32),
    )
    events = [
        LoadTool(0, 1, 3 + number * draw(st.integers(0, 1))),
        SpindleOn(0, 1, float(draw(st.integers(100, 9999))), draw(st.sampled_from(Sense))),
    ]
    middle = draw(st.integers(1, n - 1))
    events += draw(
        st.sampled_from([[], [Coolant(middle, 1, "ON")], [Dwell(middle, 1, 1.5)], [Message(middle, 1, "X")]])
    )
    tool = Tool("MILL", "D10", 10.0, 5.0, 80.0)
    return Operation(f"OP{number}", tool, Frame(), moves, Arcs.empty(), tuple(events), 1, 0.01, 0.01)


def posted(path: Toolpath, site: Site, given: dict[str, str], target: Path) -> Run:
    """The run of the proven program of a toolpath."""
    return made(path, site, given, target)[0]


def made(path: Toolpath, site: Site, given: dict[str, str], target: Path) -> tuple[Run, Expectation]:
    """The run of a proven program, and what is expected of it."""
    options = parse_plan_options({}, site.control)
    program = plan_program([path], post_job(site.machine, site.control, options, given))[0]
    with target.open("wb") as sink:
        write_program(program, sink)
        expected = expectation(program)
    run = run_program(target, site.machine)
    found = verify(run, [path], tolerances=expected.tolerances, settings=expected.settings)
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]
    return run, expected


def converted(run: Run, one: Site, two: Site, target: Path) -> Run:
    """The run of a program of one control that is posted for another, without losing anything."""
    found = convert(run, one.control)
    assert not losses(found), losses(found)
    return posted(found.toolpath, two, transfer_settings(found.settings, one.control, two.control), target)


def losses(found: Conversion) -> list[str]:
    """What a conversion has lost. An operation may be divided: a rewind or a Fidia's M242 leaves the part."""
    return [str(problem) for problem in found.warnings if "the operation is divided" not in str(problem)]


def same(one: Run, first: Site, two: Run, second: Site) -> None:
    """Two runs follow one path: tips within half of both last digits, tool axes within the rounding of the angles."""
    found = compare(restore_rapids(one, first.rapid_feed), restore_rapids(two, second.rapid_feed), 0.01)
    assert found.same, "\n".join(found.lines())
    assert found.tip <= first.tip + second.tip + 1e-8
    assert found.axis <= 2.0 * (first.angle + second.angle) + 1e-8
