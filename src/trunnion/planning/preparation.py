"""First stage: every operation in the program's coordinate system, in its machining mode, with arcs, splines and cycles
that the control takes.

In:     operations as their CL files have them.
Out:    ``PreparedOperation``: other arcs are lines now, other cycles are rows of motion.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.errors import Problem, RefusedError, warning
from trunnion.messages import Wording, phrase
from trunnion.model.frames import into_frame, into_plane, relative_frame
from trunnion.model.motion import Decision, DecisionTopic, MachiningMode
from trunnion.model.toolpath import CycleOn, Frame, Kind, Operation, Phase
from trunnion.planning.holes.cycles import HoleCycleError, SpindleState, SpindleStates
from trunnion.planning.holes.operations import axis_change_rows, hole_rows, normalize_cycles, row_ranges, split_by_axis
from trunnion.planning.linearization.arc_chords import (
    MOST_LINES,
    arc_sweeps,
    arcs_a_control_takes,
    arcs_about_tool,
    flat_arcs,
    lines_for_arcs,
    single_turns,
)
from trunnion.planning.linearization.spline_rows import with_splines_kept
from trunnion.planning.machining_mode import (
    mode_conflicts,
    mode_of,
    supported_mode,
    tilted_plane,
    with_exact_upright_axis,
)
from trunnion.planning.request import OperationPart, PlanRequest, PreparedOperation
from trunnion.planning.skipped_ways import SkipRows, with_safe_ways

#: A move at 45 degrees is no plunge, whatever the noise of its coordinates.
_ACROSS = 1e-6

#: Two tool axes are opposite above this negative cosine: printed decimals would choose the way between them.
_OPPOSITE: Final = 1.0 - 1e-12

#: The product of a component of one direction with that of the opposite one is less, whatever is rounded.
_SAME_SIGN: Final = 1e-9


def prepare_operations(
    sources: Sequence[tuple[str, Operation]], requests: Sequence[PlanRequest]
) -> list[PreparedOperation]:
    """Prepare all operations of a program.

    sources   CL file and operation, in the order in which they are cut
    requests  that of each

    Raises ``RefusedError`` with everything that cannot be made: modes that the control lacks or the tool axis does not
    fit, and cycles.
    """
    frame = Frame() if requests[0].options.absolute_frame else sources[0][1].frame
    prepared: list[PreparedOperation] = []
    errors: list[Problem] = []
    lines = 0
    spindle: SpindleState | None = None
    for (file, original), request in zip(sources, requests, strict=True):
        try:
            operation, conflicts = _in_mode(_in_frame(request, file, original, frame))
            operation, unsafe = _with_safe_ways(operation)
            turned_over = list(_axes_turned_over(file, operation.operation))
            errors += (*conflicts, *unsafe, *turned_over)
            if not turned_over:
                prepared.append(_with_holes(_with_lines_for_arcs(_with_lines_for_splines(operation)), spindle))
        except HoleCycleError as error:
            errors.append(Problem(file, error.line, error.wording))
        lines += max(len(prepared[-1].operation.moves) - len(original.moves), 0) if prepared else 0
        if lines > MOST_LINES:
            wording = Wording("PLN550", "too_many_lines", operation=original.name, count=lines)
            raise RefusedError([Problem(file, original.line, wording)])
        spindle = SpindleStates(original.events, spindle).at(len(original.moves))
    if errors:
        raise RefusedError(errors)
    return prepared


def _axes_turned_over(file: str, operation: Operation) -> Iterator[Problem]:
    """Yield cuts along which the tool axis turns to the opposite direction: no one great circle leads there."""
    moves = operation.moves
    # An axis turned over has no component of the same sign: few rows are left to be looked at closer.
    rows = 1 + np.flatnonzero(moves.axis[:-1, 2] * moves.axis[1:, 2] < _SAME_SIGN)
    cosines = (moves.axis[rows - 1] * moves.axis[rows]).sum(axis=1)
    for row in rows[(cosines < -_OPPOSITE) & (moves.kind[rows] != Kind.RAPID)].tolist():
        yield Problem(file, int(moves.line[row]), Wording("PLN130", "axis_turns_over"))


def _in_frame(request: PlanRequest, file: str, original: Operation, frame: Frame) -> PreparedOperation:
    """Return the operation in the program's coordinate system ``frame``, with cycles around holes only."""
    operation = _with_feed_limit(into_frame(normalize_cycles(original), frame), request.options.feed_limit)
    own_frame = relative_frame(original.frame, frame)
    return PreparedOperation(request, file, original, operation, own_frame, request.options.simultaneous_mode)


def _with_safe_ways(prepared: PreparedOperation) -> tuple[PreparedOperation, list[Problem]]:
    """Return the operation with safe ways behind blocks that may be skipped, and where there are none."""
    from_home = np.zeros(len(prepared.operation.moves), np.bool_)
    from_home[0] = True
    if prepared.mode.is_simultaneous and _ranges_in_planes(prepared) is None and not _drills_along_tool(prepared):
        from_home[_turns_at_rapid(prepared.operation)] = any(
            isinstance(event, CycleOn) for event in prepared.operation.events
        )
    rows = SkipRows(hole_rows(prepared.original), from_home)
    operation, problems = with_safe_ways(prepared.file, prepared.operation, rows)
    return prepared.with_operation(operation), problems


def _turns_at_rapid(operation: Operation) -> Ints:
    """Return the rapids into which the tool axis turns.

    A way behind blocks that may be skipped, with the line of the row before, is none: it stays above the part.
    """
    turns, moves = axis_change_rows(operation), operation.moves
    return np.asarray(turns[(moves.kind[turns] == Kind.RAPID) & (moves.line[turns] != moves.line[turns - 1])])


def _with_feed_limit(operation: Operation, limit: float | None) -> Operation:
    """Return the operation with the feed limit as the feed of its cuts; holes, which are rapids here, keep theirs.

    So do plunges, unless theirs is higher.
    """
    if limit is None:
        return operation
    moves = operation.moves
    cuts = (moves.kind != Kind.RAPID) & (moves.phase == Phase.CUT) & ~moves.per_rev
    feed = np.where(_plunges(operation), np.minimum(moves.feed, limit), limit)
    return replace(operation, moves=replace(moves, feed=np.where(cuts, feed, moves.feed)))


def _plunges(operation: Operation) -> Flags:
    """Return moves that go down along the tool by more than they go across, (n,), a spline as a whole.

    So does the first, of which nobody knows where it begins.
    """
    moves, splines = operation.moves, operation.splines
    before = np.roll(moves.tip, 1, axis=0)
    end = moves.tip.copy()
    for k in range(len(splines)):
        first, last, _ = splines[k]
        before[first : last + 1], end[first : last + 1] = before[first].copy(), moves.tip[last]
    steps = end - before
    down = -np.einsum("ij,ij->i", steps, moves.axis)
    across = np.linalg.norm(steps + down[:, None] * moves.axis, axis=1)
    across[operation.arcs.row] = operation.arcs.radius * arc_sweeps(operation)
    plunges = down > across * (1.0 + _ACROSS)
    plunges[:1] = True
    return np.asarray(plunges)


def _in_mode(prepared: PreparedOperation) -> tuple[PreparedOperation, list[Problem]]:
    """Return the operation with its machining mode, and why it cannot be made in that mode."""
    file, operation = prepared.file, prepared.operation
    options, capabilities = prepared.request.options, prepared.request.capabilities
    mode = mode_of(operation, options.mode_for(operation.name), capabilities.negligible_tilt)
    mode, warnings = supported_mode(file, operation, mode, options, capabilities)
    conflicts = mode_conflicts(file, operation, mode, capabilities)
    if mode is MachiningMode.THREE_AXIS and not conflicts:
        operation = with_exact_upright_axis(operation)
    return replace(prepared, operation=operation, mode=mode, warnings=warnings), conflicts


def _with_lines_for_arcs(prepared: PreparedOperation) -> PreparedOperation:
    """Return the operation with lines in place of the arcs that the control does not take."""
    operation, capabilities = prepared.operation, prepared.request.capabilities
    is_tilted = prepared.mode is MachiningMode.TILTED
    written = operation
    if is_tilted:
        written = into_plane(operation, tilted_plane(operation.moves.axis[0], prepared.own_frame))
    keep = arcs_a_control_takes(written, capabilities.only_arcs_about_z, capabilities.helices_by_angle)
    if not capabilities.helices:
        keep &= flat_arcs(replace(operation, arcs=replace(operation.arcs, full_turns=0 * operation.arcs.full_turns)))
    if prepared.mode is MachiningMode.M114 or (prepared.mode is MachiningMode.TCP and not capabilities.arcs_with_tcp):
        keep[:] = False
    if is_tilted and capabilities.planes_from_pose:
        keep &= arcs_about_tool(operation)
    if not capabilities.multi_turn_arcs:
        operation, keep = single_turns(operation, keep)
    return prepared.with_operation(lines_for_arcs(operation, keep, prepared.request.chord_tolerance))


def _with_lines_for_splines(prepared: PreparedOperation) -> PreparedOperation:
    """Return the operation without the splines that must be the lines of their points."""
    operation, capabilities = prepared.operation, prepared.request.capabilities
    return prepared.with_operation(with_splines_kept(operation, prepared.mode, capabilities))


def _with_holes(prepared: PreparedOperation, spindle: SpindleState | None) -> PreparedOperation:
    """Return the operation with its parts, and with rows of motion in place of the cycles that the control lacks.

    spindle  the state before the operation

    Raises ``HoleCycleError`` when a cycle that would become motion leaves out something.
    """
    operation = prepared.operation
    if not any(isinstance(event, CycleOn) for event in operation.events):
        return prepared
    # Few programs have holes, and fewer have holes that are motion.
    from trunnion.planning.holes.hole_motion import REQUESTED, HoleConditions, convert_holes_to_motion

    options, capabilities = prepared.request.options, prepared.request.capabilities
    ranges = _ranges_in_planes(prepared)
    mode = prepared.mode if ranges is None else MachiningMode.TILTED
    objection: Wording | None = None
    if mode.is_simultaneous and not _drills_along_tool(prepared):
        objection = phrase("no_tilted_cycle_with_tcp" if mode is MachiningMode.TCP else "no_tilted_cycle_without_tcp")
        ranges = row_ranges(_turns_at_rapid(operation), len(operation.moves))
    from_home = np.zeros(len(operation.moves), np.bool_)
    from_home[[first for first, _ in ranges or ()]] = True
    conditions = HoleConditions(spindle, from_home, objection, capabilities.cycle_objection, options.holes_as_motion)
    holes = convert_holes_to_motion(operation, conditions)
    new = holes.first_rows
    log, warnings = [], list(prepared.warnings)
    for cycles in holes.converted:
        said = Wording("decision", "holes", description=cycles.description, reason=cycles.reason)
        log.append(Decision(prepared.file, operation.name, cycles.line, -1, DecisionTopic.HOLES, said))
        if cycles.reason != REQUESTED:
            warnings.append(
                warning(
                    prepared.file,
                    cycles.line,
                    Wording("PLN640", "as_motion", reason=cycles.reason, description=cycles.description),
                )
            )
    return replace(
        prepared,
        operation=holes.operation,
        mode=mode,
        parts=[
            OperationPart(int(new[first]), int(new[end]), ends_in_hole=bool(new[end] - new[end - 1] > 1))
            for first, end in ranges or ()
        ],
        warnings=warnings,
        log=log,
    )


def _ranges_in_planes(prepared: PreparedOperation) -> list[tuple[int, int]] | None:
    """Rows of the planes in which holes along several axes are made; None: they are not made in planes."""
    options, capabilities = prepared.request.options, prepared.request.capabilities
    if not prepared.mode.is_simultaneous or MachiningMode.TILTED not in capabilities.modes:
        return None
    if options.mode_for(prepared.operation.name) is not None:
        return None
    if prepared.mode is MachiningMode.TCP and capabilities.turns_between_holes:
        return None
    return split_by_axis(prepared.operation)


def _drills_along_tool(prepared: PreparedOperation) -> bool:
    """Whether cycles drill along a tool axis that changes from hole to hole."""
    options, capabilities = prepared.request.options, prepared.request.capabilities
    return prepared.mode is MachiningMode.TCP and capabilities.turns_between_holes and not options.holes_as_motion
