"""LinuxCNC programs of ours in its own interpreter: it takes every one, and makes the motions that were planned."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.linuxcnc.interpreter import (
    SUBROUTINES,
    Canon,
    Move,
    RefusedByLinuxcncError,
    interpret,
    needs_linuxcnc,
)
from tests.support.toolpath_strategies import SAYABLE, operations
from trunnion.controls import load_control
from trunnion.errors import InputError, RefusedError, Severity
from trunnion.machines import Machine, load_machine
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import (
    Coolant,
    Dwell,
    Kind,
    Message,
    Operation,
    Sense,
    SpindleOff,
    SpindleOn,
    Stop,
    Toolpath,
)
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.output.subprograms import SubprogramOutput
from trunnion.output.validation import check_program
from trunnion.planning import ControlCapabilities, PlanOptions, plan
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions


def roomy(machine: Machine) -> Machine:
    """The machine with slides that have no end, and with a known workpiece and tool."""
    axes = tuple(axis if axis.is_rotary else replace(axis, low=-1e6, high=1e6) for axis in machine.axes)
    return replace(machine, axes=axes, workpiece_zero=(0.0, 0.0, 0.0), tool_length=25.4)


#: Their workpiece and tool are known, as programs without TCP need it; the slides have room for everything.
MACHINES = {name: roomy(load_machine(name)) for name in ("xyzac_trt", "xyzbc_trt", "linuxcnc_5axis")}
CONTROLS = {name: load_control(machine.control) for name, machine in MACHINES.items()}

#: What LinuxCNC has words for; compensated paths are judged by it as paths of another tool.
KINDS = {name: kind for name, kind in SAYABLE.items() if name not in ("comp", "coolant")} | {
    "coolant": st.sampled_from(["ON", "MIST", "FLOOD", "TAP", "OFF"]).map(lambda kind: Coolant(0, 0, kind)),
    "spindle off": st.just(SpindleOff(0, 0)),
    "text stop": st.sampled_from(["look (here)", "py,print(1)", "%", "; N1 G0 X1", "(MSG,x", "x" * 700]).map(
        lambda text: Stop(0, 0, True, text)
    ),
    "message": st.builds(
        lambda text, display: Message(0, 0, text, display),
        st.sampled_from(["MSG, x", "py,print(1)", "DEBUG,#1", "close)", "刀" * 300, "log,x"]),
        st.booleans(),
    ),
}

AXES = st.one_of(st.just((0.0, 0.0, 1.0)), st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(0.5, 1)))


def control_moves(canon: Canon) -> list[list[Move]]:
    """The motions under each tool, operation by operation."""
    found: list[list[Move]] = []
    before = False
    for move in canon.moves:
        if move.offset:
            if not before:
                found.append([])
            # G1 with F alone is a motion to where the tool stands
            if move.kind == "arc" or not found[-1] or found[-1][-1].end != move.end:
                found[-1].append(move)
        before = move.offset
    return found


def planned_moves(motion: Motion, machine: Machine, spindle: SpindleOn | None) -> tuple[list[Move], SpindleOn | None]:
    """The motions that an operation asks for, and the spindle at its end."""
    operation = motion.operation
    moves, arcs = operation.moves, operation.arcs
    found: list[Move] = []
    coolant: frozenset[str] = frozenset()
    on = spindle is not None
    at = {int(row): k for k, row in enumerate(arcs.row)}
    words = {"ON": "FLOOD", "FLOOD": "FLOOD", "TAP": "FLOOD", "MIST": "MIST"}
    before: tuple[float, ...] = ()
    for row in range(len(moves)):
        for event in operation.events:
            if event.row != row:
                continue
            if isinstance(event, SpindleOn):
                spindle, on = event, True
            elif isinstance(event, SpindleOff):
                on = False
            elif isinstance(event, Coolant):
                coolant = coolant | {words[event.kind]} if event.kind != "OFF" else frozenset()
        rotary = dict.fromkeys("ABC", 0.0)
        rotary |= {machine.axes[c].name: float(motion.rotary[row, k]) for k, c in enumerate(machine.rotary)}
        decimals = 4 if motion.three_axis else 5
        tip = [round(float(value), decimals) + 0.0 for value in moves.tip[row]]
        end = (*tip, *(round(rotary[name], 5) + 0.0 for name in "ABC"))
        arc = at.get(row)
        if arc is None and end == before:
            continue
        before = end
        sense = 0 if not on or spindle is None else 1 if spindle.sense is Sense.CLW else -1
        rpm = 0.0 if spindle is None else round(spindle.rpm)
        state = float(moves.feed[row]), int(moves.per_rev[row]), rpm, sense, coolant, True, not motion.three_axis
        if arc is None:
            found.append(Move("rapid" if moves.kind[row] == Kind.RAPID else "line", end, *state))
            continue
        normal = int(np.argmax(np.abs(arcs.normal[arc])))
        centre = arcs.centre[arc][[(normal + 1) % 3, (normal + 2) % 3]].tolist()
        turns = (int(arcs.full_turns[arc]) + 1) * int(np.sign(arcs.normal[arc, normal]))
        found.append(Move("arc", end, *state, (centre[0], centre[1]), turns, normal))
    last = [event for event in operation.events if event.row == len(moves) and isinstance(event, SpindleOn)]
    return found, last[-1] if last else spindle


def agree(got: Move, wanted: Move) -> None:
    assert (got.kind, got.sense, got.coolant, got.tcp) == (wanted.kind, wanted.sense, wanted.coolant, wanted.tcp)
    np.testing.assert_allclose(got.end, wanted.end, atol=1.1e-4, rtol=0)
    if got.sense:
        assert got.rpm == wanted.rpm
    if got.kind != "rapid":
        assert got.feed_mode == wanted.feed_mode
        assert abs(got.feed - wanted.feed) <= 6e-4
    if got.kind == "arc":
        assert (got.turns, got.normal) == (wanted.turns, wanted.normal)
        np.testing.assert_allclose(got.centre, wanted.centre, atol=2.1e-4, rtol=0)


def written(
    name: str, toolpath: Toolpath, tcp: bool = True, folder: Path | None = None
) -> tuple[str, list[Motion]] | None:
    """The program and its motions; None where there can be none. Its subroutines, if it has any, go into a folder."""
    machine, control = MACHINES[name], CONTROLS[name]
    try:
        planned = plan(
            [toolpath],
            machine,
            control.arcs.chord_tolerance,
            PlanOptions(tcp=tcp),
            ControlCapabilities(modes=control.modes({})),
        )
    except (InputError, RefusedError):
        return None
    program = Program(machine, control, planned.motions, {"tool": "7", "standing_spindle": "allowed"}, toolpath.file)
    if any(problem.severity is Severity.ERROR for problem in check_program(program)):
        return None
    sink, others = io.BytesIO(), dict[str, io.BytesIO]()
    division = (
        None if folder is None else SubprogramOutput("part", lambda file: others.setdefault(file, io.BytesIO()), 8192)
    )
    write_program(program, sink, subprograms=division)
    for file, text in others.items():
        assert folder is not None
        (folder / file).write_bytes(text.getvalue())
    return sink.getvalue().decode(), list(planned.motions)


def accepted(text: str, folder: Path) -> Canon:
    """What LinuxCNC makes of a program, which it has to take."""
    try:
        return interpret(text, folder)
    except RefusedByLinuxcncError as refused:
        raise AssertionError(f"{refused}\n{text}") from None


def judged(name: str, toolpath: Toolpath, folder: Path, subroutines: Path | None = None) -> None:
    """LinuxCNC makes of the program what was planned, and of its subroutines if there is a folder for them."""
    found = written(name, toolpath, folder=subroutines)
    assume(found is not None)
    assert found is not None
    text, motions = found
    canon = accepted(text, folder)
    named = [] if subroutines is None else sorted(subroutines.glob("*.ngc"))
    run = run_program(folder / "part.ngc", MACHINES[name], RunOptions(subprograms=named))
    assert [str(each) for each in run.errors] == []
    made = control_moves(canon)
    spindle: SpindleOn | None = None
    assert len(made) == len(motions)
    for moves, motion in zip(made, motions, strict=True):
        wanted, spindle = planned_moves(motion, MACHINES[name], spindle)
        assert len(moves) == len(wanted)
        for got, want in zip(moves, wanted, strict=True):
            agree(got, want)
    dwells = [event for motion in motions for event in motion.operation.events if isinstance(event, Dwell)]
    assert sum(name == "DWELL" for _, name, _ in canon.notes) >= len(dwells)
    stops = sum(isinstance(event, Stop) for motion in motions for event in motion.operation.events)
    assert sum(name.endswith("PROGRAM_STOP") for _, name, _ in canon.notes) == stops


@needs_linuxcnc
@settings(max_examples=examples(25))
@given(st.sampled_from(sorted(MACHINES)), st.lists(operations(KINDS, AXES), min_size=1, max_size=2))
def test_linuxcnc_takes_every_program_and_makes_the_motions_that_were_planned(
    tmp_path_factory: pytest.TempPathFactory, name: str, found: list[Operation]
) -> None:
    judged(name, Toolpath("made.cls", tuple(found)), tmp_path_factory.getbasetemp())


@needs_linuxcnc
@settings(max_examples=examples(12))
@given(st.sampled_from(sorted(MACHINES)), st.lists(operations(KINDS, AXES), min_size=1, max_size=3))
def test_subroutines_in_files_of_their_own_make_the_motions_that_were_planned(
    tmp_path_factory: pytest.TempPathFactory, name: str, found: list[Operation]
) -> None:
    folder = tmp_path_factory.getbasetemp()
    subroutines = folder / SUBROUTINES
    subroutines.mkdir(exist_ok=True)
    for file in subroutines.iterdir():
        file.unlink()
    judged(name, Toolpath("made.cls", tuple(found)), folder, subroutines)


def in_other_planes(operation: Operation, turned: int) -> Operation:
    """An upright operation with its path turned: X becomes Y becomes Z."""
    moves, arcs = operation.moves, operation.arcs
    tip, centre, normal = (np.roll(column, turned, axis=1) for column in (moves.tip, arcs.centre, arcs.normal))
    return replace(operation, moves=replace(moves, tip=tip), arcs=replace(arcs, centre=centre, normal=normal))


@needs_linuxcnc
@settings(max_examples=examples(20))
@given(operations(KINDS, st.just((0.0, 0.0, 1.0))), st.integers(1, 2))
def test_arcs_and_helices_in_the_other_planes_are_those_that_were_planned(
    tmp_path_factory: pytest.TempPathFactory, operation: Operation, turned: int
) -> None:
    assume(len(operation.arcs.row))
    toolpath = Toolpath("made.cls", (in_other_planes(operation, turned),))
    judged("xyzac_trt", toolpath, tmp_path_factory.getbasetemp())


@needs_linuxcnc
@settings(max_examples=examples(15))
@given(st.sampled_from(sorted(MACHINES)), operations({"dwell": SAYABLE["dwell"]}, AXES))
def test_linuxcnc_takes_programs_without_tcp(
    tmp_path_factory: pytest.TempPathFactory, name: str, operation: Operation
) -> None:
    """Inverse time and feed per minute change where rotary axes begin and cease to turn."""
    found = written(name, Toolpath("made.cls", (operation,)), tcp=False)
    assume(found is not None)
    assert found is not None
    text, motions = found
    canon = accepted(text, tmp_path_factory.getbasetemp())
    assert not any(move.tcp for move in canon.moves)
    cuts = [move for moves in control_moves(canon) for move in moves if move.kind != "rapid"]
    assert all(move.feed > 0.0 for move in cuts)
    if any(motion.mode is MachiningMode.WITHOUT_TCP for motion in motions):
        assert "M428" not in text
