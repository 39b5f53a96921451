"""Holes that the cycles of a CL file ask for.

In:     operations with cycles.
Out:    holes in the program's frame, taken out of the CL points.

Heights are distances from the hole's CL point along the tool axis, mm. docs/cl.md defines the words of a cycle.
"""

import math
from bisect import bisect_right
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.model.toolpath import Arcs, CycleOff, CycleOn, Kind, Operation
from trunnion.records import dataclass
from trunnion.verification.expected.spindle_and_tool import ExpectedSpindle, ExpectedSpindles, ExpectedTool
from trunnion.verification.expected.tolerances import Tolerances


@dataclass(frozen=True, slots=True)
class HoleCycle:
    """How a hole is drilled; heights and depth are NaN where the CL file gives none.

    mode         minor words of the cycle
    clearance    height down to which the tool may go at rapid (RAPTO)
    retract      height at which the tool leaves the hole (RTRCTO)
    depth        depth below the CL point, mm
    pecks        of STEP: the first peck, how much each next one is shorter, the shortest; empty: one peck
    feed         mm/min, or mm/rev where ``per_rev``
    dwell        seconds, or spindle revolutions where ``dwell_turns``
    floating     the tap is in a compensating chuck (OPTION)
    """

    mode: tuple[str, ...]
    clearance: float
    retract: float
    depth: float
    pecks: tuple[float, ...]
    feed: float
    per_rev: bool
    dwell: float
    dwell_turns: bool
    floating: bool


@dataclass(frozen=True, slots=True, eq=False)
class Hole:
    """One hole.

    tip, axis       its CL point and tool axis
    row             CL row, counted without holes, before which it is drilled
    line, file      of its CL point
    spindle         None before the first SPINDL
    tip_tolerance   of each coordinate, mm
    feed_tolerance  of the feed, for its rounding, mm/min
    tool_names      what a program may call the tool; empty: any
    length_numbers  numbers that its length may have where programs call lengths by number; empty: any
    """

    tip: Floats
    axis: Floats
    row: int
    line: int
    file: str
    cycle: HoleCycle
    spindle: ExpectedSpindle | None
    tip_tolerance: float
    feed_tolerance: float
    tool_names: tuple[str, ...]
    length_numbers: tuple[int, ...]

    @property
    def tolerance(self) -> float:
        """How far positions and heights may be off, mm: points are rounded in each of three coordinates."""
        return 3.0 * self.tip_tolerance + 2e-6

    @property
    def exit_tip(self) -> Floats:
        """Tip at which the tool leaves the hole, (3,)."""
        return np.asarray(self.tip + self.cycle.retract * self.axis)

    def heights_and_offsets(self, tip: Floats) -> tuple[Floats, Floats]:
        """Heights of tips (k, 3) above the hole, and their distances from its axis, mm, (k,) each."""
        offset = tip - self.tip
        height = offset @ self.axis
        return height, np.linalg.norm(offset - height[:, None] * self.axis, axis=1)


def without_holes(operation: Operation) -> tuple[Operation, Flags]:
    """Return the operation without the rows that are holes, and which rows these are, (n,) bool."""
    moves = operation.moves
    holes = np.zeros(len(moves), bool)
    switches = [event for event in operation.events if isinstance(event, CycleOn | CycleOff)]
    for event, following in pairwise([*switches, None]):
        if isinstance(event, CycleOn):
            holes[event.row : following.row if following else None] = True
    holes &= moves.kind != Kind.RAPID
    return without_rows(operation, holes), holes


def without_rows(operation: Operation, gone: Flags) -> Operation:
    """Return the operation without some rows (n,); arcs that end there go too, and splines that have no other row."""
    if not gone.any():
        return operation
    moves, kept = operation.moves, ~gone
    new_row = np.concatenate(([0], np.cumsum(kept)))
    arcs = operation.arcs
    stay = kept[arcs.row] if len(arcs.row) else np.zeros(0, bool)
    left = Arcs(new_row[arcs.row[stay]], arcs.centre[stay], arcs.normal[stay], arcs.radius[stay], arcs.full_turns[stay])
    events = tuple(replace(event, row=int(new_row[event.row])) for event in operation.events)
    splines = operation.splines
    first, last = new_row[splines.first], new_row[splines.last + 1] - 1
    splines = splines.at_rows(first, last).select(last >= first)
    return replace(operation, moves=moves.select(kept), arcs=left, splines=splines, events=events)


class HoleSource(NamedTuple):
    """Where the holes of an operation are from, and what drills them.

    file        the CL file
    first       the CL row, counted without holes, of its first row that is none
    tolerances  of the operation
    tool        that drills all of them
    spindle     when the operation begins
    """

    file: str
    first: int
    tolerances: Tolerances
    tool: ExpectedTool
    spindle: ExpectedSpindle | None


def holes_of_operation(operation: Operation, hole_rows: Flags, source: HoleSource) -> list[Hole]:
    """Return the holes of an operation as the CL file has it.

    hole_rows  (n,) bool: which rows of the operation are holes
    """
    file, first, tolerances, tool, spindle = source
    rows = np.flatnonzero(hole_rows)
    cl_rows = first + rows - np.arange(len(rows))
    cycles = [event for event in operation.events if isinstance(event, CycleOn)]
    cycle_rows = [cycle.row for cycle in cycles]
    found: list[Hole] = []
    spindles = ExpectedSpindles(operation, spindle)
    cycle_first = -1
    for row, cl_row in zip(rows.tolist(), cl_rows.tolist(), strict=True):
        cycle = cycles[bisect_right(cycle_rows, row) - 1]
        cycle_first = cycle_first if cycle_first >= cycle.row and hole_rows[row - 1] else row
        found.append(
            Hole(
                tip=operation.moves.tip[row],
                axis=operation.moves.axis[row],
                row=cl_row,
                line=int(operation.moves.line[row]),
                file=file,
                cycle=_hole_cycle(operation, cycle, cycle_first, row),
                spindle=spindles.at(row),
                tip_tolerance=tolerances.tip,
                feed_tolerance=tolerances.feed,
                tool_names=tool.names if tool.is_known else (),
                length_numbers=tool.lengths,
            )
        )
    return found


def _hole_cycle(operation: Operation, cycle: CycleOn, cycle_first: int, row: int) -> HoleCycle:
    """How the hole at a row is drilled; the first hole of its cycle, after another point, is row ``cycle_first``."""
    moves, values, words = operation.moves, dict(cycle.values), dict(cycle.words)
    clearance = _value(cycle, "RAPTO", _value(cycle, "CLEAR", math.nan))
    if words.get("RTRCTO") == "AUTO":  # back to the height of the point before the holes
        down = moves.tip[cycle_first - 1] - moves.tip[cycle_first]
        retract = float(moves.axis[cycle_first] @ down) if cycle_first else math.nan
    else:
        retract = _value(cycle, "RTRCTO", clearance)
    depth = abs(_value(cycle, "FEDTO", 0.0))
    if "CSINK" in cycle.mode and values.get("CSKDIA"):
        angle = math.radians(_value(cycle, "TLANGL", math.nan))
        depth = values["CSKDIA"][0] / (2.0 * math.tan(0.5 * angle))
    return HoleCycle(
        mode=cycle.mode,
        clearance=clearance,
        retract=max(retract, clearance),
        depth=depth,
        pecks=tuple(values.get("STEP", ())) if {"DEEP", "BRKCHP"} & set(cycle.mode) else (),
        feed=_value(cycle, "MMPR", _value(cycle, "MMPM", float(moves.feed[row]))),
        per_rev=bool(values.get("MMPR")) or ("MMPM" not in values and bool(moves.per_rev[row])),
        dwell=_value(cycle, "DWELL", 0.0),
        dwell_turns=words.get("DWELL") == "REV",
        floating="OPTION" in words,
    )


def _value(cycle: CycleOn, word: str, default: float) -> float:
    """Return the first number of a couplet."""
    values = dict(cycle.values).get(word)
    return values[0] if values else default
