"""Ways from home to an operation, or behind a turn within one, that move axes together.

With the setting ``first_approach=in_turn`` one group goes after the other: linear axes that lead away, the rotary axes,
those across the tool, the one along it.
"""

from collections.abc import Iterator

import numpy as np

from trunnion.messages import Wording
from trunnion.model.programmed_words import POSITION_WORDS
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.checks.rotary_moves_at_part import rows_away
from trunnion.verification.context import ComparedContext, Context
from trunnion.verification.kinematics.positioning_moves import first_workpiece_position, is_leg_of_axes
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.results import Place

#: Rotary motion of less than this is none, degrees; so far may a tool leave its axis by rounding, mm.
_TURNS = 1e-3
_ASIDE = 2e-3

_ACROSS = int(ProgrammedWord.X | ProgrammedWord.Y)
_ALONG = int(ProgrammedWord.Z)


def not_in_turn(context: Context) -> Iterator[Place]:
    """Yield a row of each way from home that moves axes together, where the settings want them in turn."""
    away = rows_away(context) if isinstance(context, ComparedContext) and context.settings.in_turn else None
    if away is None or not isinstance(context, ComparedContext):
        return
    run = context.run
    holes = match_holes(run, context.expected) if context.expected.holes else ()
    by_first = {hole.first: hole for hole in holes}
    at_holes = np.array(sorted(by_first), np.int64)
    for start, end in zip(away.tolist(), [*away[1:].tolist(), len(run)], strict=True):
        begin = start + 1 if start < len(run) and run.state.machine_frame[start] else start
        first = first_workpiece_position(run, begin, end)
        if first is None:
            continue
        points = context.matching.nc
        k, hole = points.count_before(first), int(np.searchsorted(at_holes, first))
        at_point = min(points[k], end) if k < len(points) else end
        at_hole = min(int(at_holes[hole]), end) if hole < len(at_holes) else end
        by_cycle = at_hole < at_point and not by_first[at_hole].by_motion
        row = _row_of_fault(context, first, min(at_point, at_hole), by_cycle=by_cycle)
        if row is not None:
            yield context.place(row, 0.0, Wording("modal", "together"))


def _row_of_fault(context: ComparedContext, first: int, arrival: int, *, by_cycle: bool) -> int | None:
    """Return the row of a way that moves axes together: from its first row on, to a CL point or to a hole.

    by_cycle  a cycle makes the hole, and goes there across the tool first
    """
    run = context.run
    if arrival >= len(run):
        return None
    for row in range(first, arrival + 1):
        if _turns_on_the_way(run, row):
            return row
    if by_cycle:
        both = (row for row in range(first, arrival) if _goes_across_and_along(run, row))
        return next(
            (
                row
                for row in both
                if not (row == first and run.state.follows_at(np.array([row]))[0] and row + 1 < arrival)
            ),
            None,
        )
    k, points = context.matching.nc.count_before(arrival), context.matching
    if k < len(points.nc) and points.nc[k] == arrival and context.expected.section_at(points.cl[k]).kept is not None:
        return None
    moves_together = run.kind[arrival] == Kind.RAPID and arrival > 0 and not _moves_along_tool(run, arrival)
    return arrival if moves_together else None


def _turns_on_the_way(run: Run, row: int) -> bool:
    """Whether a row turns rotary axes and moves linear ones by its words."""
    if row == 0 or not int(run.programmed[row]) & int(POSITION_WORDS):
        return False
    return bool((np.abs(run.rotary[row] - run.rotary[row - 1]) > _TURNS).any())


def _goes_across_and_along(run: Run, row: int) -> bool:
    words = int(run.programmed[row])
    return bool(words & _ACROSS and words & _ALONG) and not is_leg_of_axes(run, row)


def _moves_along_tool(run: Run, row: int) -> bool:
    """Whether a row moves the tool along its axis alone, or one linear axis alone."""
    positions = run.positions(np.array([row - 1, row]))
    step, axis = positions.tip[1] - positions.tip[0], positions.axis[1]
    joints = np.abs(positions.joints[1] - positions.joints[0])
    aside = float(np.linalg.norm(step - float(step @ axis) * axis))
    return aside <= _ASIDE or int((joints[list(run.machine.linear)] > _ASIDE).sum()) <= 1
