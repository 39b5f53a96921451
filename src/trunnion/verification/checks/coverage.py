"""Which motions of a program checks look at, and why not at the others.

In:     a program; one that is compared with CL files for the checks that compare motions with them.
Out:    counts, and of the motions that are left out the first for each reason.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from operator import itemgetter
from typing import Final

import numpy as np

from trunnion.arrays import Codes
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import Kind
from trunnion.verification.context import ComparedContext, Context
from trunnion.verification.kinematics.positioning_moves import approach_rows, rotary_positioning_flags
from trunnion.verification.kinematics.seen_rows import SeenRows
from trunnion.verification.matching.hole_matching import hole_rows, match_holes
from trunnion.verification.results import Check, Coverage
from trunnion.verification.row_ranges import chunk_bounds

#: Why a motion is left out, by number; 0: it is not.
_CHECKED, _IN_MACHINE, _TURNS, _FROM_HOME, _IN_HOLE, _RAPID, _NO_POINT, _BETWEEN = range(8)

_REASONS: Final[dict[int, Callable[[], Wording]]] = {
    _IN_MACHINE: lambda: phrase("left_in_machine"),
    _TURNS: lambda: phrase("left_turns"),
    _FROM_HOME: lambda: phrase("left_from_home"),
    _IN_HOLE: lambda: phrase("left_in_hole"),
    _RAPID: lambda: phrase("left_rapid"),
    _NO_POINT: lambda: phrase("left_no_point"),
    _BETWEEN: lambda: phrase("left_between"),
}


#: The checks that compare motions with CL points; whether those on the way from point to point are judged, and rapids.
_POINTWISE: Final = {
    "tip": (False, True), "axis": (False, True), "kind": (True, True), "feed": (True, False), "spindle": (True, True),
    "tool": (True, True), "coolant": (True, True), "compensation": (True, True),
}  # fmt: skip


def coverage_of(context: Context, seen: SeenRows) -> Coverage:
    """Return the count of what was seen, and of what was not the first motion of each reason, in their order."""
    places = tuple(context.place(row, 0.0, why) for why, row in sorted(seen.left_out.items(), key=itemgetter(1)))
    return Coverage(seen.checked, len(context.run), places)


def with_coverage(context: ComparedContext, checks: Sequence[Check]) -> Iterator[Check]:
    """Yield checks, those that compare motions with CL points with what they have looked at."""
    why = _reasons(context)
    for check in checks:
        if check.key not in _POINTWISE:
            yield check
            continue
        between, rapids = _POINTWISE[check.key]
        here = why.copy()
        if not between:
            here[context.matching.intermediate[0]] = _BETWEEN
        if not rapids:
            here[(here == _CHECKED) & (context.run.kind == Kind.RAPID)] = _RAPID
        yield replace(check, coverage=_coverage(context, here))


def _reasons(context: ComparedContext) -> Codes:
    """Return why each motion is compared with no CL point, (n,); ``_CHECKED`` where it is."""
    run, matching = context.run, context.matching
    why = np.full(len(run), _NO_POINT, np.uint8)
    why[hole_rows(match_holes(run, context.expected))] = _IN_HOLE
    why[approach_rows(run)] = _FROM_HOME
    for first, end in chunk_bounds(len(run)):
        why[first:end][rotary_positioning_flags(run, first, end)] = _TURNS
    why[run.state.machine_frame.rows_with(True)] = _IN_MACHINE
    for nc, _ in matching.all_pair_chunks():
        why[nc] = _CHECKED
    for segments in matching.arc_segments:
        why[segments.nc] = _CHECKED
    return why


def _coverage(context: ComparedContext, why: Codes) -> Coverage:
    """Return the count, and the first motion of each reason: those first that no other check compares with anything."""
    reasons = [reason for reason in (_FROM_HOME, _NO_POINT, *_REASONS) if (why == reason).any()]
    places = tuple(
        context.place(int(np.argmax(why == reason)), 0.0, _REASONS[reason]()) for reason in dict.fromkeys(reasons)
    )
    return Coverage(int(np.count_nonzero(why == _CHECKED)), len(why), places)
