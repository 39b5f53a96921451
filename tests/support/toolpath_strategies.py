"""Hypothesis strategies for toolpaths with every kind of event."""

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from hypothesis import strategies as st

from trunnion.arrays import Codes, Floats
from trunnion.cl.phases import COLOUR_PHASES, fill_phases
from trunnion.errors import RefusedError
from trunnion.model.toolpath import (
    Arcs,
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    Frame,
    From,
    GoHome,
    Insert,
    Kind,
    LoadTool,
    Message,
    Moves,
    Operation,
    SelectTool,
    Sense,
    SetMode,
    SpindleOff,
    SpindleOn,
    Stop,
    Tool,
    Toolpath,
    UnknownStatement,
)

TEXT = st.text(
    st.characters(min_codepoint=33, max_codepoint=0x9FFF, categories=("L", "N", "P")), min_size=1, max_size=12
)
NAME = st.text("ABCabc019_-.刀", min_size=1, max_size=8)
LENGTH = st.one_of(st.integers(-(10**9), 10**9).map(lambda n: n / 1e6), st.floats(-1e4, 1e4))
UNIT = st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)).filter(lambda v: np.linalg.norm(v) > 0.1)
DECIMAL = st.integers(1, 99999).map(lambda n: n / 1000)

Where = tuple[int, int]


def _unit(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    i, j, k = (np.array(vector) / np.linalg.norm(vector)).tolist()
    return i, j, k


#: Events that survive in a program of ours: conversion finds them again.
SAYABLE: dict[str, st.SearchStrategy[Any]] = {
    "spindle": st.builds(
        lambda rpm, sense: SpindleOn(0, 0, float(rpm), sense), st.integers(1, 99999), st.sampled_from(Sense)
    ),
    "coolant": st.sampled_from(["ON", "MIST", "THRU", "OFF"]).map(lambda kind: Coolant(0, 0, kind)),
    "dwell": st.builds(lambda amount, each: Dwell(0, 0, amount, each), DECIMAL, st.booleans()),
    "stop": st.builds(lambda optional: Stop(0, 0, optional), st.booleans()),
    "message": st.builds(lambda text, display: Message(0, 0, text, display), TEXT, st.booleans()),
    "skip": st.booleans().map(lambda on: BlockSkip(0, 0, on)),
    "comp": st.sampled_from(["LEFT", "RIGHT", "OFF"]).map(lambda side: CutterComp(0, 0, side)),
}

#: Events that only a CL file holds.
OTHERS: dict[str, st.SearchStrategy[Any]] = {
    "spindle off": st.just(SpindleOff(0, 0)),
    "select": st.integers(0, 999).map(lambda n: SelectTool(0, 0, n)),
    "load": st.builds(lambda n, h: LoadTool(0, 0, n, h), st.integers(0, 999), st.integers(0, 99)),
    "text stop": TEXT.map(lambda text: Stop(0, 0, True, text)),
    "insert": TEXT.map(lambda text: Insert(0, 0, f"  {text}")),
    "comp plane": st.integers(0, 99).map(lambda n: CutterComp(0, 0, "ON", "ZXPLAN", n)),
    "cycle": st.builds(
        lambda depth, feed, dwell: CycleOn(
            0,
            0,
            ("DRILL", "DEEP"),
            (("STEP", (9.5, 1.5)), ("FEDTO", (depth,)), ("MMPM", (feed,)), ("DWELL", (dwell,))),
            (("RTRCTO", "AUTO"), ("DWELL", "REV")),
        ),
        LENGTH,
        DECIMAL,
        DECIMAL,
    ),
    "tapping": DECIMAL.map(lambda f: CycleOn(0, 0, ("TAP",), (("MMPR", (f,)), ("RAPTO", (3.0,))), (("OPTION", ""),))),
    "cycle off": st.just(CycleOff(0, 0)),
    "home": st.just(GoHome(0, 0)),
    "mode": st.just(SetMode(0, 0, ("SET", "MODE", "ABSOL"))),
    "unknown": st.just(UnknownStatement(0, 0, "AUXFUN/27")),
    "from": st.builds(lambda tip, axis: From(0, 0, tip, _unit(axis)), st.tuples(LENGTH, LENGTH, LENGTH), UNIT),
}


@st.composite
def events(draw: st.DrawFn, rows: int, kinds: dict[str, st.SearchStrategy[Any]]) -> tuple[Event, ...]:
    """A few events in the order of their rows."""
    found = draw(st.lists(st.tuples(st.integers(0, rows), st.one_of(*kinds.values())), max_size=8))
    # a FROM anywhere but at the beginning would separate arcs from their start
    placed = [(0 if isinstance(event, From) else row, event) for row, event in found]
    # an operation begins with one tool, from one point
    first = {type(event): event for row, event in placed if row == 0 and isinstance(event, From | LoadTool)}
    kept = [(row, event) for row, event in placed if row or event is first.get(type(event), event)]
    ordered = tuple(replace(event, row=row) for row, event in sorted(kept, key=lambda pair: pair[0]))
    return tuple(event for at, event in enumerate(ordered) if not _is_load_in_cycle(event, ordered[:at]))


def _is_load_in_cycle(event: Event, before: tuple[Event, ...]) -> bool:
    """Whether a tool is loaded while a cycle is on: readers of CL files refuse the holes behind it."""
    cycles = [each for each in before if isinstance(each, CycleOn | CycleOff)]
    return isinstance(event, LoadTool) and bool(cycles) and isinstance(cycles[-1], CycleOn)


@st.composite
def phases(draw: st.DrawFn, rows: int, rapids: list[int]) -> Codes:
    """Phases as colours give them, from random colours."""
    colours = draw(st.lists(st.tuples(st.integers(0, rows - 1), st.sampled_from(list(COLOUR_PHASES))), max_size=6))
    phase = np.empty(rows, np.uint8)
    fill_phases(phase, np.array(rapids, np.int64), sorted(colours, key=lambda pair: pair[0]))
    return phase


@st.composite
def feeds(draw: st.DrawFn, rows: int, first: int) -> tuple[Floats, np.ndarray[Any, Any]]:
    """A modal feed from row ``first`` on, with a few changes."""
    feed, per_rev = np.full(rows, np.nan), np.zeros(rows, bool)
    for row in sorted({first, *draw(st.lists(st.integers(first, max(rows - 1, first)), max_size=3))}):
        feed[row:], per_rev[row:] = draw(st.integers(1, 10**6)) / 100, draw(st.booleans())
    return feed, per_rev


@st.composite
def operations(draw: st.DrawFn, kinds: dict[str, st.SearchStrategy[Any]], axes: st.SearchStrategy[Any]) -> Operation:
    """One operation; a third of the points are rapid, and some are arcs in the plane XY."""
    rows = draw(st.integers(1, 20))
    tip = np.array(draw(st.lists(st.tuples(LENGTH, LENGTH, LENGTH), min_size=rows, max_size=rows)))
    runs = [_unit(vector) for vector in draw(st.lists(axes, min_size=1, max_size=4))]
    axis = np.array([runs[min(row * len(runs) // rows, len(runs) - 1)] for row in range(rows)])
    kind = np.array(draw(st.lists(st.sampled_from([0, 1, 1]), min_size=rows, max_size=rows)), np.uint8)
    arcs = draw(st.lists(st.integers(1, rows - 1), unique=True, max_size=3)) if rows > 1 else []
    centre, normal, radius, turns = [], [], [], []
    for row in sorted(arcs):
        start, reach = tip[row - 1], draw(st.integers(1, 50000)) / 1000
        centre.append(start + np.array([reach, 0.0, 0.0]))
        side, rise = draw(st.sampled_from([-1, 1])), draw(st.sampled_from([0.0, 0.0, 2.5]))
        tip[row] = start + np.array([reach, reach * side, rise])
        axis[row] = axis[row - 1]
        kind[row] = Kind.ARC
        normal.append((0.0, 0.0, draw(st.sampled_from([-1.0, 1.0]))))
        radius.append(reach)
        turns.append(draw(st.integers(0, 3)))
    rapids = np.flatnonzero(kind == Kind.RAPID).tolist()
    cutting = np.flatnonzero(kind != Kind.RAPID)
    feed, per_rev = draw(feeds(rows, int(cutting[0]) if len(cutting) else rows))
    diameter = draw(DECIMAL)
    return Operation(
        name=draw(TEXT.filter(lambda text: ",TOOL," not in text)),
        tool=Tool(
            "MILL", draw(NAME), diameter, draw(st.sampled_from([diameter / 2, min(0.5, diameter / 2)])), draw(DECIMAL)
        ),
        frame=Frame(),
        moves=Moves(tip, axis, kind, draw(phases(rows, rapids)), feed, per_rev, np.arange(1, rows + 1, dtype=np.int32)),
        arcs=Arcs(
            np.array(sorted(arcs), np.int64), np.array(centre), np.array(normal), np.array(radius), np.array(turns)
        )
        if arcs
        else Arcs.empty(),
        events=draw(events(rows, kinds)),
        line=1,
        intol=draw(st.sampled_from([None, 0.03, 0.0125])),
        outtol=draw(st.sampled_from([None, 0.03, 0.001])),
    )


def _is_sensible(operation: Operation) -> bool:
    """Whether everything in an operation has a point of its own in the program, and nothing occurs twice there.

    Points differ as printed from those before them, no two events of a kind share a row, cutter radius compensation
    changes on a motion, and to another side (where it is off, one more "off" prints a word after skipped blocks only,
    which no reader can tell from nothing), and coolant is switched off where nothing else happens: if it is off
    already, the program has no word for it, but an event before it at the same place gets a block of its own.
    """
    moved = (np.abs(np.diff(np.round(operation.moves.tip, 3), axis=0)) > 0.0015).any(axis=1)
    places = [(event.row, type(event)) for event in operation.events]
    compensations = [event for event in operation.events if isinstance(event, CutterComp)]
    moving = all(event.row < len(operation.moves) for event in compensations)
    sides = ["OFF", *(event.side for event in compensations)]
    changing = all(before != after for before, after in pairwise(sides))
    rows = [event.row for event in operation.events]
    alone = all(rows.count(e.row) == 1 for e in operation.events if isinstance(e, Coolant) and e.kind == "OFF")
    return bool(moved.all()) and len(set(places)) == len(places) and moving and changing and alone


def sensible(paths: st.SearchStrategy[Toolpath]) -> st.SearchStrategy[Toolpath]:
    """The paths of sensible operations in which block skip goes on and off in turn."""
    return paths.filter(lambda path: all(map(_is_sensible, path.operations)) and _skips_alternate(path))


def _skips_alternate(path: Toolpath) -> bool:
    each = ([e.on for e in operation.events if isinstance(e, BlockSkip)] for operation in path.operations)
    return all(on is (k % 2 == 0) for skips in each for k, on in enumerate(skips))


def toolpaths(
    kinds: dict[str, st.SearchStrategy[Any]], axes: st.SearchStrategy[Any] = UNIT
) -> st.SearchStrategy[Toolpath]:
    """One or two operations."""
    return st.lists(operations(kinds, axes), min_size=1, max_size=2).map(
        lambda found: Toolpath("made.cls", tuple(found), "part.prt")
    )


def skips_are_unsafe(refused: RefusedError) -> bool:
    """Whether the toolpath is refused only because no safe way leads past blocks that may be skipped."""
    return {problem.code for problem in refused.problems} == {"CTL460"}
