"""Ways behind blocks that may be skipped: they lead the tool above all cuts, whether the blocks are skipped or not.

Behind an OPSKIP/OFF a program may state again where the skipped blocks lead, as with the switch on the tool comes from
elsewhere. These motions have no CL point; they are recognized by what they do: rapids that begin straight up along the
tool, if the tool is not above all cuts of the operation, stay above them, and end above them or come straight down.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.context import ComparedContext
from trunnion.verification.expected.holes import without_holes
from trunnion.verification.expected.path import Section
from trunnion.verification.kinematics.positioning_moves import approach_rows, rotary_positioning_flags

#: Rows between two CL points that are looked at, at most: points between may keep the tip on its line without TCP.
_MOST_ROWS: Final = 1000

#: Tool axes are the same when no component differs by more than this.
_SAME_AXIS: Final = 1e-6


def ways_behind_skipped(context: ComparedContext) -> set[int]:
    """Return the motions without a CL point that lead the tool safely to or from blocks that may be skipped."""
    return {row for rows, _ in _ways(context) for row in rows.tolist()} | set(_raises(context))


def points_behind_ways(context: ComparedContext) -> set[int]:
    """Return the motions to CL points to which such ways lead, and to which the tool does not come aslant."""
    return {row for _, row in _ways(context)}


def _raises(context: ComparedContext) -> Iterator[int]:
    """Yield rapids straight up right before blocks that may be skipped: to the height at which both ways go on."""
    run, matching = context.run, context.matching
    extra, near = set(matching.extra), 4.0 * context.expected.max_tip_tolerance + 1e-6
    for point in sorted(context.expected.first_skipped):
        k = matching.cl.count_before(point)
        row = int(matching.nc[k]) - 1 if k < len(matching.cl) else 0
        if (
            row < 1
            or row not in extra
            or run.kind[row] != Kind.RAPID
            or run.state.machine_frame.at(np.array([row - 1]))[0]
        ):
            continue
        positions = run.positions(np.array([row - 1, row]))
        if _goes_straight(positions.tip, positions.axis, near, 1):
            yield row


def _ways(context: ComparedContext) -> Iterator[tuple[Ints, int]]:
    """Yield the motions of each such way, and the motion to the CL point behind them."""
    run, matching = context.run, context.matching
    extra = np.array(matching.extra, np.int64)
    if not len(extra):
        return
    approaches = approach_rows(run)
    for point in sorted(context.expected.behind_skipped):
        section, k = context.expected.section_at(point), matching.cl.count_before(point)
        if k == len(matching.cl):
            continue
        before, behind = int(matching.nc[k - 1]) if k else -1, int(matching.nc[k])
        rows: Ints = np.arange(before + 1, behind)
        if not 0 < len(rows) <= _MOST_ROWS:
            continue
        legs = [
            leg._replace(rows=leg.rows[~np.isin(leg.rows, approaches)])
            for leg in _legs(run, before if point > section.first else -1, rows)
        ]
        stated = np.concatenate([rows[:0], *(leg.rows for leg in legs)])
        is_rapid = bool(np.isin(stated, extra).all()) and bool((run.kind[stated] == Kind.RAPID).all())
        if is_rapid and all(_is_above(context, section, leg) for leg in legs):
            yield stated, behind


class _Leg(NamedTuple):
    """Rows of a way, from home or from a row ``before``; -1: from home."""

    rows: Ints
    before: int


def _legs(run: Run, before: int, rows: Ints) -> list[_Leg]:
    """Return the legs of a way between which it goes home; only one if it does not.

    before  the row from which it comes; -1: from another operation, and over home
    """
    home = run.state.machine_frame.at(rows) | rotary_positioning_flags(run, int(rows[0]), int(rows[-1]) + 1)
    words = {event.before_row - int(rows[0]) for event in run.events if event.kind in ("retract", "tool_change")}
    edges = [
        0,
        *sorted({at for at in words if 0 <= at <= len(rows)} | set((np.flatnonzero(np.diff(home)) + 1).tolist())),
    ]
    parts = [slice(*pair) for pair in pairwise([*edges, len(rows)])]
    legs = [_Leg(rows[part], -1) for part in parts if part.start < part.stop and not home[part.start]]
    goes_home = bool(home[0]) or 0 in words
    if before < 0:
        return legs if goes_home or len(parts) == 1 else legs[1:]
    return [_Leg(rows[:0], before), *legs] if goes_home else [legs[0]._replace(before=before), *legs[1:]]


def _is_above(context: ComparedContext, section: Section, leg: _Leg) -> bool:
    """Whether the tool stays above all cuts on a leg, behind a way straight up, and before one straight down."""
    from_home = leg.before < 0
    rows = leg.rows if from_home else np.concatenate(([leg.before], leg.rows))
    if not len(rows):
        return True
    if not len(leg.rows) and context.run.kind[leg.before] == Kind.RAPID:
        return True  # it goes home from where the CL file has drawn it back
    positions, near = context.run.positions(rows), 4.0 * context.expected.max_tip_tolerance + 1e-6
    tip, axis = positions.tip, positions.axis
    high = np.array([_height(section, own) - near <= float(at @ own) for at, own in zip(tip, axis, strict=True)])
    first, last = int(np.argmax(high)), len(high) - 1 - int(np.argmax(high[::-1]))
    if not high[first : last + 1].all() or (from_home and first > 0):
        return False
    up, down = slice(first + 1), slice(last, None)
    return _goes_straight(tip[up], axis[up], near, 1) and _goes_straight(tip[down], axis[down], near, -1)


def _goes_straight(tip: Floats, axis: Floats, near: float, sense: int) -> bool:
    """Whether places (k, 3) lie one above the other along one tool axis, up (1) or down (-1)."""
    steps = np.diff(tip, axis=0)
    along = steps @ axis[0]
    aside = np.linalg.norm(steps - along[:, None] * axis[0], axis=1)
    same: Flags = np.abs(axis - axis[0]).max(axis=1) <= _SAME_AXIS
    return bool(same.all() and (sense * along >= -near).all() and (aside <= near).all())


def _height(section: Section, axis: Floats) -> float:
    """How high the cuts and holes of an operation come along a direction (3,), mm."""
    moves = section.whole.moves
    cuts = (moves.kind != Kind.RAPID) | without_holes(section.whole)[1]
    return float((moves.tip[cuts] @ axis).max(initial=-np.inf))
