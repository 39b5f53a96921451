"""How the tool stands: one smooth field of tool axes for all passes of a step.

In:     a family of passes, the tool, what it must not touch, and what directions the machine reaches.
Out:    an axis for each point of each pass, and the proof that the whole tool stays clear at all of them.
Units:  mm and degrees.

Regions of directions are found at some places, and a field in them. Then every point of every pass is checked: where
one is not clear, its place joins the others, without the direction that was wrong there.
"""

import math
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints, distinct
from trunnion.errors import InputError, Problem
from trunnion.impeller.paths.axis_field import AxisField, FieldFit, fit_field
from trunnion.impeller.paths.axis_regions import Margin, Regions, climb, grow_regions, regions_about, sphere
from trunnion.impeller.paths.clearance import Margins, Obstacles, ToolBody, distances_of, margins_of, tool_body
from trunnion.impeller.paths.clearance_kernel import ToolData
from trunnion.impeller.paths.least_clearances import FAR, PartClearance, least_clearances
from trunnion.impeller.paths.passes import PassFamily, Way
from trunnion.impeller.progress import Advance, Progress, silent
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.simulation.tools.profile import Role, ToolShape

#: Places from which the search begins.
_NODES: Final = 500

#: mm along passes to one span of the field, and spans along, across and in layers.
_SPAN: Final = 6.0
_SPANS: Final = ((4, 3, 2), (16, 3, 2))

#: What is across and in layers counts as no narrower than this part of what is along.
_LEAST_WIDTH: Final = 0.25

#: Rounds of checking, and places that one adds.
_ROUNDS: Final = 8
_ADDED: Final = 60

#: Parts of the wanted clearances that are tried, from all of them to the least.
SHARES: Final = (1.0, 0.5, 0.25, 0.0)

#: The cutter leans away from the surface at least so much beside its ball, degrees.
_LEAST_LEAN: Final = 0.2

#: Directions among which the best one is sought where none is clear.
_DIRECTIONS: Final = 2000

#: Places in the way of a field at which the reason is sought.
_ASKED: Final = 8

#: A field that is out of a cone by less than this is in it.
_NEAR: Final = 1e-6


@dataclass(frozen=True, slots=True)
class Wanted:
    """Clearances in mm that are wanted of cutter, shank and holder.

    least  what shank and holder keep where not all can be had
    lean   degrees by which the sides of cutter and shank lean away from a surface where the ball touches it
    tilt   greatest angle in degrees between tool axis and Z
    """

    cutter: float = 0.2
    shank: float = 0.5
    holder: float = 2.0
    least: float = 0.05
    lean: float = 2.0
    tilt: float = 100.0

    def margins(self, share: float) -> Margins:
        """Return what is asked for if only a share of the clearances can be had."""
        shank, holder = (max(share * value, min(self.least, value)) for value in (self.shank, self.holder))
        return Margins(share * self.cutter, shank, holder, max(share * self.lean, min(_LEAST_LEAN, self.lean)))


@dataclass(frozen=True, slots=True, eq=False)
class ToolAxes:
    """The tool axes of a family.

    axes       (n, 3) for each pass: unit vectors from the ball's centre towards the holder
    clearance  over all points: for each part of the tool, the body that it comes nearest to
    share      of the wanted clearances that is kept
    turning    how fast the axis turns along passes at most, degrees per mm
    """

    field: AxisField
    axes: tuple[Floats, ...]
    clearance: tuple[PartClearance, ...]
    share: float
    turning: float


def choose_axes(
    family: PassFamily,
    tool: ToolShape,
    obstacles: Obstacles,
    wanted: Wanted = Wanted(),
    reachable: Callable[[Floats], Flags] | None = None,
    progress: Progress = silent,
) -> ToolAxes:
    """Choose the tool axes of a family of passes.

    family     a family that is a spiral is closed along its first parameter
    obstacles  what the tool keeps clear of, in the frame of the passes
    wanted     clearances; where they cannot be had everywhere, a smaller share of all of them is tried
    reachable  tells of directions (n, 3) which the machine reaches, (n,)
    progress   accompanies the work

    Raises ``InputError`` if there is no such field: with the place, what is in the way of which part of the tool, and
    what helps.
    """
    search = _Search(family, obstacles, wanted.tilt, reachable, progress)
    for share in SHARES:
        body = tool_body(tool, family.radius, wanted.margins(share))
        field = search.field(body)
        if field is not None:
            axes = tuple(field.axes(one.place) for one in family.passes)
            clearance = least_clearances(obstacles, body, search.centres, np.concatenate(axes))
            return ToolAxes(field, axes, clearance, share, _turning(family, axes))
    raise InputError(search.fault(tool, body))


class _Search:
    """The search for a field, with one tool and one set of clearances after another."""

    def __init__(
        self,
        family: PassFamily,
        obstacles: Obstacles,
        tilt: float,
        reachable: Callable[[Floats], Flags] | None,
        progress: Progress,
    ) -> None:
        self.centres, self.places = family.centres(), family.places()
        self._obstacles = obstacles
        self._lowest = math.cos(math.radians(tilt)) - 1e-12
        self._tilt = tilt
        self._reachable, self._progress = reachable, progress
        self._is_closed = family.way is Way.SPIRAL
        self._lengths = _lengths(family)
        self._nodes = _nodes(self.places, self._lengths)
        self._bad = self._nodes[:1]
        self._has_end = True

    def field(self, body: ToolBody) -> AxisField | None:
        """Return a field that keeps a tool clear everywhere; None if none is found."""
        nodes = self._nodes
        with self._progress("tool axes", len(nodes), "places") as advance:
            regions = grow_regions(self._apart(self.places[nodes]), self._margin_at(body.wide, nodes), advance)
        nowhere = np.flatnonzero(np.isnan(regions.middle[:, 0]))
        if len(nowhere):
            self._bad = nodes[nowhere]
            return None
        fewest, most = _SPANS
        spans = tuple(
            int(np.clip(math.ceil(length / _SPAN), fewest[k], most[k])) for k, length in enumerate(self._lengths)
        )
        for finer in (1, 2):
            found = self._checked(body, nodes, regions, tuple(finer * count for count in spans))
            if found is not None:
                return found
        return None

    def _checked(self, body: ToolBody, nodes: Ints, regions: Regions, spans: tuple[int, ...]) -> AxisField | None:
        """Return the field with so many spans, after as many rounds of checking as it takes; None: that does
        not end.
        """
        with self._progress("field of tool axes", _ROUNDS, "rounds") as advance:
            return self._rounds(body, nodes, regions, spans, advance)

    def _rounds(
        self, body: ToolBody, nodes: Ints, regions: Regions, spans: tuple[int, ...], advance: Advance
    ) -> AxisField | None:
        for _ in range(_ROUNDS):
            fit = self._fit(nodes, regions, spans)
            if fit is None:
                self._bad, self._has_end = nodes, False
                return None
            if fit.outside > _NEAR:
                self._bad = nodes[[self._worst(fit, nodes, regions)]]
                return None
            axes = fit.field.axes(self.places)
            margin = self._margins(body.wide, np.arange(len(axes)), axes, -1.0, 0.0)
            wrong = np.flatnonzero(margin < 0.0)
            if not len(wrong):
                return fit.field
            self._bad = wrong[[int(margin[wrong].argmin())]]
            added = self._spread(wrong, margin)
            near = _nearest(self._apart(self.places[nodes]), self._apart(self.places[added]))
            more = regions_about(added, regions.middle[near], axes[added], self._margin_at(body.wide, None))
            nowhere = np.flatnonzero(np.isnan(more.middle[:, 0]))
            if len(nowhere):
                self._bad = added[nowhere]
                return None
            nodes, regions = np.r_[nodes, added], regions.joined(more)
            advance(1)
        return None

    def _fit(self, nodes: Ints, regions: Regions, spans: tuple[int, ...]) -> FieldFit | None:
        # Passes that are near to each other may well differ in their axes.
        lengths = np.maximum(self._lengths, _LEAST_WIDTH * self._lengths[0])
        return fit_field(self.places[nodes], regions, spans, lengths, is_closed=self._is_closed)

    def _worst(self, fit: FieldFit, nodes: Ints, regions: Regions) -> int:
        """Return the node whose cone a field is farthest out of."""
        axes = fit.field.axes(self.places[nodes])
        inside = np.einsum("ij,ij->i", axes[regions.owner], regions.walls)
        return int(regions.owner[inside.argmin()])

    def _spread(self, wrong: Ints, margin: Floats) -> Ints:
        """Of points, the worst of each neighbourhood."""
        cells = np.floor(self.places[wrong] * self._lengths / 2.0).astype(np.int64)
        order = np.argsort(margin[wrong], kind="stable")
        _, first = np.unique(cells[order], axis=0, return_index=True)
        return wrong[order[np.sort(first)[:_ADDED]]]

    def _apart(self, places: Floats) -> Floats:
        """Places as points whose distances are about those of the centres."""
        scaled = places * self._lengths
        if not self._is_closed:
            return scaled
        angle, radius = 2.0 * np.pi * places[:, 0], self._lengths[0] / (2.0 * np.pi)
        return np.column_stack((radius * np.cos(angle), radius * np.sin(angle), scaled[:, 1:]))

    def _margin_at(self, tool: ToolData, nodes: Ints | None) -> Margin:
        """Return the margins of directions at nodes, or at points."""

        def margin(rows: Ints, directions: Floats, low: float) -> Floats:
            return self._margins(
                tool, rows if nodes is None else nodes[rows], directions, low, 0.0 if low == 0.0 else 1.0
            )

        return margin

    def _margins(self, tool: ToolData, points: Ints, axes: Floats, low: float, high: float) -> Floats:
        """Margins of clearance (n,), −∞ for axes that are tilted too much or that the machine does not reach."""
        found = np.full(len(points), -np.inf)
        there = axes[:, 2] >= self._lowest
        if self._reachable is not None and there.any():
            there[there] = self._reachable(axes[there])
        found[there] = margins_of(self._obstacles, tool, self.centres[points[there]], axes[there], low, high)
        return found

    def fault(self, tool: ToolShape, body: ToolBody) -> Problem:
        """Why there is no field: where it is worst of the places in the way, the lowest part that finds no room."""
        asked = self._bad[distinct(np.linspace(0, len(self._bad) - 1, _ASKED).astype(int))]
        name = tool.name or "the tool"
        directions = sphere(_DIRECTIONS)
        clear = np.ones((len(asked), _DIRECTIONS), np.bool_)
        for role in dict.fromkeys(body.wide_roles):
            pieces = body.up_to(role)
            rows = np.repeat(asked, _DIRECTIONS)
            margins = self._margins(pieces, rows, np.tile(directions, (len(asked), 1)), -np.inf, 1.0)
            # Where what is below has room: there, the parts above may get in the way.
            margins = np.where(clear, margins.reshape(clear.shape), -np.inf)
            _, value = climb(asked, directions[margins.argmax(axis=1)], self._margin_at(pieces, None))
            k = int(value.argmin())
            place = _place_words(self.places[asked[k]], self.centres[asked[k]])
            if value[k] == -np.inf:
                return Problem(name, 0, Wording("IMP322", "no_tool_axis", tilt=self._tilt, place=place))
            if value[k] < 0.0:
                start = directions[[int(margins[k].argmax())]]
                missing, other = self._missing(pieces, asked[[k]], start)
                wording = Wording("IMP323", _NOT_CLEAR[role], part=role, other=other, place=place, missing=missing)
                return Problem(name, 0, wording)
            clear = margins >= 0.0
            clear[~clear.any(axis=1)] = True
        if not self._has_end:
            return Problem(name, 0, Wording("IMP324", "no_smooth_field"))
        return Problem(name, 0, Wording("IMP324", "tool_axes_clear", place=place))

    def _missing(self, pieces: ToolData, point: Ints, axis: Floats) -> tuple[float, str]:
        """How much pieces of a tool miss at a point with an axis, and the body that is in their way."""
        distances = distances_of(self._obstacles, pieces, self.centres[point], axis, FAR)[0] - pieces.wanted[:, None]
        _, number = np.unravel_index(int(distances.argmin()), distances.shape)
        return -float(distances.min()), self._obstacles.names[number]


_NOT_CLEAR: Final = {
    Role.CUTTER: "cutter_not_clear",
    Role.SHANK: "shank_not_clear",
    Role.HOLDER: "holder_not_clear",
}


def _place_words(place: Floats, centre: Floats) -> str:
    names = ("along", "across", "in layers")
    shares = ", ".join(f"{value:.0%} {name}" for value, name in zip(place, names, strict=False))
    return f"at {shares} (radius {math.hypot(centre[0], centre[1]):.3f}, height {centre[2]:.3f} mm)"


def _lengths(family: PassFamily) -> Floats:
    """Return what a parameter from 0 to 1 is in mm: along, the median of the passes; else as centres change on
    average.
    """
    along = []
    for one in family.passes:
        way = np.linalg.norm(np.diff(one.centre, axis=0), axis=1).sum()
        share = np.abs(np.diff(one.place[:, 0]))
        share = share[share < 0.5].sum()  # a closed one goes from 1 to 0
        if share > 0.0:
            along.append(way / share)
    places, centres = family.places(), family.centres()
    design = np.column_stack((places, np.ones(len(places))))
    slopes = np.linalg.lstsq(design, centres, rcond=None)[0][:-1]
    found = np.r_[np.median(along) if along else 1.0, np.linalg.norm(slopes[1:], axis=1)]
    return np.asarray(np.maximum(found, 1.0))


def _nodes(places: Floats, lengths: Floats) -> Ints:
    """Points, in all cells of about one size the one that is nearest to the middle."""
    low, high = 0.01, float(lengths.max())
    for _ in range(40):
        size = math.sqrt(low * high)
        if len(distinct(_cells(places, np.maximum(np.round(lengths / size), 1.0)))) > _NODES:
            low = size
        else:
            high = size
    counts = np.maximum(np.round(lengths / high), 1.0)
    scaled = np.clip(places, 0.0, 1.0 - 1e-12) * counts
    away = np.linalg.norm(scaled - np.floor(scaled) - 0.5, axis=1)
    order = np.argsort(away, kind="stable")
    _, first = np.unique(_cells(places, counts)[order], return_index=True)
    return np.asarray(order[first])


def _cells(places: Floats, counts: Floats) -> Ints:
    """Numbers (n,) of the cells in which places (n, k) are, with so many of them (k,) along each parameter."""
    found = np.zeros(len(places), np.int64)
    for k, count in enumerate(counts.astype(np.int64).tolist()):
        found *= count
        found += (np.clip(places[:, k], 0.0, 1.0 - 1e-12) * count).astype(np.int64)
    return found


def _nearest(places: Floats, asked: Floats) -> Ints:
    """Rows of places that are nearest to those asked."""
    return np.array([int(np.linalg.norm(places - one, axis=1).argmin()) for one in asked])


def _turning(family: PassFamily, axes: Sequence[Floats]) -> float:
    """How fast axes turn along passes at most, degrees per mm."""
    fastest = 0.0
    for one, own in zip(family.passes, axes, strict=True):
        way = np.linalg.norm(np.diff(one.centre, axis=0), axis=1)
        turn = 2.0 * np.arcsin(np.clip(np.linalg.norm(np.diff(own, axis=0), axis=1) / 2.0, 0.0, 1.0))
        moves = way > 1e-6
        fastest = max(fastest, float(np.degrees(turn[moves] / way[moves]).max(initial=0.0)))
    return fastest
