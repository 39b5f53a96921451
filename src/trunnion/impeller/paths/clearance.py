"""How far a tool is from blades, hub and what clamps the part.

In:     the impeller; a tool; ball centres and tool axes.
Out:    distances of cutter, shank and holder, no greater than they are and less by a few µm at most.
Units:  mm.

What the ball itself keeps from is decided where passes are made. Here is what stands above its centre.
"""

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import field
from itertools import accumulate, pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, distinct
from trunnion.errors import InputError, argument_problem
from trunnion.impeller.blade import Blade
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.paths.cell_trees import STEPS, Cells, cell_tree, joined
from trunnion.impeller.paths.clearance_kernel import BodyData, ToolData, least_margins, part_distances
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.simulation.tools.pieces import revolved_pieces
from trunnion.simulation.tools.profile import Role, ToolShape

#: Smallest cells of a blade along w and v, and of what is turned about Z along its outline, bent or straight,
#: and round Z.
_BLADE: Final = (128, 64)
_TURNED: Final = (64, 256)
_STRAIGHT: Final = (32, 256)

#: What a ball may be off its place, mm: so much nearer the tool may stand beside the ball.
SLACK: Final = 0.005

#: Threads that look for distances, and rows that one of them looks at at least.
_THREADS: Final = os.cpu_count() or 1
_ROWS: Final = 64

#: How close the pieces of a tool are to it, mm.
_TOOL: Final = 0.001


@dataclass(frozen=True, slots=True, eq=False)
class Obstacles:
    """What tools must not touch, and its names; and the threads that look for distances from it."""

    data: BodyData
    names: tuple[str, ...]
    threads: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(_THREADS))


def obstacles_of(impeller: Impeller) -> Obstacles:
    """Return the bodies of a finished impeller: blades, splitters, and the hub within its stock."""
    trees: list[Cells] = []
    number: dict[int, int] = {}
    body, turn, names = [], [], []
    for k, (blade, angle) in enumerate(impeller.blades()):
        if id(blade) not in number:
            number[id(blade)] = len(trees)
            trees.append(_blade_cells(impeller, blade))
        body.append(number[id(blade)])
        turn.append(angle)
        each = 1 if impeller.splitter is None else 2
        names.append(f"{'blade' if k % each == 0 else 'splitter'} {k // each + 1}")
    for line in _smooth(_hub_outline(impeller)):
        body.append(len(trees))
        trees.append(_turned_cells(line))
        turn.append(0.0)
        names.append("the hub")
    cells, children, roots = joined(trees)
    return Obstacles(
        BodyData(cells, children, roots[body], np.column_stack((np.cos(turn), np.sin(turn)))), tuple(names)
    )


def _grid(counts: tuple[int, int]) -> tuple[Floats, Floats]:
    s, t = np.meshgrid(*(np.linspace(0.0, 1.0, STEPS * count + 1) for count in counts), indexing="ij")
    return s, t


def _blade_cells(impeller: Impeller, blade: Blade) -> Cells:
    """Return the cells of a blade that reach into the part: not those beyond shroud and stock, nor those deep in the
    hub.
    """
    s, t = _grid(_BLADE)
    w, v = s.ravel(), blade.low + t.ravel() * (blade.high - blade.low)
    frames = blade.frames(w, v)
    balls = np.column_stack((frames[0], frames[3, :, 0])).reshape(*s.shape, 4)
    stock = impeller.definition.stock
    middle = (slice(STEPS // 2, None, STEPS),) * 2
    at = np.ravel_multi_index(np.nonzero(_marked(s.shape, middle)), s.shape)
    size = np.linalg.norm(balls[STEPS::STEPS, STEPS::STEPS, :3] - balls[:-1:STEPS, :-1:STEPS, :3], axis=2).ravel() / 2.0
    half = frames[3, at, 0]
    centre = frames[0, at]
    inside = np.full(len(at), np.inf)
    for points in (
        centre,
        *(ball + half[:, None] * n for ball, n in (blade.sides(w[at], v[at], k) for k in (1.0, -1.0))),
    ):
        inside = np.minimum(inside, impeller.shroud.distances(points)[0])
    there = (inside <= size) & (impeller.hub.distances(centre)[0] >= -half - size)
    there &= np.hypot(centre[:, 0], centre[:, 1]) <= stock.diameter / 2.0 + half + size
    there &= (centre[:, 2] <= stock.top + half + size) & (centre[:, 2] >= stock.bottom - half - size)
    return cell_tree(balls, there.reshape(_BLADE))


def _marked(shape: tuple[int, ...], where: tuple[slice, slice]) -> Flags:
    marks = np.zeros(shape, np.bool_)
    marks[where] = True
    return marks


def _hub_outline(impeller: Impeller) -> Floats:
    """Return the hub within the stock, from the axis above to the axis below, (m, 2) radius and height."""
    stock = impeller.definition.stock
    radius = stock.diameter / 2.0
    points = impeller.hub.outline(_TOOL, 2.0 * (stock.height + stock.diameter))
    points = _cut(points, points[:, 1] - stock.top)
    points = _cut(points, points[:, 0] - radius)
    inner = min(stock.bore / 2.0, float(points[0, 0]))
    rim = [[radius, stock.bottom]] if points[-1, 1] > stock.bottom else []
    return np.vstack(([[inner, points[0, 1]]], points, *rim, [[stock.bore / 2.0, stock.bottom]]))


def _cut(points: Floats, beyond: Floats) -> Floats:
    """Return the first run of a polygon's points where ``beyond`` (n,) is not above 0, up to the places where it is."""
    inside = np.flatnonzero(beyond <= 0.0)
    first = int(inside[0])
    after = np.flatnonzero(beyond[first:] > 0.0)
    last = first + int(after[0]) - 1 if len(after) else len(points) - 1
    found = [points[first : last + 1]]
    for k, other in ((first, first - 1), (last, last + 1)):
        if 0 <= other < len(points):
            share = beyond[k] / (beyond[k] - beyond[other])
            edge = points[k] + share * (points[other] - points[k])
            found.insert(0 if other < k else len(found), edge[None])
    return np.vstack(found)


def _smooth(outline: Floats) -> list[Floats]:
    """Return the parts of an outline between its corners; those without length are none."""
    steps = np.diff(outline, axis=0)
    length = np.linalg.norm(steps, axis=1)
    keep = np.r_[True, length > 1e-9]
    outline = outline[keep]
    steps = np.diff(outline, axis=0) / np.linalg.norm(np.diff(outline, axis=0), axis=1)[:, None]
    corners = np.flatnonzero(np.einsum("ij,ij->i", steps[1:], steps[:-1]) < math.cos(0.2)) + 1
    ends = np.r_[0, corners, len(outline) - 1]
    return [outline[a : b + 1] for a, b in pairwise(ends.tolist())]


def _turned_cells(line: Floats) -> Cells:
    """Return the cells of what a line (m, 2) of radius and height sweeps about Z."""
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]
    counts = _TURNED if len(line) > 2 else _STRAIGHT
    s, t = _grid(counts)
    r, z = (np.interp(s * way[-1], way, line[:, k]) for k in (0, 1))
    angle = 2.0 * np.pi * t
    return cell_tree(
        np.stack((r * np.cos(angle), r * np.sin(angle), z, np.zeros_like(r)), axis=2), np.ones(counts, np.bool_)
    )


@dataclass(frozen=True, slots=True, eq=False)
class ToolBody:
    """A tool above its ball's centre, in convex pieces.

    real        its pieces, from one radius above the ball's centre on
    roles       of these pieces
    wide        its pieces with the clearance that is wanted beside them
    wide_roles  of these pieces
    """

    real: ToolData
    roles: tuple[Role, ...]
    wide: ToolData
    wide_roles: tuple[Role, ...]

    def part(self, role: Role) -> ToolData:
        """Return the pieces of ``real`` of a role."""
        which = [k for k, one in enumerate(self.roles) if one is role]
        first = self.real.first
        return _data([self.real.corners[first[k] : first[k + 1]] for k in which], [0.0] * len(which))

    def up_to(self, role: Role) -> ToolData:
        """Return the pieces of ``wide`` up to the last one of a role."""
        count = 1 + max(k for k, one in enumerate(self.wide_roles) if one is role)
        first = self.wide.first[: count + 1]
        return ToolData(first, self.wide.corners[: first[-1]], self.wide.wanted[:count])


@dataclass(frozen=True, slots=True)
class Margins:
    """Distances in mm that are wanted; ``lean`` degrees: beside the ball, cutter and shank want as much less."""

    cutter: float
    shank: float
    holder: float
    lean: float


def tool_body(shape: ToolShape, radius: float, margins: Margins) -> ToolBody:
    """Return the pieces of a ball-ended tool.

    Raises ``InputError`` if the tool has no ball of this radius at its end.
    """
    element = shape.sections[0].outline[0]
    centre = getattr(element, "centre", (math.nan, math.nan))
    if not (abs(centre[0]) < 1e-6 and abs(centre[1] - radius) < 1e-6 and element.start[1] < 1e-6):
        raise InputError(argument_problem("tool", Wording("IMP321", "no_ball_radius", radius=radius)))
    pieces, _ = revolved_pieces(shape, _TOOL)
    real, wide, roles, wide_roles, wanted = [], [], [], [], []
    slope = math.tan(math.radians(margins.lean))
    for k in range(len(pieces.first) - 1):
        role = shape.sections[int(pieces.section[k])].role
        corners = _corners(pieces.elements[pieces.first[k] : pieces.first[k + 1]], radius)
        if len(corners) < 2:
            continue
        above = _from(corners, radius)
        if len(above):
            real.append(_closed(above))
            roles.append(role)
        extra = margins.cutter if role is Role.CUTTER else margins.shank
        if role is Role.HOLDER:
            wide.append(_closed(corners))
        else:
            wide.append(_closed(_widened(corners, extra, slope)))
        wide_roles.append(role)
        wanted.append(margins.holder if role is Role.HOLDER else 0.0)
    return ToolBody(_data(real, [0.0] * len(real)), tuple(roles), _data(wide, wanted), tuple(wide_roles))


def _data(pieces: list[Floats], wanted: list[float]) -> ToolData:
    first = np.array([0, *accumulate(map(len, pieces))])
    return ToolData(first, np.vstack(pieces) if pieces else np.empty((0, 2)), np.array(wanted))


def _corners(elements: Floats, radius: float) -> Floats:
    """Side of a piece, (k, 2) radius and height above the ball's centre, upward, without what is below that."""
    rows: list[tuple[float, float]] = []
    for z0, z1, r0, r1, ball in elements.tolist():
        if not math.isnan(ball):
            continue  # the ball
        for r, z in ((r0, z0 - radius), (r1, z1 - radius)):
            if not rows or (r, z) != rows[-1]:
                rows.append((r, z))
    return _from(np.array(rows).reshape(-1, 2), 0.0)


def _from(corners: Floats, z: float) -> Floats:
    """Return a side from a height on."""
    if len(corners) < 2 or corners[-1, 1] <= z:
        return np.empty((0, 2))
    if corners[0, 1] >= z:
        return corners
    r = float(np.interp(z, corners[:, 1], corners[:, 0]))
    return np.vstack(([[r, z]], corners[corners[:, 1] > z]))


def _widened(corners: Floats, extra: float, slope: float) -> Floats:
    """Return a side, wider by ``extra``; near the ball's centre by as much as a line of a slope allows."""
    z = corners[:, 1]
    full = (extra + SLACK) / slope
    heights = distinct(np.r_[z, full]) if z[0] < full < z[-1] else z
    r = np.interp(heights, z, corners[:, 0]) if len(heights) > len(z) else corners[:, 0]
    return np.column_stack((np.maximum(r + np.minimum(extra, heights * slope - SLACK), 0.0), heights))


def _closed(side: Floats) -> Floats:
    """Return a side with the axis below and above it."""
    found = np.vstack(([[0.0, side[0, 1]]], side, [[0.0, side[-1, 1]]]))
    return found[np.r_[True, np.linalg.norm(np.diff(found, axis=0), axis=1) > 1e-12]]


def margins_of(obstacles: Obstacles, tool: ToolData, centre: Floats, axis: Floats, low: float, high: float) -> Floats:
    """Return what the clearance of poses (n,) is above that wanted, at most ``high``; below ``low`` it may be less
    still.
    """
    found = np.empty(len(centre))

    def work(rows: slice) -> None:
        least_margins(obstacles.data, tool, centre[rows], axis[rows], low, high, found[rows])

    _on_all_cores(obstacles.threads, work, len(centre))
    return found


def distances_of(obstacles: Obstacles, tool: ToolData, centre: Floats, axis: Floats, high: float) -> Floats:
    """Distance of each piece from each body for poses, (n, pieces, bodies), at most ``high``."""
    found = np.empty((len(centre), len(tool.wanted), len(obstacles.names)))

    def work(rows: slice) -> None:
        part_distances(obstacles.data, tool, centre[rows], axis[rows], high, found[rows])

    _on_all_cores(obstacles.threads, work, len(centre))
    return found


def _on_all_cores(threads: ThreadPoolExecutor, work: Callable[[slice], None], count: int) -> None:
    """Work on rows in as many threads as there are cores; kernels give up the interpreter's lock."""
    size = max(-(-count // (4 * _THREADS)), _ROWS)
    rows = [slice(start, start + size) for start in range(0, count, size)]
    if _THREADS == 1 or len(rows) < 2:
        for one in rows:
            work(one)
        return
    list(threads.map(work, rows))
