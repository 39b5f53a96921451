"""Holes: what the cycles of a CL file ask for, and which motions of a run were made by drilling cycles.

In:     operations with cycles; a run whose control has expanded its own cycles into motions.
Out:    holes in the program's frame, taken out of the CL points; the rows that make each hole.

Heights are distances along the tool axis from the point of the hole, mm. The meaning of each word of a cycle is that
of docs/cl.md.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.reader import Run
from trunnion.toolpath import (
    Arcs,
    CycleOff,
    CycleOn,
    Kind,
    Moves,
    Operation,
    Sense,
    SpindleOff,
    SpindleOn,
)
from trunnion.verify.rapids import PLACES, levels

#: A motion is along the tool axis, or across it, when it is off by less than this, mm.
_STRAIGHT = 1e-6

#: With TCP the same comes to this, mm, and this share of the way.
_PLACED, _LEANS = 2e-5, 1e-6

#: Tool axes are the same when no component differs by more than this.
_TURNED = 1e-6

#: A spindle: rev/min, and 1 for clockwise, -1 for the other way, 0 for standing still.
Spin = tuple[float, int]


@dataclass(frozen=True, slots=True, eq=False)
class Hole:
    """One hole.

    row       CL row, counted without holes, before which it is made
    mode      minor words of the cycle
    above     height to which the tool may go at rapid; retract: the one where it is left
    steps     strokes: the first, how much each next is shorter, the shortest; empty for one stroke
    feed      mm/min, or mm/rev where per_rev
    dwell     seconds, or spindle turns where dwell_turns
    tools     what the tool may be called; empty: nobody says
    lengths   numbers that its length may have where programs call it by one; empty: nobody says
    digit     how far the feed may be off for being rounded, in its unit
    rpm, sense  the spindle: rev/min and 1 clockwise, -1 the other way, 0 standing; None: nobody says
    """

    tip: Floats
    axis: Floats
    row: int
    line: int
    file: str
    mode: tuple[str, ...]
    above: float
    retract: float
    depth: float
    steps: tuple[float, ...]
    feed: float
    per_rev: bool
    dwell: float
    dwell_turns: bool
    rpm: float | None
    sense: int
    allowed: float
    tools: tuple[str, ...] = ()
    lengths: tuple[int, ...] = ()
    digit: float = 0.005


def without_holes(operation: Operation) -> tuple[Operation, Flags]:
    """The operation without the rows that are holes, and which rows those are, (n,) bool."""
    moves = operation.moves
    holes = np.zeros(len(moves), bool)
    for event in operation.events:
        if isinstance(event, CycleOn | CycleOff):
            holes[event.row :] = isinstance(event, CycleOn)
    holes &= moves.kind != Kind.RAPID
    if not holes.any():
        return operation, holes
    kept = ~holes
    place = np.concatenate(([0], np.cumsum(kept)))
    arcs = operation.arcs
    stay = kept[arcs.row] if len(arcs.row) else np.zeros(0, bool)
    left = Arcs(place[arcs.row[stay]], arcs.centre[stay], arcs.normal[stay], arcs.radius[stay], arcs.turns[stay])
    events = tuple(replace(event, row=int(place[event.row])) for event in operation.events)
    return replace(operation, moves=moves.part(kept), arcs=left, events=events), holes


def holes_of(
    operation: Operation, holes: Flags, first: int, file: str, allowed: float, before: Spin | None
) -> list[Hole]:
    """The holes of an operation as the CL file has it.

    ``first`` is the CL row of its first point that is none, ``before`` the spindle when it begins.
    """
    moves = operation.moves
    rows = np.flatnonzero(holes).tolist()
    if not rows:
        return []
    place = first + np.concatenate(([0], np.cumsum(~holes)))
    found: list[Hole] = []
    begins = -1
    for row in rows:
        cycle = next(e for e in reversed(operation.events) if isinstance(e, CycleOn) and e.row <= row)
        begins = begins if begins >= cycle.row and holes[row - 1] else row
        spindle = spindle_at(operation, row, before)
        found.append(_hole(moves, row, begins, cycle, int(place[row]), file, allowed, spindle))
    return found


def spindle_at(operation: Operation, row: int, before: Spin | None) -> Spin | None:
    """The spindle at a row, as rev/min and sense; ``before``: as it was when the operation began."""
    for event in operation.events:
        if event.row > row:
            break
        if isinstance(event, SpindleOn):
            before = event.rpm, 1 if event.sense is Sense.CLW else -1
        elif isinstance(event, SpindleOff):
            before = (before[0] if before else 0.0), 0
    return before


def _hole(
    moves: Moves, row: int, begins: int, cycle: CycleOn, place: int, file: str, allowed: float, spindle: Spin | None
) -> Hole:
    """One hole; its cycle's first hole since the last point that is none is row ``begins``."""
    values, words = dict(cycle.values), dict(cycle.words)

    def value(word: str, default: float) -> float:
        return values[word][0] if values.get(word) else default

    above = value("RAPTO", value("CLEAR", math.nan))
    if words.get("RTRCTO") == "AUTO":
        retract = float(moves.axis[begins] @ (moves.tip[begins - 1] - moves.tip[begins])) if begins else math.nan
    else:
        retract = value("RTRCTO", above)
    depth = abs(value("FEDTO", 0.0))
    if "CSINK" in cycle.mode and values.get("CSKDIA"):
        depth = values["CSKDIA"][0] / (2.0 * math.tan(0.5 * math.radians(value("TLANGL", math.nan))))
    per_rev = bool(values.get("MMPR"))
    feed = value("MMPR", value("MMPM", float(moves.feed[row])))
    return Hole(
        tip=moves.tip[row],
        axis=moves.axis[row],
        row=place,
        line=int(moves.line[row]),
        file=file,
        mode=cycle.mode,
        above=above,
        retract=max(retract, above),
        depth=depth,
        steps=tuple(values.get("STEP", ())) if {"DEEP", "BRKCHP"} & set(cycle.mode) else (),
        feed=feed,
        per_rev=per_rev or ("MMPM" not in values and bool(moves.per_rev[row])),
        dwell=value("DWELL", 0.0),
        dwell_turns=words.get("DWELL") == "REV",
        rpm=None if spindle is None else spindle[0],
        sense=0 if spindle is None else spindle[1],
        allowed=allowed,
    )


@dataclass(frozen=True, slots=True)
class Made:
    """Rows ``first`` to ``end`` (left out) that make one hole; the first goes to it, the others are the cycle's."""

    first: int
    end: int


def made_in(run: Run, holes: Sequence[Hole] = ()) -> list[Made]:
    """The motions of a run that its drilling cycles made, hole by hole.

    A thread that is cut by a block of its own has besides the rapid to it and, where the ``holes`` of the CL files want
    that, the rapid straight up behind it.
    """
    cycle = np.flatnonzero((run.programmed == 0) & (run.kind != Kind.ARC))
    if not len(cycle):
        return []
    found: list[Made] = []
    for k, part in enumerate(np.split(cycle, np.flatnonzero(np.diff(cycle) != 1) + 1)):
        first, end = int(part[0]), int(part[-1]) + 1
        to = first - 1 if first and run.blocks[first - 1] == run.blocks[first] else first
        if to == first and first and run.kind[first] != Kind.RAPID and run.kind[first - 1] == Kind.RAPID:
            to -= 1
            back = k < len(holes) and holes[k].retract > holes[k].above + 1e-9
            end += back and end < len(run) and run.kind[end] == Kind.RAPID and _leg(run, end)[1] > 0.0
        found.append(Made(to, end))
    return found


def straight_over(run: Run, first: Hole, made: Made, second: Hole, there: Made) -> float | None:
    """How high the tip stays on its way from a hole to the next one, whose axis is another, while the tool turns (TCP).

    At each place of the way it is counted from where the cycle of that hole may begin over which the tip is higher; the
    least of these heights, mm. None: the tool does not turn, or not on this way.
    """
    rows = np.arange(made.end, there.first + 1)
    turned = float(np.abs(first.axis - second.axis).max()) > _TURNED
    if not turned or not len(rows) or not run.state.tcp.at(rows).all():
        return None
    tips = run.poses(np.concatenate(([made.end - 1], rows))).tip
    heights = np.stack([(tips - hole.tip) @ hole.axis - hole.above for hole in (first, second)])
    lowest = float(heights.max(axis=0).min())
    apart = heights[0] - heights[1]
    for k in np.flatnonzero(apart[:-1] * apart[1:] < 0.0).tolist():  # as high over both
        part = apart[k] / (apart[k] - apart[k + 1])
        lowest = min(lowest, float(heights[0, k] + part * (heights[0, k + 1] - heights[0, k])))
    return lowest


def _leg(run: Run, row: int) -> tuple[float, float]:
    """How far a row goes across the tool axis and, if it does so by nothing else, along it, mm."""
    poses = run.poses(np.array([row - 1, row]))
    way = poses.tip[1] - poses.tip[0]
    up = float(way @ poses.axis[1])
    across = float(np.linalg.norm(way - up * poses.axis[1]))
    return across, up if across < _STRAIGHT else 0.0


def hole_rows(made: Sequence[Made]) -> Ints:
    """All rows that holes are made of, growing."""
    pieces = [np.arange(hole.first, hole.end) for hole in made]
    return np.concatenate(pieces) if pieces else np.zeros(0, np.int64)


def leads(run: Run, extra: Sequence[int], made: Sequence[Made]) -> set[int]:
    """Which of the motions that answer to no CL point only lead to a hole.

    They are rapids right before the motion to the hole: straight up along the tool axis from where the tool was, over
    the hole at that height, and straight down; or, from home or while the tool turns, over the hole itself.
    """
    approach, unasked = set(levels(run).tolist()), set(extra)
    lawful = set()
    for hole in made:
        row = hole.first - 1
        while row > 0 and row in unasked and run.kind[row] == Kind.RAPID:
            leg = _leads_how(run, row, hole.first, approach)
            if leg:
                lawful.add(row)
            if leg not in ("down", "across", "turned", "nowhere"):
                break
            row -= 1
    return lawful


def _leads_how(run: Run, row: int, first: int, approach: set[int]) -> str:
    """How a rapid leads to the hole to which row ``first`` goes; empty if it does not."""
    poses = run.poses(np.array([row - 1, row, first]))
    way, rest, axis = poses.tip[1] - poses.tip[0], poses.tip[2] - poses.tip[1], poses.axis[1]
    up, left = float(way @ axis), float(rest @ axis)
    # With TCP places and axes are rounded each by itself.
    near, part = (_PLACED, _LEANS) if run.state.tcp[row] else (_STRAIGHT, 0.0)
    straight = float(np.linalg.norm(way - up * axis)) < near + part * abs(up)
    over = float(np.linalg.norm(rest - left * axis)) < near + part * abs(left) and left < near
    from_home = (
        row - 1 in approach
        or bool(run.state.machine_frame[row - 1])
        or (int(run.programmed[row - 1]) & int(PLACES)) == 0
    )
    turned = float(np.abs(poses.axis[0] - axis).max()) > _TURNED
    if float(np.abs(way).max()) < near and not turned:
        return "nowhere"  # where a program goes on in another file, it says again where the tool stands
    if straight and up > 0.0:
        return "up"
    if float(np.abs(rest).max()) < _STRAIGHT and from_home:
        return "from home"
    if straight and over:
        return "down"
    if over and turned:
        return "turned"
    return "across" if over and abs(up) < _STRAIGHT else ""
