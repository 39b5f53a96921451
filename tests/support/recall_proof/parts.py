"""Twenty small parts as CL files: milling, arcs, holes, stops, planes and five axes, for machines of every language."""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Final, TypeAlias

Point: TypeAlias = tuple[float, float, float]

_UP: Final = (0.0, 0.0, 1.0)


def _numbers(*values: float) -> str:
    return ",".join(f"{value:.6f}" for value in values)


def _goto(point: Sequence[float], axis: Point | None = None) -> str:
    return f"GOTO/{_numbers(*point, *(axis or ()))}"


def rapid(*points: Sequence[float], axis: Point | None = None) -> list[str]:
    """Rapids to points."""
    lines = list[str]()
    for point in points:
        lines += ["RAPID", _goto(point, axis)]
    return lines


def to_feed(feed: float, *points: Sequence[float]) -> list[str]:
    """A feed, and lines to points at it."""
    return [f"FEDRAT/MMPM,{feed:g}", *(_goto(point) for point in points)]


def _arc(centre: Point, end: Point, radius: float, way: int = 1, turns: int = 0, normal: Point = _UP) -> list[str]:
    """An arc to a point, counter-clockwise about the normal; -1: clockwise."""
    times = f",TIMES,{turns}" if turns else ""
    axis = [way * value for value in normal]
    return [f"CIRCLE/{_numbers(*centre, *axis, radius)},0.06,0.5,10.0,0.0{times}", _goto(end)]


def operation(name: str, tool: int, speed: int, lines: Iterable[str], kind: str = "MILL,10.0,0.0") -> list[str]:
    """An operation of one tool."""
    return [
        f"TOOL PATH/{name},TOOL,T{tool}",
        f"TLDATA/{kind},75.0,0.0,0.0",
        "MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0",
        "$$ centerline data",
        "PAINT/PATH",
        f"LOAD/TOOL,{tool},ADJUST,{tool}",
        f"SPINDL/RPM,{speed},CLW",
        "COOLNT/FLOOD",
        *lines,
        "COOLNT/OFF",
        "SPINDL/OFF",
        "PAINT/TOOL,NOMORE",
        "END-OF-PATH",
    ]


def _face() -> list[str]:
    """A face in lines to and fro."""
    corners = [(x, y, -1.0) for k, y in enumerate((-20.0, -12.0, -4.0, 4.0, 12.0, 20.0)) for x in _sides(k, 45.0)]
    start = rapid((-55.0, -20.0, 40.0), (-55.0, -20.0, 2.0), axis=_UP)
    path = [*start, *to_feed(300, (-55.0, -20.0, -1.0)), *to_feed(800, *corners, (corners[-1][0], 20.0, 5.0))]
    return operation("FACE", 1, 2400, [*path, *rapid((corners[-1][0], 20.0, 40.0))])


def _sides(k: int, x: float) -> tuple[float, float]:
    return (-x, x) if k % 2 == 0 else (x, -x)


def _pocket() -> list[str]:
    """A pocket with round corners, in two levels."""
    lines = rapid((5.0, 3.0, 40.0), (5.0, 3.0, 2.0), axis=_UP)
    for z in (-2.0, -4.5):
        lines += [*to_feed(150, (5.0, 3.0, z)), *to_feed(500, (20.0, 3.0, z), (20.0, 10.0, z))]
        lines += [*_arc((15.0, 10.0, z), (15.0, 15.0, z), 5.0), _goto((-15.0, 15.0, z))]
        lines += [*_arc((-15.0, 10.0, z), (-20.0, 10.0, z), 5.0), _goto((-20.0, -10.0, z))]
        lines += [*_arc((-15.0, -10.0, z), (-15.0, -15.0, z), 5.0), _goto((15.0, -15.0, z))]
        lines += [*_arc((15.0, -10.0, z), (20.0, -10.0, z), 5.0), _goto((20.0, 3.0, z)), _goto((5.0, 3.0, z))]
    return operation("POCKET", 2, 3000, [*lines, *to_feed(900, (5.0, 3.0, 2.0)), *rapid((5.0, 3.0, 40.0))])


def _rings() -> list[str]:
    """Full circles, both ways round."""
    lines = rapid((12.0, 6.0, 40.0), (12.0, 6.0, 2.0), axis=_UP)
    for z, way, feed in ((-1.0, 1, 400), (-2.0, -1, 350), (-3.5, 1, 300)):
        lines += [*to_feed(120, (12.0, 6.0, z)), f"FEDRAT/MMPM,{feed}"]
        lines += [*_arc((3.0, 6.0, z), (-6.0, 6.0, z), 9.0, way), *_arc((3.0, 6.0, z), (12.0, 6.0, z), 9.0, way)]
    return operation("RINGS", 3, 2800, [*lines, *to_feed(700, (12.0, 6.0, 3.0)), *rapid((12.0, 6.0, 40.0))])


def _helix() -> list[str]:
    """A helix down, and a circle at its bottom."""
    lines = [*rapid((8.0, -7.0, 40.0), (8.0, -7.0, 1.0), axis=_UP), *to_feed(260, (8.0, -7.0, 0.0))]
    for k in range(1, 5):
        lines += _arc((2.0, -7.0, 1.5 - 1.5 * k), (8.0, -7.0, -1.5 * k), 6.0, turns=1)
    lines += [*_arc((2.0, -7.0, -6.0), (2.0, -1.0, -6.0), 6.0), *_arc((2.0, -7.0, -6.0), (8.0, -7.0, -6.0), 6.0)]
    return operation("HELIX", 4, 3200, [*lines, *to_feed(800, (2.0, -7.0, -6.0)), *rapid((2.0, -7.0, 40.0))])


def _slot() -> list[str]:
    """A slot with round ends, into which the tool ramps."""
    lines = [*rapid((-18.0, 5.0, 40.0), (-18.0, 5.0, 1.5), axis=_UP), *to_feed(220, (18.0, 5.0, -2.0))]
    lines += [*_arc((18.0, 11.0, -2.0), (18.0, 17.0, -2.0), 6.0), *to_feed(480, (-18.0, 17.0, -2.0))]
    lines += [*_arc((-18.0, 11.0, -2.0), (-18.0, 5.0, -2.0), 6.0), _goto((18.0, 5.0, -2.0))]
    return operation("SLOT", 5, 3600, [*lines, *to_feed(900, (18.0, 5.0, 3.0)), *rapid((18.0, 5.0, 40.0))])


def _profile(side: str, way: int) -> list[str]:
    """A closed profile with compensation of the radius."""
    x, y = 40.0, 30.0
    corners = [(-x, y), (x, y), (x, -y), (-x, -y)] if way > 0 else [(x, -y), (x, y), (-x, y), (-x, -y)]
    lines = rapid((-60.0, -50.0, 40.0), (-60.0, -50.0, 2.0), axis=_UP)
    lines += [*to_feed(200, (-60.0, -50.0, -4.0)), "FEDRAT/MMPM,450", f"CUTCOM/{side},XYPLAN,6", _goto((-x, -y, -4.0))]
    lines += [*(_goto((a, b, -4.0)) for a, b in corners), "CUTCOM/OFF", _goto((-60.0, -45.0, -4.0))]
    return operation("PROFILE", 6, 2600, [*lines, _goto((-60.0, -45.0, 4.0)), *rapid((-60.0, -45.0, 40.0))])


def _holes(cycle: str, *points: Point, speed: int = 2000, tool: int = 7, depth: float = 40.0) -> list[str]:
    """Holes of one cycle from above."""
    first, last = points[0], points[-1]
    lines = [*rapid((*first[:2], depth), axis=_UP), f"CYCLE/{cycle}", *(_goto(point) for point in points)]
    lines += ["CYCLE/OFF", *rapid((*last[:2], depth))]
    return operation("HOLES", tool, speed, lines, "DRILL,MILL,5.0,0.0")


def _spots() -> list[str]:
    cycle = "DRILL,RAPTO,3.0,FEDTO,-2.5,RTRCTO,3.0,MMPM,300.0,DWELL,0.4"
    return _holes(cycle, *((x, y, 0.0) for x in (-20.0, 5.0, 22.0) for y in (-12.0, 9.0)))


def _pecks() -> list[str]:
    cycle = "DRILL,DEEP,STEP,4.0,RAPTO,3.0,FEDTO,-21.0,RTRCTO,15.0,MMPM,220.0"
    return _holes(cycle, (14.0, 3.0, 0.0), (-9.0, 11.0, 0.0), (-16.0, -8.0, 0.0), tool=8)


def _chips() -> list[str]:
    cycle = "DRILL,BRKCHP,STEP,3.0,RAPTO,2.0,FEDTO,-14.0,RTRCTO,12.0,MMPM,180.0"
    return _holes(cycle, (11.0, -6.0, 0.0), (-13.0, 7.0, 1.0), (4.0, 18.0, 1.0), tool=9)


def _threads() -> list[str]:
    cycle = "TAP,RAPTO,5.0,FEDTO,-11.0,RTRCTO,9.0,MMPR,1.25"
    return _holes(cycle, (16.0, 2.0, 0.0), (-7.0, 13.0, 0.0), (-12.0, -9.0, 0.0), speed=480, tool=10)


def _reamed() -> list[str]:
    cycle = "BORE,RAPTO,4.0,FEDTO,-13.0,RTRCTO,10.0,MMPM,95.0,DWELL,0.6"
    return _holes(cycle, (15.0, 4.0, 0.0), (-8.0, 12.0, 0.0), (-11.0, -7.0, 0.0), speed=750, tool=11)


def _two_tools() -> list[str]:
    """A step, cut by one tool and finished by another."""

    def step(name: str, tool: int, speed: int, feed: float, offset: float) -> list[str]:
        x, z = 20.0 + offset, -5.0 + offset
        path = [
            *to_feed(0.5 * feed, (x, -40.0, z)),
            *to_feed(feed, (x, 40.0, z), (x + 6.0, 40.0, z), (x + 6.0, -40.0, z)),
        ]
        lines = [*rapid((x, -40.0, 40.0), (x, -40.0, 2.0), axis=_UP), *path, *rapid((x + 6.0, -40.0, 40.0))]
        return operation(name, tool, speed, lines)

    return [*step("ROUGH", 12, 1900, 700, 0.5), *step("FINISH", 13, 4100, 420, 0.0)]


def _stops() -> list[str]:
    """Dwells and stops between cuts."""
    lines = [*rapid((-30.0, 8.0, 40.0), (-30.0, 8.0, 2.0), axis=_UP), *to_feed(200, (-30.0, 8.0, -1.5)), "DELAY/1.5"]
    lines += [*to_feed(520, (30.0, 8.0, -1.5), (30.0, 8.0, 6.0)), "STOP", *rapid((30.0, -14.0, 6.0))]
    lines += ["FEDRAT/MMPM,240", "SPINDL/RPM,2700,CLW", "COOLNT/FLOOD", _goto((30.0, -14.0, -2.5))]
    lines += [_goto((-30.0, -14.0, -2.5)), "DELAY/0.7", _goto((-30.0, -22.0, -2.5)), _goto((-30.0, -22.0, 6.0))]
    return operation("STOPS", 14, 2300, [*lines, "OPSTOP", *rapid((-30.0, -22.0, 40.0))])


def _coolants() -> list[str]:
    """Coolant off and on again between cuts, and other speeds."""
    lines = [*rapid((-25.0, 0.0, 40.0), (-25.0, 0.0, 3.0), axis=_UP), *to_feed(180, (-25.0, 0.0, -1.0))]
    lines += [*to_feed(600, (-5.0, 4.0, -1.0), (-5.0, 4.0, 3.0)), "COOLNT/OFF", *rapid((5.0, -6.0, 3.0))]
    lines += [
        "SPINDL/RPM,3300,CLW",
        *to_feed(190, (5.0, -6.0, -2.0)),
        *to_feed(640, (25.0, -9.0, -2.0)),
        "COOLNT/FLOOD",
    ]
    lines += ["SPINDL/RPM,2900,CLW", *to_feed(560, (25.0, 11.0, -2.0), (12.0, 17.0, -2.5), (12.0, 17.0, 4.0))]
    return operation("COOLANTS", 15, 2100, [*lines, *rapid((12.0, 17.0, 40.0))])


def _frame(tilt: float, turn: float, origin: Point) -> tuple[Callable[[float, float, float], Point], Point]:
    """What brings a point of a tilted plane to the part, and the axis of the plane."""
    a, c = math.radians(tilt), math.radians(turn)
    x = (math.cos(a) * math.cos(c), math.cos(a) * math.sin(c), -math.sin(a))
    y = (-math.sin(c), math.cos(c), 0.0)
    z = (math.sin(a) * math.cos(c), math.sin(a) * math.sin(c), math.cos(a))

    def at(u: float, v: float, w: float) -> Point:
        p, q, r = (origin[i] + u * x[i] + v * y[i] + w * z[i] for i in range(3))
        return p, q, r

    return at, z


def _tilted_cuts(name: str, tool: int, tilt: float, turn: float) -> list[str]:
    """Lines and an arc in a tilted plane."""
    at, axis = _frame(tilt, turn, (6.0, -4.0, 8.0))
    lines = [*rapid(at(-20.0, -8.0, 50.0), at(-20.0, -8.0, 3.0), axis=axis), *to_feed(170, at(-20.0, -8.0, -1.0))]
    lines += [*to_feed(530, at(15.0, -8.0, -1.0)), *_arc(at(15.0, 1.0, -1.0), at(15.0, 10.0, -1.0), 9.0, normal=axis)]
    lines += [_goto(at(-20.0, 10.0, -1.0)), _goto(at(-20.0, -8.0, -1.0)), _goto(at(-20.0, -8.0, 4.0))]
    return operation(name, tool, 4200, [*lines, *rapid(at(-20.0, -8.0, 50.0))])


def _tilted_holes() -> list[str]:
    """Deep holes along two tilted axes."""
    lines = list[str]()
    for tilt, turn in ((35.0, 20.0), (50.0, 200.0)):
        at, axis = _frame(tilt, turn, (0.0, 0.0, 10.0))
        lines += [*rapid(at(0.0, -9.0, 60.0), axis=axis)]
        lines += ["CYCLE/DRILL,DEEP,STEP,4.0,RAPTO,3.0,FEDTO,-15.0,RTRCTO,20.0,MMPM,210.0"]
        lines += [_goto(at(0.0, y, 0.0)) for y in (-9.0, 2.0, 11.0)]
        lines += ["CYCLE/OFF", *rapid(at(0.0, 11.0, 60.0))]
    return operation("TILTED_HOLES", 17, 2400, lines, "DRILL,MILL,5.0,0.0")


def _swept(name: str, tool: int, count: int, tilts: tuple[float, float], turns: tuple[float, float]) -> list[str]:
    """A path along which the tool axis turns at every point."""
    lines = list[str]()
    for k in range(count + 1):
        t = k / count
        tilt, turn = (a + t * (b - a) for a, b in (tilts, turns))
        at, axis = _frame(tilt, turn, (0.0, 0.0, -4.0 + 3.0 * t))
        point = at(22.0 + 2.0 * math.sin(3.0 * t), 4.0 * t, 0.0)
        if k == 0:
            lines += rapid(at(22.0, 0.0, 60.0), at(22.0, 0.0, 3.0), axis=axis)
            lines.append("FEDRAT/MMPM,210")
        lines.append(_goto(point, axis))
        if k == 0:
            lines.append("FEDRAT/MMPM,610")
        if k == count:
            lines += rapid(at(22.0, 4.0, 60.0))
    return operation(name, tool, 6500, lines, "MILL,6.0,3.0")


def _two_planes() -> list[str]:
    return [*_tilted_cuts("ONE", 18, 25.0, 75.0), *_tilted_cuts("TWO", 19, 40.0, 160.0)]


#: Name and statements of each.
PARTS: Final[dict[str, list[str]]] = {
    "face": _face(),
    "pocket": _pocket(),
    "rings": _rings(),
    "helix": _helix(),
    "slot": _slot(),
    "profile_left": _profile("LEFT", 1),
    "profile_right": _profile("RIGHT", -1),
    "spots": _spots(),
    "pecks": _pecks(),
    "chips": _chips(),
    "threads": _threads(),
    "reamed": _reamed(),
    "two_tools": _two_tools(),
    "stops": _stops(),
    "coolants": _coolants(),
    "leaning": _tilted_cuts("LEANING", 16, 30.0, 40.0),
    "two_planes": _two_planes(),
    "tilted_holes": _tilted_holes(),
    "swarf": _swept("SWARF", 20, 9, (18.0, 34.0), (15.0, 95.0)),
    "fan": _swept("FAN", 21, 12, (42.0, 24.0), (230.0, 140.0)),
}


def cl_text(name: str) -> str:
    """The CL file of a part."""
    return "\n".join([f"PARTNO/{name.upper()}", "UNITS/MM", *PARTS[name]]) + "\n"
