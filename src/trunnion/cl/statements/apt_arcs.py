"""Arcs of APT dialects: INDIRV with [TLON,]GOFWD, and MOVARC."""

import math
import re
from collections.abc import Sequence
from typing import Final

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import ArcDirection, ReaderState
from trunnion.cl.statement import Statement, joined_lines, numbers
from trunnion.cl.statements import apt_refused, motion
from trunnion.messages import Wording

_Vector = tuple[float, float, float]

_NUMBERS: Final = r"([^()/]*)"
_ON: Final = r",ON,(?:([12]),INTOF,)?"
_CIRCLE: Final = re.compile(rf"(?:TLON,)?GOFWD/\(CIRCLE/{_NUMBERS}\){_ON}\(LINE/{_NUMBERS}\)")
_CYLINDER: Final = re.compile(
    rf"(?:TLON,)?GOFWD/\(CYLNDR/{_NUMBERS}\){_ON}\(PLANE/PERPTO,\(PLANE/\(POINT/{_NUMBERS}\),PERPTO,"
    rf"\(VECTOR/{_NUMBERS}\)\),\(POINT/{_NUMBERS}\),\(POINT/{_NUMBERS}\)\)"
)

#: How far the end point may be off the radius, as a part of it, and at least, in units of the file.
_OFF_RADIUS: Final = 1e-3
#: How far the end point may be off the plane of the start, in units of the file: points have three decimals or more.
_OFF_PLANE: Final = 2e-3
#: How far the direction may be off the tangent, as the cosine of the angle between direction and radius.
_OFF_TANGENT: Final = 0.02
#: A normal no farther off an axis of coordinates than this is taken for it: directions have five decimals.
_AXIS_PARALLEL: Final = 1e-3
#: An arc that ends nearer to the line through its start and the centre than this, radians, meets it anywhere.
_ON_LINE: Final = 0.02


def indirv(state: ReaderState, statement: Statement) -> None:
    """Note the direction in which the arc that follows begins."""
    if state.direction is not None:
        state.direction.report_lost_arc(state.diagnostics)
    state.direction = ArcDirection(state.row, state.line, statement.numbers(3))


def tlon(state: ReaderState, statement: Statement) -> None:
    """Take TLON on a line of its own, before GOFWD: the tool is on the circle, as it always is here."""
    if statement.values:
        apt_refused.part_program(state, statement)


def gofwd(state: ReaderState, statement: Statement) -> None:
    """Write an arc up to the point where its circle meets the line or plane that ends it."""
    text = "".join(joined_lines(statement.source).split()).upper()
    direction, state.direction = state.direction, None
    if direction is not None and direction.row != state.row:
        direction.report_lost_arc(state.diagnostics)
        direction = None
    start = motion.current_tip(state)
    if start is None or direction is None:
        raise StatementError(
            Wording("CL510", "gofwd_without_indirv") if start else Wording("CL510", "gofwd_without_start")
        )
    if found := _CIRCLE.fullmatch(text):
        centre, radius = _split(_floats(found[1], 4))
        centre = (centre[0], centre[1], centre[2])
        line = _floats(found[3], 6)
        if math.dist(line[:3], centre) > max(_OFF_RADIUS * radius, _OFF_RADIUS):
            raise StatementError(Wording("CL570", "gofwd_ends_line"))
        end, given = (line[3], line[4], line[5]), None
    elif found := _CYLINDER.fullmatch(text):
        cylinder, last = _floats(found[1], 7), _floats(found[6], 3)
        centre, radius = (cylinder[0], cylinder[1], cylinder[2]), cylinder[6]
        end, given = (last[0], last[1], last[2]), (cylinder[3], cylinder[4], cylinder[5])
    else:
        raise StatementError(Wording("CL250", "gofwd_along_other"))
    i, j, k = direction.vector
    normal = _normal(_minus(start, centre), (i, j, k), given)
    if abs(_dot(_minus(end, start), normal)) > _OFF_PLANE:
        raise StatementError(Wording("CL570", "gofwd_ends_off"))
    end = _on_circle(centre, normal, radius, end)
    _check_intersection(_minus(start, centre), _minus(end, centre), normal, found[2])
    motion.begin_circle(state, (*centre, *normal, radius), 1)
    motion.write_row(state, end)
    motion.keep_axis(state)


def movarc(state: ReaderState, statement: Statement) -> None:
    """Make the next row an arc: MOVARC/xc,yc,zc,i,j,k,r,ANGLE,degrees."""
    values = statement.values
    if len(values) != 9 or values[7] != "ANGLE":
        raise StatementError(Wording("CL330", "movarc_not_known", listed=statement.listed()))
    given, (angle,) = numbers("MOVARC", values[:7], 7), numbers("MOVARC ANGLE", values[8:], 1)
    if not 0.0 < angle < 360.0 * motion.MAX_TURNS:
        raise StatementError(Wording("CL570", "movarc_angle_degrees", angle=angle))
    motion.begin_circle(state, given, math.ceil(angle / 360.0 - 1e-6), angle=angle)


def _floats(text: str, count: int) -> tuple[float, ...]:
    """Numbers between commas."""
    try:
        found = tuple(float(field.replace("D", "E", 1)) for field in text.split(","))
    except ValueError:
        raise StatementError(Wording("CL310", "gofwd_where_numbers", text=repr(text))) from None
    return numbers("GOFWD", found, count)


def _split(values: Sequence[float]) -> tuple[Sequence[float], float]:
    return values[:-1], values[-1]


def _minus(a: Sequence[float], b: Sequence[float]) -> _Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Sequence[float], b: Sequence[float]) -> _Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _unit(vector: Sequence[float]) -> _Vector:
    length = math.hypot(*vector)
    if not length > 0.0:
        raise StatementError(Wording("CL570", "gofwd_direction_axis"))
    return vector[0] / length, vector[1] / length, vector[2] / length


def _normal(radial: _Vector, direction: _Vector, given: _Vector | None) -> _Vector:
    """Return the unit vector about which the arc turns by the right-hand rule: by its start, its direction and its
    axis.
    """
    direction = _unit(direction)
    if given is not None:
        axis = _unit(given)
        side = _dot(_unit(_cross(axis, radial)), direction)
        if abs(side) < 1.0 - _OFF_TANGENT:
            raise StatementError(Wording("CL570", "indirv_not_tangent"))
        return axis if side > 0 else (-axis[0], -axis[1], -axis[2])
    if abs(_dot(_unit(radial), direction)) > _OFF_TANGENT:
        raise StatementError(Wording("CL570", "indirv_not_tangent"))
    normal = _unit(_cross(radial, direction))
    for k in range(3):
        if abs(normal[k]) > 1.0 - 0.5 * _AXIS_PARALLEL**2:
            parallel = [0.0, 0.0, 0.0]
            parallel[k] = math.copysign(1.0, normal[k])
            return parallel[0], parallel[1], parallel[2]
    return normal


def _on_circle(centre: Sequence[float], normal: _Vector, radius: float, towards: Sequence[float]) -> _Vector:
    """Return the point of the circle in the direction of ``towards``, at its height."""
    offset = _minus(towards, centre)
    height = _dot(offset, normal)
    radial = _minus(offset, (height * normal[0], height * normal[1], height * normal[2]))
    length = math.hypot(*radial)
    if abs(length - radius) <= max(_OFF_RADIUS * radius, _OFF_RADIUS):
        return towards[0], towards[1], towards[2]
    x, y, z = _unit(radial)
    return (
        centre[0] + height * normal[0] + radius * x,
        centre[1] + height * normal[1] + radius * y,
        centre[2] + height * normal[2] + radius * z,
    )


def _check_intersection(start: _Vector, end: _Vector, normal: _Vector, count: str | None) -> None:
    """Refuse an end that is not the first, or with 2,INTOF the second, place where the circle meets the line."""
    angle = math.atan2(_dot(_cross(start, end), normal), _dot(start, end)) % (2.0 * math.pi)
    if min(angle, abs(angle - math.pi), 2.0 * math.pi - angle) < _ON_LINE:
        return
    if (angle > math.pi) != (count == "2"):
        raise StatementError(
            Wording("CL570", "gofwd_turns_degrees", angle=math.degrees(angle))
            if count == "2"
            else Wording("CL570", "gofwd_turns_degrees_where", angle=math.degrees(angle))
        )
