"""Records of Mastercam's NCI about holes: a cycle with its first hole (81), each further hole (100), and the end (80).

A hole has two points, its bottom and the one above it at which the tool begins; the tool axis goes from one to the
other. Heights are coordinates along it: that of the upper point, that from which on the tool feeds, and the surface.
"""

import math
from typing import Final, NamedTuple

from trunnion.cl.assemble import FILE_FEED
from trunnion.cl.conventions import CycleParts
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement
from trunnion.cl.statements import cycles, motion
from trunnion.cl.statements.nci_motion import check_flag
from trunnion.cl.statements.nci_records import begin_motion, record, remark_values, values_of
from trunnion.messages import Wording
from trunnion.records import dataclass

_CYCLE_VALUES: Final = 19
_HOLE_VALUES: Final = 13

#: Modes by the type of a cycle, where it has pecks, and where not; other types are settled by the post of a shop.
_PECKS: Final = {1.0: ["DRILL", "DEEP"], 2.0: ["DRILL", "BRKCHP"]}
_PLAIN: Final = {0.0: ["DRILL"], 3.0: ["TAP"], 4.0: ["REAM"]}
_DRILL, _REAM = 0.0, 4.0

#: Values of a cycle that something becomes of, places from 1; 9, 10 and 14 are distances within the cycle.
_FOLLOWED: Final = frozenset(range(1, _CYCLE_VALUES + 1)) - {9, 10, 14}

#: How far two heights may differ to be one, in units of the file: they are printed with six decimals.
_SAME_HEIGHT: Final = 1e-5


class _Hole(NamedTuple):
    """What a record says of its hole; lengths in units of the file.

    bottom, upper  its points
    begin, feeds   heights of the upper point, and from which on the tool feeds
    """

    bottom: tuple[float, ...]
    upper: tuple[float, ...]
    begin: float
    feeds: float
    dwell: float
    feed: float
    flag: float


@dataclass(slots=True)
class Drilling:
    """The last cycle: its type, the height of the surface, and its peck, 0 without pecks."""

    kind: float = 0.0
    surface: float = 0.0
    peck: float = 0.0


def begin(state: ReaderState, statement: Statement) -> None:
    """Begin a cycle, and make its first hole."""
    values = values_of(state, statement, _CYCLE_VALUES)
    kind, dwell, feed, peck, next_peck = values[0], *values[4:8]
    is_settled = kind in _PECKS or (kind in _PLAIN and not (kind == _REAM and dwell))
    if not is_settled:
        raise StatementError(Wording("CL250", "cycle_record", record=record(state, statement), kind=kind))
    if kind in _PECKS and (not peck > 0.0 or next_peck not in (0.0, peck)):
        raise StatementError(
            Wording("CL830", "nci_pecks", record=record(state, statement), first=peck, following=next_peck)
        )
    followed = _FOLLOWED if kind in _PECKS else _FOLLOWED - {7, 8}
    remark_values(state, state.line, statement, followed | {n for n, value in enumerate(values, 1) if not value})
    drilling = state.own(Drilling)
    drilling.kind, drilling.surface, drilling.peck = kind, values[12], peck if kind in _PECKS else 0.0
    points = _points(state, statement, values[1:4], values[14:17], values[18])
    _make(state, statement, _Hole(*points, values[10], values[11], dwell, feed, values[17]))


def repeat(state: ReaderState, statement: Statement) -> None:
    """Make another hole by the cycle that is on."""
    unknown, *values = values_of(state, statement, _HOLE_VALUES)
    if not state.cycle_line:
        raise StatementError(Wording("CL850", "hole_without_cycle", record=record(state, statement)))
    if unknown:
        remark_values(state, state.line, statement, frozenset(range(2, _HOLE_VALUES + 1)))
    begin_at, feeds, dwell, feed = values[3:7]
    points = _points(state, statement, values[:3], values[7:10], values[11])
    _make(state, statement, _Hole(*points, begin_at, feeds, dwell, feed, values[10]))


def end(state: ReaderState, statement: Statement) -> None:
    """End the cycle; nothing stands in the line below."""
    values_of(state, statement, 0)
    cycles.cycle(state, statement._replace(major="CYCLE", values=("OFF",)))


def _points(
    state: ReaderState, statement: Statement, bottom: tuple[float, ...] | list[float],
    upper: tuple[float, ...] | list[float], is_turned: float
) -> tuple[tuple[float, ...], tuple[float, ...]]:  # fmt: skip
    """Return bottom and upper point of a hole; the last value of a record says whether they are exchanged."""
    if is_turned not in (0.0, 1.0):
        raise StatementError(Wording("CL165", "unknown_value", record=record(state, statement), value=is_turned,
                                     known=("0", "1")))  # fmt: skip
    first, second = tuple(bottom), tuple(upper)
    return (second, first) if is_turned else (first, second)


def _make(state: ReaderState, statement: Statement, hole: _Hole) -> None:
    """Write the row of a hole, its point in the surface, and before it the cycle where that is another one."""
    drilling, contour = state.own(Drilling), begin_motion(state)
    check_flag(state, statement, hole.flag)
    length = math.dist(hole.bottom, hole.upper)
    depth = length - (hole.begin - drilling.surface)
    rapid, back = hole.feeds - drilling.surface, hole.begin - drilling.surface
    if not (depth > _SAME_HEIGHT and rapid >= -_SAME_HEIGHT and back >= rapid - _SAME_HEIGHT):
        heights = tuple(f"{height:g}" for height in (hole.begin, hole.feeds, drilling.surface, hole.begin - length))
        raise StatementError(Wording("CL830", "nci_heights", record=record(state, statement), heights=heights))
    if hole.dwell < 0.0:
        raise StatementError(Wording("CL830", "nci_dwell", record=record(state, statement), dwell=hole.dwell))
    if not hole.feed > 0.0:
        raise StatementError(Wording("CL710", "no_feed", record=record(state, statement), feed=hole.feed))
    parts = CycleParts(list(_PECKS.get(drilling.kind) or _PLAIN[drilling.kind]))
    if drilling.kind == _DRILL and hole.dwell:
        parts.mode = ["FACE"]
    parts.couplets += [("STEP", (drilling.peck,))] if drilling.peck else []
    parts.couplets += [("RAPTO", (_clean(rapid),)), ("FEDTO", (-_clean(depth),)), ("RTRCTO", (_clean(back),))]
    parts.couplets.append((FILE_FEED, (hole.feed,)))
    parts.couplets += [("DWELL", (hole.dwell,))] if hole.dwell else []
    now = state.cycle if state.cycle_line else None
    if now is None or (list(now.mode), list(now.values)) != (parts.mode, parts.couplets):
        cycles.begin_cycle(state, parts)
    axis = tuple((u - b) / length for u, b in zip(hole.upper, hole.bottom, strict=True))
    point = tuple(b + depth * a for b, a in zip(hole.bottom, axis, strict=True))
    contour.place, contour.feed, contour.cuts = 0, 0.0, False
    motion.write_row(state, (*point, *axis))


def _clean(height: float) -> float:
    """Return a height without the noise of a difference: heights are printed with six decimals."""
    return round(height, 7) + 0.0
