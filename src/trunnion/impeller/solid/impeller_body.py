"""The body of an impeller before its stock is cut off: hub, fillets, blades and the form of the shroud.

In:     an impeller.
Out:    ``Body``, closed, which reaches beyond the stock wherever the stock cuts it.
Units:  mm and rad.

The hub is one face for each channel, with borders from the leading edges to the inlet and from the trailing edges to
the outlet; splitters are holes in them. So no face goes all round the axis, and each begins where its metal is not.
"""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.errors import InputError, Problem
from trunnion.impeller.impeller import Impeller, rotated
from trunnion.impeller.profiles import Profile
from trunnion.impeller.solid.root_loop import LEADING, PARTS, TRAILING, Density, RootLoop, root_loop
from trunnion.impeller.solid.shapes import (
    Body,
    Circle,
    Cylinder,
    EdgeUse,
    Line,
    Plane,
    Spline,
    SplineSurface,
    TurnedSurface,
    along_u,
    along_v,
)
from trunnion.impeller.solid.splines import spline_through
from trunnion.impeller.solid.turned import Meridian, ends_of, profile_parameters
from trunnion.messages import Wording
from trunnion.records import dataclass

#: How far the body reaches beyond the stock, mm.
_BEYOND: Final = 2.0

#: Turned surfaces go on beyond what is on them by this part of the profile's parameter.
_MORE: Final = 0.05

#: Angle between the beginning of a turned surface and what is on it, rad.
_BEFORE: Final = 0.3

#: A hub so near to the axis is on it, mm.
_ON_AXIS: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class _Foot:
    """A blade on the hub: its edges there, its vertices at the middles of its edges, and its angle about Z."""

    loop: RootLoop
    angle: float
    edges: tuple[int, ...]
    leading: int
    trailing: int

    def hub(self, part: int, more: float) -> Floats:
        """Angle and parameter of the hub (k, 2) along a part, turned by more rad."""
        return np.asarray(self.loop.parts[part].hub + np.array([self.angle + more, 0.0]))


class _Ring(NamedTuple):
    """A circle in which channels end, as one arc for each channel, and the borders that lead there.

    number 0 of the arcs is between the first two blades, of the borders at the first blade
    """

    at: float
    arcs: tuple[int, ...]
    borders: tuple[int, ...]
    vertices: tuple[int, ...]


def impeller_body(impeller: Impeller, density: Density) -> tuple[Body, Floats]:
    """Make the body, and tell the angles (k,) about Z at which it has trailing edges.

    Raises ``InputError`` if it has a form that no such body has: the cause and, where there is one, the cure.
    """
    body = Body()
    main = root_loop(impeller, impeller.blade, density)
    near = float(main.parts[0].hub[0, 0])
    splitter = None if impeller.splitter is None else root_loop(impeller, impeller.splitter, density, near)
    loops = [main] if splitter is None else [main, splitter]
    hub, apex = _hub_meridian(impeller, np.vstack([loop.feet for loop in loops]))
    shroud = _shroud_meridian(impeller, loops)
    _check_clear(impeller, hub)
    number = impeller.definition.number
    pitch = 2.0 * np.pi / number
    feet = [_add_blade(body, main, k * pitch, shroud) for k in range(number)]
    holes = [] if splitter is None else [_add_blade(body, splitter, (k + 0.5) * pitch, shroud) for k in range(number)]
    inlet, outlet = _rings(body, hub, feet, apex=apex)
    for k in range(number):
        _add_channel(body, hub, feet, holes[k : k + 1], k, (inlet, outlet))
    if not apex:
        radius, height = hub.place(hub.low)
        body.face(Plane(height), [[EdgeUse(arc, False, Circle(radius, 0.0)) for arc in inlet.arcs]], outward=True)
    _add_bottom(body, impeller, hub, feet, outlet)
    return body, np.concatenate([_trailing_angles(foot) for foot in feet + holes])


def _hub_meridian(impeller: Impeller, feet: Floats) -> tuple[Meridian, bool]:
    """Return the hub from the axis, or from outside of stock or inside of the bore, to outside of the stock.

    Also whether it begins on the axis.
    """
    stock, profile = impeller.definition.stock, impeller.hub
    at = profile_parameters(profile, feet)
    (first, last), (start, end) = ends_of(profile)
    ways = {}
    if start[2] < 0.0:
        ways["top"] = max((first[2] - max(stock.top, float(feet[:, 2].max())) - _BEYOND) / start[2], 0.0)
    if start[0] > 0.0:
        ways["axis"] = first[0] / start[0]
        if stock.bore:
            ways["bore"] = max((first[0] - stock.bore / 4.0) / start[0], 0.0)
    if first[0] <= _ON_AXIS:
        ways["axis"] = 0.0
    if not ways:
        raise _refused(impeller, Wording("IMP420", "hub_leads_neither"))
    way = min(ways, key=lambda name: ways[name])
    low = -ways[way]
    if way == "top":
        low = min(low, float(at.min()) - _MORE)
    if low >= at.min():
        raise _refused(impeller, Wording("IMP420", "fillet_reaches_farther"))
    reach = max(stock.diameter / 2.0, float(np.hypot(feet[:, 0], feet[:, 1]).max())) + _BEYOND
    outward = (reach - last[0]) / end[0] if end[0] > 0.0 else np.inf
    down = (stock.bottom - _BEYOND - last[2]) / end[2] if end[2] < 0.0 else np.inf
    high = 1.0 + max(min(outward, down), 0.0)
    if not np.isfinite(high):
        raise _refused(impeller, Wording("IMP420", "hub_does_not"))
    found = Meridian.of(profile, low, max(high, float(at.max()) + _MORE))
    if way == "axis":
        found.curve.points[0, :2] = 0.0
    return found, way == "axis"


def _shroud_meridian(impeller: Impeller, loops: Sequence[RootLoop]) -> Meridian:
    """Return the shroud as far as blades reach it."""
    at = np.concatenate([part.shroud[:, 1] for loop in loops for part in loop.parts])
    return Meridian.of(impeller.shroud, min(0.0, float(at.min()) - _MORE), max(1.0, float(at.max()) + _MORE))


def _check_clear(impeller: Impeller, hub: Meridian) -> None:
    """Refuse a shroud that cuts the hub inside of the stock: the body leaves that out."""
    stock = impeller.definition.stock
    places = np.array([hub.place(at) for at in np.linspace(hub.low, hub.high, 801)])
    points = np.column_stack((places[:, 0], np.zeros(len(places)), places[:, 1]))
    inside = (places[:, 0] < stock.diameter / 2.0) & (places[:, 0] > stock.bore / 2.0)
    inside &= (places[:, 1] < stock.top) & (places[:, 1] > stock.bottom)
    if (_above(impeller.shroud, points) & inside).any():
        raise _refused(impeller, Wording("IMP420", "hub_shroud_cross"))


def _above(shroud: Profile, points: Floats) -> Flags:
    return np.asarray(shroud.distances(points)[0] >= 0.0)


def _refused(impeller: Impeller, wording: Wording) -> InputError:
    return InputError(Problem(impeller.definition.file, 0, wording))


def _add_blade(body: Body, loop: RootLoop, angle: float, shroud: Meridian) -> _Foot:
    """Add the patches of a blade, its fillet and its tip."""
    parts = loop.parts
    patches = [(_turned(part.fillet, angle), _turned(part.blade, angle)) for part in parts]
    low, middle, top = (
        [body.vertex(point) for point in points]
        for points in (
            [fillet.points[0, 0] for fillet, _ in patches],
            [blade.points[0, 0] for _, blade in patches],
            [blade.points[0, -1] for _, blade in patches],
        )
    )
    arcs, rises = [], []
    for k, (fillet, blade) in enumerate(patches):
        arcs.append(body.edge(Spline(fillet.v_knots, fillet.points[0]), (low[k], middle[k]), (0.0, 1.0)))
        rises.append(body.edge(Spline(blade.v_knots, blade.points[0]), (middle[k], top[k]), (0.0, 1.0)))
    feet, tops = [], []
    for k, (part, (fillet, blade)) in enumerate(zip(parts, patches, strict=True)):
        after, span = (k + 1) % PARTS, (0.0, float(part.at[-1]))
        foot, contact, tip = (
            body.edge(Spline(patch.u_knots, patch.points[:, row]), (ends[k], ends[after]), span)
            for patch, row, ends in ((fillet, 0, low), (fillet, -1, middle), (blade, -1, top))
        )
        for patch, below, above, sides in ((fillet, foot, contact, arcs), (blade, contact, tip, rises)):
            loop_of_patch = [
                EdgeUse(below, False, along_u(0.0, 0.0)),
                EdgeUse(sides[after], False, along_v(span[1], 0.0)),
                EdgeUse(above, True, along_u(0.0, 1.0)),
                EdgeUse(sides[k], True, along_v(0.0, 0.0)),
            ]
            body.face(patch, [loop_of_patch], outward=part.outward)
        feet.append(foot)
        tops.append(tip)
    _add_tip(body, loop, angle, shroud, tops)
    return _Foot(loop, angle, tuple(feet), low[LEADING], low[TRAILING])


def _add_tip(body: Body, loop: RootLoop, angle: float, shroud: Meridian, edges: Sequence[int]) -> None:
    """Add the form of the shroud between the edges of a blade's tip."""
    start = min(float(part.shroud[:, 0].min()) for part in loop.parts) - _BEFORE
    places = [part.shroud - [start, 0.0] for part in loop.parts]
    backwards = _turn(places) < 0.0
    uses = [
        EdgeUse(edge, backwards, spline_through(part.at, flat))
        for edge, part, flat in zip(edges, loop.parts, places, strict=True)
    ]
    surface = TurnedSurface(shroud.turned(angle + start))
    body.face(surface, [uses[::-1] if backwards else uses], outward=False)


def _rings(body: Body, hub: Meridian, feet: Sequence[_Foot], *, apex: bool) -> tuple[_Ring, _Ring]:
    """Add the circles in which the hub ends at inlet and outlet, and the borders of channels."""
    found = []
    for part, at, inward in ((LEADING, hub.low, True), (TRAILING, hub.high, False)):
        radius, height = hub.place(at)
        ends = [foot.hub(part, 0.0)[0] for foot in feet]
        pole = inward and apex
        if pole:
            vertices = [body.vertex(np.array([0.0, 0.0, height]))] * len(feet)
        else:
            vertices = [body.vertex(_polar(radius, angle, height)) for angle, _ in ends]
        borders, arcs = [], []
        for k, (foot, (angle, start)) in enumerate(zip(feet, ends, strict=True)):
            joined = (vertices[k], foot.leading) if inward else (foot.trailing, vertices[k])
            borders.append(body.edge(hub.turned(angle), joined, (at, start) if inward else (start, at)))
            after = (k + 1) % len(feet)
            span = (angle, angle + 2.0 * np.pi / len(feet))
            curve = None if pole else Circle(radius, height)
            arcs.append(body.edge(curve, (vertices[k], vertices[after]), span))
        found.append(_Ring(at, tuple(arcs), tuple(borders), tuple(vertices)))
    return found[0], found[1]


def _add_channel(
    body: Body, hub: Meridian, feet: Sequence[_Foot], holes: Sequence[_Foot], k: int, rings: tuple[_Ring, _Ring]
) -> None:
    """Add the hub between a blade and the next one, which is turned by a pitch more."""
    inlet, outlet = rings
    one, after = feet[k], (k + 1) % len(feet)
    other, more = feet[after], 0.0 if after else 2.0 * np.pi
    backwards = _turn([part.hub for part in one.loop.parts]) > 0.0
    # Going on round its foot, a blade is passed upwards on one side, and downwards on the other.
    ahead = (2, 3, 4) if backwards else (5, 0, 1)
    behind = (5, 0, 1) if backwards else (2, 3, 4)
    start = min(float(one.hub(part, 0.0)[:, 0].min()) for part in range(PARTS)) - _BEFORE
    end = max(float(other.hub(part, more)[:, 0].max()) for part in range(PARTS))
    if end - start > 2.0 * np.pi - _BEFORE:
        raise InputError(Problem("blade", 0, Wording("IMP420", "channel_goes_round")))

    def passed(foot: _Foot, parts: tuple[int, ...], turned: float) -> list[EdgeUse]:
        return [
            EdgeUse(
                foot.edges[part],
                backwards,
                spline_through(foot.loop.parts[part].at, foot.hub(part, turned) - [start, 0.0]),
            )
            for part in (parts[::-1] if backwards else parts)
        ]

    def border(foot: _Foot, edge: int, part: int, turned: float, *, inwards: bool) -> EdgeUse:
        return EdgeUse(edge, inwards, along_v(foot.hub(part, turned)[0, 0] - start, 0.0))

    loop = [
        EdgeUse(inlet.arcs[k], False, along_u(-start, inlet.at)),
        border(other, inlet.borders[after], LEADING, more, inwards=False),
        *passed(other, behind, more),
        border(other, outlet.borders[after], TRAILING, more, inwards=False),
        EdgeUse(outlet.arcs[k], True, along_u(-start, outlet.at)),
        border(one, outlet.borders[k], TRAILING, 0.0, inwards=True),
        *passed(one, ahead, 0.0),
        border(one, inlet.borders[k], LEADING, 0.0, inwards=True),
    ]
    loops = [loop, *(passed(hole, tuple(range(PARTS)), 0.0) for hole in holes)]
    body.face(TurnedSurface(hub.turned(start)), loops, outward=False)


def _add_bottom(body: Body, impeller: Impeller, hub: Meridian, feet: Sequence[_Foot], outlet: _Ring) -> None:
    """Add what closes the body below: a cylinder from the hub's outlet down, and a plane."""
    radius, height = hub.place(hub.high)
    bottom = min(height, impeller.definition.stock.bottom) - _BEYOND
    angles = [float(foot.hub(TRAILING, 0.0)[0, 0]) for foot in feet]
    pitch = 2.0 * np.pi / len(feet)
    vertices = [body.vertex(_polar(radius, angle, bottom)) for angle in angles]
    rises = []
    for k, angle in enumerate(angles):
        x, y, _ = _polar(radius, angle, bottom)
        line = Line((float(x), float(y), bottom), (0.0, 0.0, 1.0))
        rises.append(body.edge(line, (vertices[k], outlet.vertices[k]), (0.0, height - bottom)))
    arcs = []
    for k, angle in enumerate(angles):
        after = (k + 1) % len(feet)
        arcs.append(body.edge(Circle(radius, bottom), (vertices[k], vertices[after]), (angle, angle + pitch)))
        start = angle - _BEFORE
        loop = [
            EdgeUse(arcs[k], False, along_u(-start, bottom)),
            EdgeUse(rises[after], False, along_v(angle + pitch - start, bottom)),
            EdgeUse(outlet.arcs[k], True, along_u(-start, height)),
            EdgeUse(rises[k], True, along_v(angle - start, bottom)),
        ]
        body.face(Cylinder(radius, start), [loop], outward=True)
    body.face(Plane(bottom), [[EdgeUse(arc, False, Circle(radius, 0.0)) for arc in arcs]], outward=False)


def _turned(patch: SplineSurface, angle: float) -> SplineSurface:
    points = rotated(patch.points.reshape(-1, 3), angle).reshape(patch.points.shape)
    return SplineSurface(patch.u_knots, patch.v_knots, points)


def _trailing_angles(foot: _Foot) -> Floats:
    """Angles about Z from hub to shroud at a trailing edge."""
    parts = foot.loop.parts[TRAILING - 1 :]
    return np.concatenate([one[:, 0] + foot.angle for part in parts for one in (part.hub, part.shroud)])


def _polar(radius: float, angle: float, height: float) -> Floats:
    return np.array([radius * np.cos(angle), radius * np.sin(angle), height])


def _turn(parts: Sequence[Floats]) -> float:
    """Twice the area of a closed loop of places (k, 2), above 0 if it goes counter-clockwise."""
    x, y = np.vstack(parts).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
