"""Paths that are written in several dialects, and what their toolpaths say in words of none of them."""

import math
from typing import Any

import numpy as np
from hypothesis import strategies as st

from tests.support.cl_dialects import Step, Vector, Z
from trunnion.model.toolpath import CutterComp, CycleOn, Event, Kind, Message, Operation, Toolpath
from trunnion.planning.holes.cycles import cycle_from_event

lengths = st.integers(-200_000, 200_000).map(lambda number: number / 1000)
points = st.tuples(lengths, lengths, lengths)
tilts = st.tuples(st.integers(0, 100), st.integers(0, 359))

COMMENTS = ["a, b / c", "$ 5", "IT'S"]


@st.composite
def axes(draw: st.DrawFn) -> Vector:
    """A tool axis as it is printed: often (0, 0, 1)."""
    if draw(st.booleans()):
        return Z
    tilt, turn = (math.radians(angle) for angle in draw(tilts))
    vector = (math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn), math.cos(tilt))
    x, y, z = (round(part, 9) + 0.0 for part in vector)
    return (x, y, z) if (x, y) != (0.0, 0.0) else Z


@st.composite
def arcs(draw: st.DrawFn, axis: Vector) -> list[Step]:
    """A line to the start of an arc, and the arc, about an axis of coordinates or a tilted one, in either sense."""
    first, second, third = np.roll(np.eye(3), draw(st.sampled_from([0, 1, 2])), axis=0)
    if draw(st.booleans()):  # of whole numbers of tenths, as 3, 4 and 5 make them
        first, third = 0.6 * first + 0.8 * third, 0.6 * third - 0.8 * first
    sense = draw(st.sampled_from([1.0, -1.0]))
    centre, radius = draw(points), draw(st.integers(1, 50))
    begin = draw(st.integers(0, 23)) * 15
    end = begin + sense * draw(st.integers(1, 11)) * 15  # less than half a turn: "ON" is the first meeting
    ends = []
    for angle in (math.radians(begin), math.radians(end)):
        x, y, z = (np.array(centre) + radius * (math.cos(angle) * first + math.sin(angle) * second)).tolist()
        ends.append((round(x, 6), round(y, 6), round(z, 6)))
    i, j, k = (sense * third + 0.0).tolist()
    turn = (i, j, k)
    return [
        Step("GOTO", point=ends[0], axis=axis),
        Step("ARC", point=ends[1], axis=axis, centre=centre, normal=turn, start=ends[0]),
    ]


@st.composite
def paths(draw: st.DrawFn) -> list[Step]:
    """Tools with rapids, feeds, lines, arcs, holes and switches."""
    steps = []
    for number in range(1, draw(st.integers(1, 3)) + 1):
        corner = draw(st.sampled_from([0.0, 0.5, 3.0]))
        steps.append(Step("TOOL", (float(number), 6.0, corner)))
        steps.append(Step("SPINDLE", (draw(st.integers(100, 9000)),), draw(st.sampled_from(["CLW", "CCLW"]))))
        steps.append(Step("RAPID", point=draw(points), axis=draw(axes())))
        steps.append(Step("FEED", (float(draw(st.integers(10, 5000))),)))
        for _ in range(draw(st.integers(1, 4))):
            axis = draw(axes())
            match draw(
                st.sampled_from(["GOTO", "ARC", "CYCLE", "RAPID", "FEED", "COOLANT", "DWELL", "CUTCOM", "COMMENT"])
            ):
                case "GOTO":
                    steps += [
                        Step("GOTO", point=point, axis=draw(axes())) for point in draw(st.lists(points, max_size=4))
                    ]
                case "ARC":
                    steps += draw(arcs(axis))
                case "CYCLE":
                    kind = draw(st.sampled_from(["DRILL", "DEEP", "BRKCHP", "TAP", "FACE", "REAM"]))
                    numbers = (float(draw(st.integers(4, 40))), 2.0, 120.0, 1.5)
                    holes = tuple(draw(st.lists(points, min_size=1, max_size=3)))
                    steps.append(Step("CYCLE", numbers, kind, axis=axis, holes=holes))
                case "RAPID":
                    steps.append(Step("RAPID", point=draw(points), axis=axis))
                case "FEED":
                    steps.append(Step("FEED", (float(draw(st.integers(10, 5000))),)))
                case "COOLANT":
                    steps.append(Step("COOLANT", text=draw(st.sampled_from(["ON", "FLOOD", "MIST", "OFF"]))))
                case "DWELL":
                    steps.append(Step("DWELL", (0.5,)))
                case "CUTCOM":
                    words = ["LEFT", "RIGHT", "OFF", "LEFT,XYPLAN,5", "RIGHT,YZPLAN", "ON"]
                    steps.append(Step("CUTCOM", text=draw(st.sampled_from(words))))
                case "COMMENT":
                    steps.append(Step("COMMENT", text=draw(st.sampled_from(COMMENTS))))
        steps.append(Step("RAPID", point=draw(points), axis=draw(axes())))
    return steps


def told(event: Event, row: int) -> object:
    """What an event says, in words that do not depend on the dialect."""
    if isinstance(event, CycleOn):
        return (row, cycle_from_event(event))
    values = {name: getattr(event, name) for name in event.__dataclass_fields__ if name not in ("row", "line")}
    return (row, type(event).__name__, tuple(values.items()))


def content(toolpath: Toolpath) -> dict[str, Any]:
    """All that a toolpath says of the motion, from its first row to its last."""
    operations = [operation for operation in toolpath.operations if len(operation.moves)]
    begins = np.cumsum([0, *(len(operation.moves) for operation in operations)]).tolist()
    pairs = list(zip(operations, begins, strict=False))
    events = [
        told(event, begin + event.row)
        for operation, begin in pairs
        for event in [*operation.events, *end_of_side(operation)]
        if not isinstance(event, Message) or event.text in COMMENTS  # some dialects have notes of their own
    ]
    kind = np.concatenate([operation.moves.kind for operation in operations])
    feed = np.concatenate([operation.moves.feed for operation in operations])
    return {
        "tip": np.concatenate([operation.moves.tip for operation in operations]),
        "axis": np.concatenate([operation.moves.axis for operation in operations]),
        "kind": kind,
        "feed": np.where(kind == Kind.RAPID, 0.0, feed),  # of a rapid it is only what was modal
        "arc rows": np.concatenate([operation.arcs.row + begin for operation, begin in pairs]),
        "arcs": np.concatenate(
            [np.column_stack((o.arcs.centre, o.arcs.normal, o.arcs.radius)) for o in operations]
        ),
        "turns": np.concatenate([operation.arcs.full_turns for operation in operations]),
        "tools": [
            (begin, operation.tool.diameter, operation.tool.corner_radius)
            for operation, begin in pairs
        ],
        "events": events,
    }  # fmt: skip


def end_of_side(operation: Operation) -> list[Event]:
    """The end of radius compensation with its operation, where the dialect does not say it."""
    sides = [event.side for event in operation.events if isinstance(event, CutterComp)]
    return [CutterComp(len(operation.moves), 0, "OFF")] if sides and sides[-1] != "OFF" else []


def changes(tools: list[tuple[int, float, float]]) -> list[tuple[int, float, float]]:
    """Tools without those that are the one before again."""
    return [tool for k, tool in enumerate(tools) if k == 0 or tools[k - 1][1:] != tool[1:]]
