"""From passes to one path: leads, links between passes, retracts and approaches that stay clear.

In:     the passes of a step and their tool axes; what the tool must not touch; where the stock is.
Out:    ``LinkedPath``: ball centres and tool axes with the kind and the phase of each motion.
Frame:  that of the impeller. Units: mm.

Outside of the stock, grown by a clearance, a tool moves in rapid: up to a height at which nothing of it reaches the
stock, whatever its tilt, then across and down. Inside it moves at feed, where every pose has been proven clear.
"""

import math
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Flags, Floats
from trunnion.errors import InputError, Problem
from trunnion.impeller.definition import StockSize
from trunnion.impeller.impeller import rotated
from trunnion.impeller.paths.passes import Pass
from trunnion.impeller.paths.thinning import thinned
from trunnion.impeller.progress import Progress, silent
from trunnion.messages import Wording
from trunnion.model.toolpath import Kind, Phase
from trunnion.records import dataclass

#: Whether the ball and the rest of the tool are clear at poses: centres (n, 3), axes (n, 3) -> (n,).
IsClear = Callable[[Floats, Floats], Flags]

#: Poses are proven clear at this distance along links, mm.
_STEP: Final = 0.25

#: A lead arc that is not clear is tried with half its radius, so often.
_HALVINGS: Final = 4

#: Chords of a quarter of a lead arc.
_ARC_CHORDS: Final = 12

#: How far the tool axis may be off where points are left out, degrees.
_AXIS_TOLERANCE: Final = 0.05


@dataclass(frozen=True, slots=True)
class Links:
    """How passes are linked, mm.

    lead       radius of the arcs that lead in and out; 0: none
    clearance  by which the stock is grown: outside of it motion is rapid
    longest    direct link between two passes; a longer one retracts
    tolerance  of the ball's centre, where points are left out
    """

    lead: float
    clearance: float
    longest: float
    tolerance: float


@dataclass(frozen=True, slots=True, eq=False)
class LinkedPath:
    """A path from the safe height to the safe height.

    centre  (n, 3) of the tool's ball
    axis    (n, 3) unit vectors towards the holder
    kind    (n,)   a ``Kind``: how the tool comes to the point
    phase   (n,)   a ``Phase``
    """

    centre: Floats
    axis: Floats
    kind: Codes
    phase: Codes

    def turned(self, angle: float) -> "LinkedPath":
        """Return the same path, turned about Z by an angle in radians."""
        return LinkedPath(rotated(self.centre, angle), rotated(self.axis, angle), self.kind, self.phase)


@dataclass(frozen=True, slots=True)
class FreeSpace:
    """Where a tool moves in rapid: outside of the stock, grown by clearance and ball.

    radius, top  of the cylinder that it stays out of, for ball centres
    height       of ball centres from which on nothing of the tool reaches the cylinder, whatever its tilt
    """

    radius: float
    top: float
    height: float

    @staticmethod
    def around(stock: StockSize, clearance: float, radius: float, outline: Floats, axes: Floats) -> "FreeSpace":
        """Return the space around a stock, for a ball of a radius.

        outline  (k, 2): radii and heights above the ball's centre of the tool, mm
        axes     (n, 3): the tool axes that are used
        """
        tilt = float(np.arccos(np.clip(axes[:, 2], -1.0, 1.0)).max())
        angles = np.linspace(0.0, tilt, 65)[:, None]
        lowest = float((outline[:, 1] * np.cos(angles) - outline[:, 0] * np.sin(angles)).min())
        top = stock.top + clearance
        return FreeSpace(stock.diameter / 2.0 + clearance + radius, top + radius, top + max(radius, -lowest))

    def way_out(self, centre: Floats, axis: Floats) -> float:
        """How far a ball moves along the tool axis until it is outside; infinite if it never is."""
        across = float(np.hypot(centre[0], centre[1]))
        if across >= self.radius or centre[2] >= self.top:
            return 0.0
        up = (self.top - float(centre[2])) / float(axis[2]) if axis[2] > 1e-9 else math.inf
        a = float(axis[:2] @ axis[:2])
        if a < 1e-18:
            return up
        b, c = float(centre[:2] @ axis[:2]), across**2 - self.radius**2
        return min(up, (-b + math.sqrt(b * b - a * c)) / a)


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What a tool keeps to between passes.

    space     where motion is rapid
    is_clear  of the ball and the rest of the tool
    step      name of the step, for messages
    """

    space: FreeSpace
    is_clear: IsClear
    step: str


class _Path:
    """A path as it grows."""

    def __init__(self) -> None:
        self.centre: list[Floats] = []
        self.axis: list[Floats] = []
        self.kind: list[int] = []
        self.phase: list[int] = []

    def add(self, centre: Floats, axis: Floats, kind: Kind, phase: Phase) -> None:
        """Add points (k, 3); what repeats the last pose is left out."""
        for point, direction in zip(centre, axis, strict=True):
            if self.centre and np.abs(point - self.centre[-1]).max() < 1e-9 and direction @ self.axis[-1] > 1.0 - 1e-15:
                continue
            self.centre.append(point)
            self.axis.append(direction)
            self.kind.append(int(kind))
            self.phase.append(int(phase))

    def done(self) -> LinkedPath:
        """Return the path as columns."""
        return LinkedPath(
            np.array(self.centre), np.array(self.axis), np.array(self.kind, np.uint8), np.array(self.phase, np.uint8)
        )


def link_passes(
    passes: Sequence[Pass],
    axes: Sequence[Floats],
    around: Surroundings,
    links: Links,
    radius: float,
    progress: Progress = silent,
) -> LinkedPath:
    """Link passes in their order to one path.

    passes, axes  of one step, in the order and direction of cutting
    radius        from the ball's centre to the tip, mm
    progress      accompanies the work

    Raises ``InputError`` if the tool cannot leave a pass or come to it without touching something; with the place.
    """
    path = _Path()
    before: tuple[Floats, Floats] | None = None
    with progress("links", len(passes), "passes") as advance:
        for k, (one, axis) in enumerate(zip(passes, axes, strict=True)):
            keep = thinned(one.centre, axis, radius, links.tolerance, _AXIS_TOLERANCE)
            centre, directions = one.centre[keep], axis[keep]
            start = _lead(one, axis, links.lead, around.is_clear, out=False)
            if before is not None and _is_direct(before, (centre[0], directions[0]), links, around.is_clear):
                path.add(centre[:1], directions[:1], Kind.LINEAR, Phase.STEPOVER)
            else:
                if before is not None:
                    _leave(path, passes[k - 1], axes[k - 1], around, links)
                _approach(path, start, directions[0], around)
                path.add(start, np.repeat(directions[:1], len(start), axis=0), Kind.LINEAR, Phase.ENGAGE)
            path.add(centre, directions, Kind.LINEAR, Phase.CUT)
            before = centre[-1], directions[-1]
            advance(1)
    if passes:
        _leave(path, passes[-1], axes[-1], around, links)
    return path.done()


def _is_direct(before: tuple[Floats, Floats], after: tuple[Floats, Floats], links: Links, is_clear: IsClear) -> bool:
    """Whether the tool may go straight from one pass to the next."""
    if float(np.linalg.norm(after[0] - before[0])) > links.longest:
        return False
    return bool(is_clear(*_between(*before, *after)).all())


def _lead(one: Pass, axis: Floats, radius: float, is_clear: IsClear, *, out: bool) -> Floats:
    """Points of the arc that leads into the start of a pass, or out of its end; the point itself if none is clear.

    The arc is tangent to the pass, in the plane of the pass and its contact normal, and comes from the normal's side.
    """
    k, beside = (-1, -2) if out else (0, 1)
    centre, direction = one.centre[k], axis[k]
    if radius <= 0.0 or len(one) < 2:
        return np.asarray(centre[None])
    along = one.centre[beside] - centre  # away from the end, into the pass
    along = along / max(float(np.linalg.norm(along)), 1e-12)
    normal = one.normal[k] - (one.normal[k] @ along) * along
    size = float(np.linalg.norm(normal))
    if size < 1e-6:
        return np.asarray(centre[None])
    angle = np.linspace(math.pi / 2.0, 0.0, _ARC_CHORDS + 1)[:, None]
    for _ in range(_HALVINGS):
        arc = centre + radius * ((1.0 - np.cos(angle)) * (normal / size) - np.sin(angle) * along)
        if is_clear(arc, np.repeat(direction[None], len(arc), axis=0)).all():
            return np.asarray(arc[::-1] if out else arc)
        radius /= 2.0
    return np.asarray(centre[None])


def _leave(path: _Path, one: Pass, axis: Floats, around: Surroundings, links: Links) -> None:
    """Lead out of a pass, retract along the tool axis, and go up."""
    lead, direction = _lead(one, axis, links.lead, around.is_clear, out=True), axis[-1]
    path.add(lead, np.repeat(direction[None], len(lead), axis=0), Kind.LINEAR, Phase.RETRACT)
    way = _clear_way(lead[-1], direction, around, "leave")
    outside = lead[-1] + way * direction
    path.add(outside[None], direction[None], Kind.LINEAR, Phase.RETRACT)
    path.add(_raised(outside, around.space)[None], direction[None], Kind.RAPID, Phase.DEPARTURE)


def _approach(path: _Path, lead: Floats, direction: Floats, around: Surroundings) -> None:
    """Come down outside of the stock, and along the tool axis to a lead."""
    outside = lead[0] + _clear_way(lead[0], direction, around, "come to") * direction
    path.add(_raised(outside, around.space)[None], direction[None], Kind.RAPID, Phase.TRAVERSE)
    path.add(outside[None], direction[None], Kind.RAPID, Phase.RAPID)
    path.add(lead[:1], direction[None], Kind.LINEAR, Phase.APPROACH)


def _raised(point: Floats, space: FreeSpace) -> Floats:
    """Return the point at the safe height above, or itself where it is higher."""
    return np.array([point[0], point[1], max(float(point[2]), space.height)])


def _clear_way(centre: Floats, axis: Floats, around: Surroundings, what: str) -> float:
    """How far it is out of the stock along the tool axis, every pose on the way, and then straight up, being clear.

    Raises ``InputError`` if one is not, or there is no way out.
    """
    way = around.space.way_out(centre, axis)
    if math.isfinite(way):
        outside = centre + way * axis
        up = _between(outside, axis, _raised(outside, around.space), axis)
        out = _between(centre, axis, outside, axis)
        if all(around.is_clear(*poses).all() for poses in (out, up)):
            return way
    x, y, z = centre
    raise InputError(Problem(around.step, 0, Wording("IMP325", "tool_cannot_pass", subject=what, x=x, y=y, z=z)))


def _between(first: Floats, first_axis: Floats, last: Floats, last_axis: Floats) -> tuple[Floats, Floats]:
    """Poses from one to another, close to each other: centres (k, 3) and axes (k, 3)."""
    count = max(1, math.ceil(float(np.linalg.norm(last - first)) / _STEP))
    share = np.linspace(0.0, 1.0, count + 1)[:, None]
    axis = first_axis + share * (last_axis - first_axis)
    return first + share * (last - first), axis / np.linalg.norm(axis, axis=1)[:, None]
