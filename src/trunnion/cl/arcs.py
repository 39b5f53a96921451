"""CIRCLE statements become arcs, checked against their start and end points."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from trunnion.arrays import Codes, Flags, Floats
from trunnion.cl.builder import CircleStatement
from trunnion.cl.diagnostics import Diagnostics
from trunnion.model.arcs import ARC_POINT_TOLERANCE, swept_angles
from trunnion.model.toolpath import Arcs, From, Kind

#: How far start and end of an arc may be off its radius, mm.
RADIUS_TOLERANCE = ARC_POINT_TOLERANCE

#: How far an arc may turn by another angle than it says, radians: angles are rounded.
_OFF_ANGLE = 1e-3

#: How far the normal of a CIRCLE may be off unit length.
_NORMAL_TOLERANCE = 0.01


def complete_circles(circles: list[CircleStatement], kind: Codes, diagnostics: Diagnostics) -> list[CircleStatement]:
    """Return the circles that have an end point; ``kind`` (n,) gives the rows that are rapids."""
    if circles and circles[-1].row >= len(kind):
        cure = "write GOTO/ with the end point of the arc"
        diagnostics.error(circles[-1].line, "CIRCLE without a GOTO after it", cure, code="CL560")
        circles = circles[:-1]
    rapid = kind[[circle.row for circle in circles]] == Kind.RAPID
    for index in np.flatnonzero(rapid).tolist():
        what = "RAPID before an arc; the arc is made at the feed rate"
        diagnostics.remark(circles[index].line, what, "remove the RAPID", code="CL580")
    return circles


def arcs_of(
    circles: Sequence[CircleStatement], starts: Iterable[From], tip: Floats, unit: float, diagnostics: Diagnostics
) -> Arcs:
    """Return the arcs of an operation.

    circles      the CIRCLE statements, each with its end point
    starts       the FROM events, whose points may begin an arc
    tip          (n, 3) float64, mm
    unit         length unit of the file, mm
    diagnostics  takes arcs that do not fit their points
    """
    from_tips = {start.row: start.tip for start in starts}
    usable = [circle for circle in circles if circle.row > 0 or circle.row in from_tips]
    for circle in circles:
        if circle.row == 0 and 0 not in from_tips:
            diagnostics.error(
                circle.line, "CIRCLE has no start point", "write FROM/ or GOTO/ before the first arc", code="CL510"
            )
    if not usable:
        return Arcs.empty()
    row = np.array([circle.row for circle in usable], np.int64)
    numbers = np.array([circle.numbers for circle in usable])
    # TIMES,n counts the turns that the helix begins, the arc from start to end being the last of them: TIMES,2
    # is one whole turn and that arc. A full circle, start = end, is one turn: TIMES,1, or no TIMES.
    full_turns = np.array([circle.turns - 1 for circle in usable], np.int64)
    length = np.sqrt(np.sum(numbers[:, 3:6] * numbers[:, 3:6], axis=1))
    normal = numbers[:, 3:6] / np.where(length > 0, length, 1.0)[:, None]
    arcs = Arcs(row, numbers[:, 0:3] * unit, normal, numbers[:, 6] * unit, full_turns)
    start = tip[np.maximum(row - 1, 0)]  # a copy: rows are chosen by an array
    for index, circle in enumerate(usable):
        if circle.row in from_tips:
            start[index] = from_tips[circle.row]
    from_start = np.isnan(arcs.radius)
    if from_start.any():
        radius = np.where(from_start, distance_from_line(start - arcs.centre, normal), arcs.radius)
        arcs = replace(arcs, radius=radius)
    has_unit_normal = np.abs(length - 1) <= _NORMAL_TOLERANCE
    _check(arcs, usable, has_unit_normal, start, tip[row], diagnostics)
    _check_angles(arcs, usable, start, tip[row], diagnostics)
    return arcs


def _check(
    arcs: Arcs,
    circles: Sequence[CircleStatement],
    has_unit_normal: Flags,
    start: Floats,
    end: Floats,
    diagnostics: Diagnostics,
) -> None:
    """Report normals that are no unit vectors, radii that are not positive, and points off the radius.

    start, end  (m, 3) float64, mm
    """
    radius = arcs.radius
    off_start = np.abs(distance_from_line(start - arcs.centre, arcs.normal) - radius)
    off_end = np.abs(distance_from_line(end - arcs.centre, arcs.normal) - radius)
    for index in np.flatnonzero(~has_unit_normal).tolist():
        what = "the normal of CIRCLE is not a unit vector"
        diagnostics.error(circles[index].line, what, "write i, j, k with length 1", code="CL570")
    for index in np.flatnonzero(radius <= 0).tolist():
        diagnostics.error(
            circles[index].line, "the radius of CIRCLE is not positive", "write a radius above 0", code="CL570"
        )
    sound = has_unit_normal & (radius > 0)
    for index in np.flatnonzero(sound & (np.maximum(off_start, off_end) > RADIUS_TOLERANCE)).tolist():
        which, off = ("start", off_start[index]) if off_start[index] > RADIUS_TOLERANCE else ("end", off_end[index])
        diagnostics.error(
            circles[index].line,
            f"the {which} point of the arc lies {off:.3f} mm off its radius {radius[index]:.4f}",
            "write centre, radius and points of one and the same circle",
            code="CL570",
        )


def _check_angles(
    arcs: Arcs, circles: Sequence[CircleStatement], start: Floats, end: Floats, diagnostics: Diagnostics
) -> None:
    """Report arcs whose angle is not that of their statement, such as arcs about a normal that points the wrong way.

    start, end  (m, 3) float64, mm
    """
    said = np.radians([circle.angle for circle in circles])
    turned = swept_angles(arcs, start, end) + 2.0 * np.pi * arcs.full_turns
    off = np.abs(turned - said)
    for index in np.flatnonzero((off > _OFF_ANGLE) & (off * arcs.radius > 2.0 * RADIUS_TOLERANCE)).tolist():
        by, not_by = np.degrees([turned[index], said[index]]).tolist()
        what = f"the arc turns by {by:.3f} degrees about its normal, and not by {not_by:.3f}"
        diagnostics.error(
            circles[index].line, what, "write the normal about which it turns by the right-hand rule", code="CL570"
        )


def report_open_ends(
    arcs: Arcs, circles: Sequence[CircleStatement], tip: Floats, kind: Codes, diagnostics: Diagnostics
) -> None:
    """Report an operation in which each arc is followed by a line to another point of its circle, ahead of it.

    Some systems write several points of an arc, and others only its end. One arc whose next line leaves the circle
    shows that each point is an end.
    """
    may_go_on = {circle.row: circle.line for circle in circles if circle.may_go_on}
    lines = []
    for k, row in enumerate(arcs.row.tolist()):
        if row == 0 or row not in may_go_on:
            continue
        if row + 1 >= len(tip) or kind[row + 1] != Kind.LINEAR or not _goes_on(arcs, k, tip[row - 1 : row + 2]):
            return
        lines.append(may_go_on[row])
    if lines:
        what = "a point of the same circle follows each arc: whether the arc goes on to it, or a line, is not told"
        diagnostics.error(
            lines[0], what, "output one point for each arc (ARC_ONLY), or lines in place of arcs", code="CL560"
        )


def _goes_on(arcs: Arcs, k: int, points: Floats) -> bool:
    """Whether the last of three points, (3, 3), lies on the arc through the others as it would go on."""
    radius = float(arcs.radius[k])
    offset = points - arcs.centre[k]
    height = offset @ arcs.normal[k]
    radial = offset - height[:, None] * arcs.normal[k]
    off = abs(float(np.linalg.norm(radial[2])) - radius)
    if max(off, abs(float(height[2] - height[1]))) > RADIUS_TOLERANCE:
        return False
    cross, dot = np.cross(radial[:2], radial[1:]) @ arcs.normal[k], np.sum(radial[:2] * radial[1:], axis=1)
    first, more = np.mod(np.arctan2(cross, dot), 2.0 * np.pi).tolist()
    sagitta = radius * (1.0 - np.cos(0.5 * more))
    return bool(sagitta > RADIUS_TOLERANCE and first + more <= 2.0 * np.pi + 1e-6)


def distance_from_line(offset: Floats, normal: Floats) -> Floats:
    """(m,) float64: distance from the line through the origin along ``normal``, for (m, 3) offsets."""
    along = np.sum(offset * normal, axis=1)
    across = offset - along[:, None] * normal
    return np.asarray(np.sqrt(np.sum(across * across, axis=1)), np.float64)
