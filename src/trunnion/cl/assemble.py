"""From drafts to operations: units, feeds, phases, axes and arcs, a run of rows at a time.

In:     a ``OperationBuilder``, the columns of the file with tip and axis written, and the length unit in mm.
Out:    an ``Operation``; its moves are slices of the columns, not copies.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.cl.builder import CircleStatement, FeedChange, FromStatement, MoveColumns, OperationBuilder, SurfaceSpeed
from trunnion.cl.diagnostics import MAX_LISTED, Diagnostics
from trunnion.cl.scan import fill_modal_axes
from trunnion.model.toolpath import Arcs, CycleOn, Event, Frame, From, Kind, Moves, Operation, Phase, SpindleOn, Tool

#: Start and end of an arc may be so far off its radius, mm: coordinates are printed with three or four decimals.
RADIUS_TOLERANCE = 0.02

#: The colours in which NX paints the parts of a path. 211 is decided by what stands around it.
COLOUR_PHASES = {
    186: Phase.RAPID,
    42: Phase.ENGAGE,
    31: Phase.CUT,
    36: Phase.STEPOVER,
    37: Phase.RETRACT,
    211: Phase.APPROACH,
}
_TRAVERSE_COLOUR = 211
_RAPID_COLOUR = 186

#: Couplets of CYCLE whose numbers are lengths.
CYCLE_LENGTHS = frozenset({"RAPTO", "FEDTO", "RTRCTO", "CLEAR", "STEP", "CSKDIA", "HOLDIA"})


def assemble_operation(
    builder: OperationBuilder, columns: MoveColumns, unit: float, diagnostics: Diagnostics
) -> Operation:
    """Return the operation that ``builder`` describes.

    Parameters
    ----------
    draft
        What was read of the operation.
    columns
        Columns of the file; rows ``builder.first:builder.stop`` belong to the operation, tip in mm.
    unit
        Length unit of the file, mm.
    findings
        Takes what turns out wrong.
    """
    here = slice(builder.first, builder.stop)
    n = builder.stop - builder.first
    tip, feed, per_rev, kind = columns.tip[here], columns.feed[here], columns.per_rev[here], columns.kind[here]
    fill_feeds(feed, per_rev, builder.feeds, unit)
    rapids = np.array([row for row in builder.rapids if row < n], np.int64)
    kind[:] = Kind.LINEAR
    kind[rapids] = Kind.RAPID
    fill_phases(columns.phase[here], rapids, builder.colours)
    _report_unknown_colours(builder, diagnostics)
    starts = _fill_tool_axes(columns, builder, unit, diagnostics)
    circles = _complete_circles(builder, kind, n, diagnostics)
    kind[[circle.row for circle in circles]] = Kind.ARC
    arcs = _build_arcs(circles, starts, tip, unit, diagnostics)
    tool = _tool_in_mm(builder.tool, unit)
    events: list[Event] = [_event_in_mm(event, unit, tool, diagnostics) for event in builder.events]
    events.extend(starts)
    events.sort(key=lambda event: event.line)
    return Operation(
        name=builder.name,
        tool=tool,
        frame=_frame_in_mm(builder.frame, unit),
        moves=Moves(tip, columns.axis[here], kind, columns.phase[here], feed, per_rev, columns.line[here]),
        arcs=arcs,
        events=tuple(events),
        line=builder.line,
        intol=None if builder.intol is None else builder.intol * unit,
        outtol=None if builder.outtol is None else builder.outtol * unit,
    )


def fill_feeds(feed: Floats, per_rev: Flags, feeds: Sequence[FeedChange], unit: float) -> None:
    """Write the modal feed into each row.

    feed     (n,) float64   mm/min or mm/rev
    per_rev  (n,) bool
    """
    begin, value, each = 0, math.nan, False
    for change in feeds:
        feed[begin : change.row] = value
        per_rev[begin : change.row] = each
        begin, each = change.row, change.per_rev
        value = change.value * unit if change.in_file_units else change.value
    feed[begin:] = value
    per_rev[begin:] = each


def fill_phases(phase: Codes, rapids: Ints, colours: Sequence[tuple[int, int]]) -> None:
    """Write the phase of each row from the colours in which the CAM system painted the path.

    The colour 211 says only that the tool travels slowly above the part. The first stretch of it after cutting
    leaves the part, the last before something else comes up to it, and those in between cross over.

    phase    (n,) uint8
    rapids   rows of rapid moves
    colours  (row, colour) of each PAINT/COLOR; one with the same number begins a stretch too
    """
    n = len(phase)
    phase[:] = Phase.CUT
    phase[rapids] = Phase.RAPID
    stretches = _colour_stretches(colours, n)
    if not stretches:
        return
    phase[: stretches[0][0]] = Phase.INITIAL
    before: Phase | None = None
    repeat = 0
    for index, (begin, stop, colour) in enumerate(stretches):
        following = stretches[index + 1][2] if index + 1 < len(stretches) else None
        repeat = repeat + 1 if colour == _TRAVERSE_COLOUR else 0
        if colour == _TRAVERSE_COLOUR:
            now = _traverse_phase(before, repeat, following)
        elif colour == _RAPID_COLOUR and begin == 0:
            now = Phase.INITIAL
        else:
            now = COLOUR_PHASES[colour]
        phase[begin:stop] = now
        before = now


def _colour_stretches(colours: Sequence[tuple[int, int]], n: int) -> list[tuple[int, int, int]]:
    """Begin, stop and colour of each stretch that has rows and a known colour; others join the one before."""
    stretches: list[tuple[int, int, int]] = []
    known = [(row, colour) for row, colour in colours if colour in COLOUR_PHASES]
    for index, (row, colour) in enumerate(known):
        stop = known[index + 1][0] if index + 1 < len(known) else n
        if row < stop:
            stretches.append((row, stop, colour))
    return stretches


def _traverse_phase(before: Phase | None, repeat: int, following: int | None) -> Phase:
    """Phase of the ``repeat``-th 211 stretch in a row, after a stretch of phase ``before``."""
    if repeat == 1 and before not in (None, Phase.INITIAL, Phase.RAPID):
        return Phase.DEPARTURE
    return Phase.TRAVERSE if following == _TRAVERSE_COLOUR else Phase.APPROACH


def _report_unknown_colours(builder: OperationBuilder, diagnostics: Diagnostics) -> None:
    seen: set[int] = set()
    for _, colour in builder.colours:
        if colour not in COLOUR_PHASES and colour not in seen:
            seen.add(colour)
            diagnostics.remark(
                builder.line,
                f"operation {builder.name} uses colour {colour}, which names no phase; the one before it goes on",
                "use the standard path colours of the CAM system",
            )


def _fill_tool_axes(
    columns: MoveColumns, builder: OperationBuilder, unit: float, diagnostics: Diagnostics
) -> list[From]:
    """Make the modal tool axis explicit in every row; return the FROM events with theirs."""
    modal_axis = np.array([0.0, 0.0, 1.0])
    bad = np.empty(MAX_LISTED + 1, np.int64)
    at = builder.first
    events = []
    for start in [*builder.starts, None]:
        stop = builder.first + start.row if start else builder.stop
        bad_count = fill_modal_axes(columns.axis, at, stop, modal_axis, bad)
        for row in bad[: min(bad_count, len(bad))].tolist():
            _bad_axis(columns.axis[row], int(columns.line[row]), diagnostics)
        at = stop
        if start:
            events.append(_from_event(start, modal_axis, unit, diagnostics))
    return events


def _from_event(start: FromStatement, modal_axis: Floats, unit: float, diagnostics: Diagnostics) -> From:
    """Return the event of a FROM; an axis that it names is in force from here on."""
    if start.axis:
        one = np.array([start.axis])
        if fill_modal_axes(one, 0, 1, modal_axis, np.empty(1, np.int64)):
            _bad_axis(one[0], start.line, diagnostics)
    x, y, z = start.tip
    i, j, k = modal_axis.tolist()
    return From(start.row, start.line, (x * unit, y * unit, z * unit), (i, j, k))


def _bad_axis(vector: Floats, line: int, diagnostics: Diagnostics) -> None:
    length = float(np.sqrt(np.sum(vector * vector)))
    what = "the tool-axis vector is zero" if length == 0 else f"the tool-axis vector has the length {length:.6g}, not 1"
    diagnostics.error(line, what, "write i, j, k as a unit vector from the tip to the holder")


def _complete_circles(
    builder: OperationBuilder, kind: Codes, n: int, diagnostics: Diagnostics
) -> list[CircleStatement]:
    """Return the circles that have an end point."""
    circles = builder.circles
    if circles and circles[-1].row >= n:
        diagnostics.error(
            circles[-1].line, "CIRCLE without a GOTO after it", "write GOTO/ with the end point of the arc"
        )
        circles = circles[:-1]
    rapid = kind[[circle.row for circle in circles]] == Kind.RAPID
    for index in np.flatnonzero(rapid).tolist():
        line = circles[index].line
        diagnostics.remark(line, "RAPID before an arc; the arc is made at the feed rate", "take the RAPID away")
    return circles


def _build_arcs(
    circles: Sequence[CircleStatement], starts: Iterable[From], tip: Floats, unit: float, diagnostics: Diagnostics
) -> Arcs:
    """Return the arcs of an operation, checked against their start and end points.

    tip  (n, 3) float64   mm
    """
    from_tips = {start.row: start.tip for start in starts}
    usable = [circle for circle in circles if circle.row > 0 or circle.row in from_tips]
    for circle in circles:
        if circle.row == 0 and 0 not in from_tips:
            diagnostics.error(circle.line, "CIRCLE has no start point", "write FROM/ or GOTO/ before the first arc")
    if not usable:
        return Arcs.empty()
    row = np.array([circle.row for circle in usable], np.int64)
    numbers = np.array([circle.numbers for circle in usable])
    # TIMES,n counts the turns that the helix begins, the arc from start to end being the last of them: TIMES,2
    # is one whole turn and that arc. A full circle, start = end, is one turn: TIMES,1, or none named.
    turns = np.array([circle.turns - 1 for circle in usable], np.int64)
    centre = numbers[:, 0:3] * unit
    normal = numbers[:, 3:6]
    radius = numbers[:, 6] * unit
    length = np.sqrt(np.sum(normal * normal, axis=1))
    end = tip[row]
    start = tip[np.maximum(row - 1, 0)]
    for index, circle in enumerate(usable):
        if circle.row in from_tips:
            start[index] = from_tips[circle.row]
    normal = normal / np.where(length > 0, length, 1.0)[:, None]
    off_start = np.abs(_distance_from_line(start - centre, normal) - radius)
    off_end = np.abs(_distance_from_line(end - centre, normal) - radius)
    for index in np.flatnonzero(np.abs(length - 1) > 0.01).tolist():
        diagnostics.error(
            usable[index].line, "the normal of CIRCLE is not a unit vector", "write i, j, k with length 1"
        )
    for index in np.flatnonzero(radius <= 0).tolist():
        diagnostics.error(usable[index].line, "the radius of CIRCLE is not positive", "write a radius above 0")
    sound = (np.abs(length - 1) <= 0.01) & (radius > 0)
    for index in np.flatnonzero(sound & (np.maximum(off_start, off_end) > RADIUS_TOLERANCE)).tolist():
        which, off = ("start", off_start[index]) if off_start[index] > RADIUS_TOLERANCE else ("end", off_end[index])
        diagnostics.error(
            usable[index].line,
            f"the {which} point of the arc lies {off:.3f} mm off its radius {radius[index]:.4f}",
            "write centre, radius and points of one and the same circle",
        )
    return Arcs(row, centre, normal, radius, turns)


def _distance_from_line(offset: Floats, normal: Floats) -> Floats:
    """(m,) float64: distance from the line through the origin along ``normal``, for (m, 3) offsets."""
    along = np.sum(offset * normal, axis=1)
    across = offset - along[:, None] * normal
    return np.asarray(np.sqrt(np.sum(across * across, axis=1)), np.float64)


def _event_in_mm(event: Event, unit: float, tool: Tool, diagnostics: Diagnostics) -> Event:
    """Return ``event`` with lengths in mm and surface speeds in rev/min."""
    if isinstance(event, CycleOn):
        values = [
            (word, tuple(number * unit for number in given) if word in CYCLE_LENGTHS else given)
            for word, given in event.values
        ]
        return replace(event, values=tuple(values))
    if isinstance(event, SurfaceSpeed):
        diameter = tool.diameter if event.diameter is None else event.diameter * unit
        if diameter <= 0:
            diagnostics.error(
                event.line,
                "the spindle speed is a surface speed, and the tool has no diameter",
                "give the diameter in TLDATA, or the speed in RPM",
            )
            return event
        return SpindleOn(event.row, event.line, event.speed / (math.pi * diameter), event.sense)
    return event


def _tool_in_mm(tool: Tool, unit: float) -> Tool:
    return replace(
        tool,
        diameter=tool.diameter * unit,
        corner_radius=tool.corner_radius * unit,
        length=tool.length * unit,
        flute_length=tool.flute_length * unit,
        upper_radius=tool.upper_radius * unit,
    )


def _frame_in_mm(frame: Frame, unit: float) -> Frame:
    x, y, z = frame.origin
    return replace(frame, origin=(x * unit, y * unit, z * unit))
