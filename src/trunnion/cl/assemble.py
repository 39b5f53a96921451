"""Operations made of what their statements said, once the length unit is known.

In:     an ``OperationBuilder``, the columns of the file with tip and axis written, and the length unit in mm.
Out:    an ``Operation``; its moves are slices of the columns, not copies.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Flags, Floats, Lines
from trunnion.cl.arcs import arcs_of, complete_circles, report_open_ends
from trunnion.cl.builder import FeedChange, MoveColumns, OperationBuilder, SurfaceSpeed
from trunnion.cl.diagnostics import MAX_LISTED, Diagnostics
from trunnion.cl.phases import COLOUR_PHASES, fill_phases
from trunnion.cl.tool_axes import fill_tool_axes
from trunnion.cl.tool_planes import turned
from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.model.arcs import arc_lengths
from trunnion.model.splines import Splines
from trunnion.model.tool_faults import tool_faults
from trunnion.model.toolpath import (
    Arcs,
    CutterComp,
    CycleOff,
    CycleOn,
    Event,
    Frame,
    From,
    Kind,
    Moves,
    Operation,
    SpindleOn,
    Tool,
)

#: No machine reaches farther, mm: a coordinate beyond it is a mistake in the file.
_MAX_COORDINATE = 1e6

#: Couplets of CYCLE whose numbers are lengths.
CYCLE_LENGTHS = frozenset({"RAPTO", "FEDTO", "RTRCTO", "CLEAR", "STEP", "CSKDIA", "HOLDIA"})

#: The couplet of CYCLE with a feed in units of the file per minute, of which no statement says what they are.
FILE_FEED = "FEED IN UNITS OF THE FILE"


def assemble_operation(
    builder: OperationBuilder, columns: MoveColumns, unit: float, modal_axis: Floats, diagnostics: Diagnostics
) -> Operation:
    """Return the operation, in mm.

    builder      what its statements said
    columns      columns of the file; rows ``builder.first:builder.stop`` belong to the operation, tip in mm
    unit         length unit of the file, mm
    modal_axis   (3,) float64: the last tool axis of the operation before; on return that of this one
    diagnostics  takes the errors and remarks
    """
    rows = slice(builder.first, builder.stop)
    n = builder.stop - builder.first
    tip, feed, per_rev, kind = columns.tip[rows], columns.feed[rows], columns.per_rev[rows], columns.kind[rows]
    _fill_feeds(feed, per_rev, builder.feeds, unit)
    rapids = np.array([row for row in builder.rapids if row < n], np.int64)
    kind[:] = Kind.LINEAR
    kind[rapids] = Kind.RAPID
    fill_phases(columns.phase[rows], rapids, builder.colours)
    _report_unknown_colours(builder, diagnostics)
    _report_lost_contour(builder, diagnostics)
    _report_far_points(tip, columns.line[rows], builder, unit, diagnostics)
    starts = fill_tool_axes(columns, builder, unit, modal_axis, diagnostics)
    circles = complete_circles(builder.circles, kind, diagnostics)
    kind[[circle.row for circle in circles]] = Kind.ARC
    arcs = arcs_of(circles, starts, tip, unit, diagnostics)
    report_open_ends(arcs, circles, tip, kind, diagnostics)
    moves = Moves(tip, columns.axis[rows], kind, columns.phase[rows], feed, per_rev, columns.line[rows])
    moves = _with_feeds_per_minute(builder, moves, arcs, starts, diagnostics)
    tool = _tool_in_mm(builder.tool, unit)
    _report_tool(builder, tool, diagnostics)
    events = [*(_event_in_mm(event, unit, tool, diagnostics) for event in builder.events), *starts]
    operation = Operation(
        name=builder.name,
        tool=tool,
        frame=_frame_in_mm(builder.frame, unit),
        moves=moves,
        arcs=arcs,
        events=tuple(sorted(events, key=lambda event: event.line)),
        line=builder.line,
        intol=None if builder.intol is None else builder.intol * unit,
        outtol=None if builder.outtol is None else builder.outtol * unit,
        file=diagnostics.file,
        splines=Splines.of(builder.curves),
        joined=tuple(builder.joined),
        work_offset=builder.work_offset,
    )
    return turned(operation, builder.planes)


def _fill_feeds(feed: Floats, per_rev: Flags, feeds: Sequence[FeedChange], unit: float) -> None:
    """Write the modal feed into each row.

    feed     (n,) float64   mm/min or mm/rev
    per_rev  (n,) bool
    """
    begin, value, is_per_rev = 0, math.nan, False
    for change in feeds:
        feed[begin : change.row] = value
        per_rev[begin : change.row] = is_per_rev
        begin, is_per_rev = change.row, change.per_rev
        value = change.value * unit if change.in_file_units else change.value
    feed[begin:] = value
    per_rev[begin:] = is_per_rev


def _with_feeds_per_minute(
    builder: OperationBuilder, moves: Moves, arcs: Arcs, starts: Sequence[From], diagnostics: Diagnostics
) -> Moves:
    """Return moves with feeds that are one over the minutes of a move in mm/min, by the length of each move.

    Feeds of holes become NaN, since a cycle has moves of its own.
    """
    if not any(change.inverse for change in builder.feeds):
        return moves
    feed, tip, n = moves.feed.copy(), moves.tip, len(moves)
    ends = [change.row for change in builder.feeds[1:]] + [n]
    inverse = np.zeros(n, np.bool_)
    for change, end in zip(builder.feeds, ends, strict=True):
        inverse[change.row : end] = change.inverse
    before = np.concatenate((np.full((1, 3), np.nan), tip[:-1]))
    for start in starts:
        before[start.row : start.row + 1] = start.tip
    length = np.linalg.norm(tip - before, axis=1)
    if len(arcs.row):
        length[arcs.row] = arc_lengths(arcs, before[arcs.row], tip[arcs.row])
    in_hole = np.zeros(n, np.bool_)
    for event in sorted((e for e in builder.events if isinstance(e, CycleOn | CycleOff)), key=lambda e: e.line):
        in_hole[event.row :] = isinstance(event, CycleOn)
    feed[inverse] *= length[inverse]
    feed[inverse & in_hole] = np.nan
    cuts = inverse & ~in_hole & (moves.kind != Kind.RAPID)
    for row in np.flatnonzero(cuts & ~(length > 0.0))[: MAX_LISTED + 1].tolist():
        diagnostics.error(int(moves.line[row]), Wording("CL710", "fedrat_invers_move"))
    return replace(moves, feed=feed)


def _report_lost_contour(builder: OperationBuilder, diagnostics: Diagnostics) -> None:
    """Report points of a contour that the tool's centre would go along: no CUTCOM makes the control add the radius."""
    said = builder.points
    if said is None or not said.contour or any(isinstance(event, CutterComp) for event in builder.events):
        return
    if said.refuses:
        diagnostics.error(said.line, said.lost)
    else:
        diagnostics.remark(said.line, said.lost)


def _report_unknown_colours(builder: OperationBuilder, diagnostics: Diagnostics) -> None:
    unknown = dict.fromkeys(colour for _, colour in builder.colours if colour not in COLOUR_PHASES)
    for colour in unknown:
        diagnostics.remark(builder.line, Wording("CL810", "operation_uses_colour", builder=builder.name, colour=colour))


def _report_far_points(
    tip: Floats, line: Lines, builder: OperationBuilder, unit: float, diagnostics: Diagnostics
) -> None:
    """Refuse coordinates beyond the reach of any machine: ``tip`` (n, 3) in mm, and the origin of the frame."""
    if len(tip) and max(float(tip.max()), -float(tip.min())) > _MAX_COORDINATE:
        for row in np.flatnonzero((np.abs(tip) > _MAX_COORDINATE).any(axis=1))[: MAX_LISTED + 1].tolist():
            diagnostics.error(
                int(line[row]),
                Wording("CL360", "coordinate_mm", max=np.abs(tip[row]).max(), max_coordinate=_MAX_COORDINATE),
            )
    farthest = max(map(abs, builder.frame.origin)) * unit
    if farthest > _MAX_COORDINATE:
        diagnostics.error(
            builder.line, Wording("CL360", "msys_origin_mm", farthest=farthest, max_coordinate=_MAX_COORDINATE)
        )


def _event_in_mm(event: Event, unit: float, tool: Tool, diagnostics: Diagnostics) -> Event:
    """Return ``event`` with lengths in mm and surface speeds in rev/min."""
    if isinstance(event, CycleOn):
        values = [
            (
                "MMPM" if word == FILE_FEED else word,
                tuple(number * unit for number in given) if word in CYCLE_LENGTHS or word == FILE_FEED else given,
            )
            for word, given in event.values
        ]
        return replace(event, values=tuple(values))
    if isinstance(event, SurfaceSpeed):
        diameter = tool.diameter if event.diameter is None else event.diameter * unit
        if diameter <= 0:
            diagnostics.error(event.line, Wording("CL730", "spindle_speed_surface"))
            return event
        rpm, surface = event.speed / (math.pi * diameter), (event.speed / 1000.0, diameter)
        said = Wording("CL735", "surface_speed_converted", speed=surface[0], diameter=diameter, rpm=rpm)
        diagnostics.remark(event.line, said)
        return SpindleOn(event.row, event.line, rpm, event.sense, surface=surface)
    return event


def _tool_in_mm(tool: Tool, unit: float) -> Tool:
    return replace(
        tool,
        diameter=tool.diameter * unit,
        corner_radius=tool.corner_radius * unit,
        length=tool.length * unit,
        flute_length=tool.flute_length * unit,
        upper_radius=tool.upper_radius * unit,
        extension=tool.extension * unit,
        set_length=tool.set_length * unit,
        corner_centre=_in_mm(tool.corner_centre, unit),
        upper_centre=_in_mm(tool.upper_centre, unit),
    )


def _in_mm(centre: tuple[float, float] | None, unit: float) -> tuple[float, float] | None:
    return None if centre is None else (centre[0] * unit, centre[1] * unit)


def _report_tool(builder: OperationBuilder, tool: Tool, diagnostics: Diagnostics) -> None:
    """Report impossible sizes of a tool, with the line that states them."""
    line, _ = builder.stated.get("tool", (builder.line, None))
    for fault in tool_faults(tool):
        report = diagnostics.error if fault.severity is Severity.ERROR else diagnostics.remark
        report(line, fault.wording)


def _frame_in_mm(frame: Frame, unit: float) -> Frame:
    x, y, z = frame.origin
    return replace(frame, origin=(x * unit, y * unit, z * unit))
