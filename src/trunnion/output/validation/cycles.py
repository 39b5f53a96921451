"""Hole-making cycles that a control does not have, or not so."""

from collections.abc import Callable, Mapping, Sequence

from trunnion.controls.definition import Control
from trunnion.controls.vocabulary import CYCLE_CALL_WORD, HOLES_IN_PLANES, HOLES_SETTING
from trunnion.errors import Problem
from trunnion.messages import Wording, phrase
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import CycleOff, CycleOn, Kind, Operation
from trunnion.output.holes.holes_under_tcp import check_holes_under_tcp
from trunnion.output.program import Program
from trunnion.output.validation.feeds import rounding_problem
from trunnion.planning.holes.cycles import (
    Cycle,
    HoleCycleError,
    SpindleState,
    SpindleStates,
    UnsupportedCycleError,
    cycle_feed,
    cycle_from_event,
)


def unsupported_cycle_reasons(
    control: Control, settings: Mapping[str, str]
) -> Callable[[Cycle, SpindleState | None], Wording | None]:
    """Return a function that tells why a control does not have a cycle.

    It returns None if the control has the cycle, or if the CL file leaves something out that it needs.
    """
    known = {**control.settings, **{key: value for key, value in settings.items() if value}}
    formats = control.number_formats(three_axis=True)

    def reason(cycle: Cycle, spindle: SpindleState | None) -> Wording | None:
        if not cycle.depth:
            return phrase("hole_ends_at_point")
        try:
            control.family.cycle_call(cycle, 0.0, spindle, known, formats)
        except UnsupportedCycleError as error:
            return error.wording
        except HoleCycleError:
            pass
        return None

    return reason


def cycle_problems(program: Program, motion: Motion, spindle: SpindleState | None) -> list[Problem]:
    """Return what is wrong with the cycles of a motion; ``spindle``: before it, None if it stands still."""
    operation = motion.as_written() if any(isinstance(e, CycleOn) for e in motion.operation.events) else None
    if operation is None:
        return []
    along_tool = motion.mode is MachiningMode.TCP and program.control.turns_between_holes(program.effective_settings())
    problems, warnings = list[Problem](), list[Problem]()
    spindles = SpindleStates(operation.events, spindle)
    switches = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
    ends = [*(event.row for event in switches[1:]), len(operation.moves)]
    for event, end in zip(switches, ends, strict=True):
        if not isinstance(event, CycleOn):
            continue
        states = [spindles.at(row) for row in (event.row, *spindles.changes_between(event.row, end))]
        try:
            warning = _check_cycle(program, motion, operation, event, states, along_tool)
            warnings += [warning] if warning else []
        except HoleCycleError as error:
            problems.append(Problem(program.file_of(operation), event.line, error.wording))
    if along_tool and not problems:
        problems = [Problem(program.file_of(operation), e.line, e.wording) for e in check_holes_under_tcp(operation)]
    return [*problems, *warnings]


def _check_cycle(
    program: Program,
    motion: Motion,
    operation: Operation,
    event: CycleOn,
    spindles: Sequence[SpindleState | None],
    along_tool: bool,
) -> Problem | None:
    """Raise ``HoleCycleError`` if the control cannot make the holes of a cycle; returns what it does to the feed.

    operation   of the motion, in the coordinates of its blocks
    spindles    at the first hole of the cycle, and wherever the spindle changes among its holes
    along_tool  the tool turns from hole to hole under TCP
    """
    moves, row, cycle = operation.moves, event.row, cycle_from_event(event)
    if motion.mode.is_simultaneous and not along_tool:
        raise _no_tilted_cycle(program, motion, cycle)
    spindle_here = spindles[0]
    formats = program.control.number_formats(motion.three_axis)
    settings = program.effective_settings() | ({} if along_tool else {HOLES_SETTING: HOLES_IN_PLANES})
    for state in spindles:
        program.control.family.cycle_call(cycle, 0.0, state, settings, formats)
    feed, per_rev = cycle_feed(cycle, spindle_here, float(moves.feed[row]), bool(moves.per_rev[row]))
    if not feed > 0.0:
        raise HoleCycleError(Wording("CTL310", "cycle_without_feed"))
    below = row > 0 and moves.tip[row - 1, 2] < moves.tip[row, 2] + cycle.rapid_height - 1e-6
    if below and not along_tool and moves.kind[row - 1] != Kind.RAPID:
        raise HoleCycleError(Wording("PLN650", "cycle_while_tool_below"))
    if cycle.method.startswith("TAP"):
        return None
    words = program.control.family.WORDS
    if per_rev and "feed_per_rev" not in words:
        raise HoleCycleError(Wording("CTL330", "feed_per_revolution_control"))
    if per_rev and spindle_here is not None and CYCLE_CALL_WORD in words:
        feed, per_rev = feed * spindle_here.rpm, False  # a cycle that is called hole by hole has mm/min
    return rounding_problem(program.file_of(operation), event.line, formats, feed, per_rev)


def _no_tilted_cycle(program: Program, motion: Motion, cycle: Cycle) -> HoleCycleError:
    """Return the error for a cycle along a tilted tool axis without a tilted plane."""
    settings, under_tcp = program.effective_settings(), motion.mode is MachiningMode.TCP
    has_planes = MachiningMode.TILTED in program.control.modes(settings)
    turns = HOLES_SETTING in settings
    if not has_planes and turns and under_tcp:
        wording = Wording("CTL370", "hole_without_tilted_plane", method=cycle.method, name=HOLES_SETTING)
    elif not has_planes:
        wording = Wording("CTL370", "no_planes", method=cycle.method)
    elif not under_tcp:
        wording = Wording("CTL370", "without_tcp", method=cycle.method)
    elif turns:
        wording = Wording("CTL370", "hole_with_tcp", method=cycle.method, name=HOLES_SETTING)
    else:
        wording = Wording("CTL370", "with_tcp", method=cycle.method)
    return HoleCycleError(wording)
