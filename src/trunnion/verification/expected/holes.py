"""Holes: what the cycles of a CL file ask for.

In:     operations with cycles.
Out:    holes in the program's frame, taken out of the CL points.

Heights are distances along the tool axis from the point of the hole, mm. The meaning of each word of a cycle is that
of docs/cl.md.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.model.toolpath import (
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

#: A spindle: rev/min, and 1 for clockwise, -1 for the other way, 0 for standing still.
SpindleSpeed = tuple[float, int]


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
    tip_tolerance: float
    tools: tuple[str, ...] = ()
    lengths: tuple[int, ...] = ()
    digit: float = 0.005

    @property
    def near(self) -> float:
        """How far places and heights may be off: points are rounded, each in three coordinates, mm."""
        return 3.0 * self.tip_tolerance + 2e-6

    @property
    def left(self) -> Floats:
        """Where the tool leaves it."""
        return np.asarray(self.tip + self.retract * self.axis)

    def seen(self, tip: Floats) -> tuple[Floats, Floats]:
        """Heights above the hole and distances from its line of places (k, 3), mm."""
        offset = tip - self.tip
        height = offset @ self.axis
        return height, np.linalg.norm(offset - height[:, None] * self.axis, axis=1)


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
    left = Arcs(place[arcs.row[stay]], arcs.centre[stay], arcs.normal[stay], arcs.radius[stay], arcs.full_turns[stay])
    events = tuple(replace(event, row=int(place[event.row])) for event in operation.events)
    return replace(operation, moves=moves.select(kept), arcs=left, events=events), holes


def cycle_holes(
    operation: Operation, holes: Flags, first: int, file: str, tip_tolerance: float, before: SpindleSpeed | None
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
        found.append(_hole(moves, row, begins, cycle, int(place[row]), file, tip_tolerance, spindle))
    return found


def spindle_at(operation: Operation, row: int, before: SpindleSpeed | None) -> SpindleSpeed | None:
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
    moves: Moves,
    row: int,
    begins: int,
    cycle: CycleOn,
    place: int,
    file: str,
    tip_tolerance: float,
    spindle: SpindleSpeed | None,
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
        tip_tolerance=tip_tolerance,
    )
