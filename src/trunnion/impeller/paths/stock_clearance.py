"""How near shank and holder come to the stock in steps that go round the part.

In:     the passes of such a step with their tool axes, the tool, and the stock as it stands before each pass.
Out:    ``PartClearance`` for shank and holder; a tool that comes into the stock is refused.
Units:  mm. All is turned about Z: places are radius and height, and the tool axis is in their plane.

What is no wider than the cutter goes where the cutter has been: passes go down, and flutes are longer than a turn is
deep. So only what is wider counts, against the stock before the pass.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final, TypeAlias

import numpy as np

from trunnion.arrays import Flags, Floats, distinct
from trunnion.errors import InputError, Problem
from trunnion.extras import import_extra
from trunnion.impeller.definition import ImpellerDefinition
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.paths.least_clearances import PartClearance
from trunnion.impeller.paths.passes import Pass
from trunnion.impeller.paths.shroud import shroud_form
from trunnion.impeller.steps import MachiningStep, StepKind
from trunnion.messages import Wording
from trunnion.simulation.tools.profile import Role, ToolShape

#: Outlines of tool and stock (n, 2): radius and height. A stock's goes from the axis along its top, and down its side.
Outline: TypeAlias = Floats

#: Points of outlines are so far apart at most, mm; distances are told less than they are by as much.
_SPACING: Final = 0.25

#: Poses of a pass that are looked at, and places round the tool where its axis is tilted.
_POSES: Final = 300
_ROUND: Final = 25

#: Farther away is not told, mm.
_FAR: Final = 10.0

#: A part that is wider than the cutter by less is as wide as it, mm.
_SAME: Final = 1e-6


def stock_clearances(
    tool: ToolShape, radius: float, narrowest: float, passes: Sequence[tuple[Pass, Floats]],
    before: Callable[[Pass], Outline],
) -> tuple[PartClearance, ...]:  # fmt: skip
    """Shank and holder of a tool against the stock; those that are 10 mm away or more are left out.

    radius     from the points of passes, which are the centres of balls, to the tips; 0 where they are tips
    narrowest  radius of parts that count; those that are narrower do not
    passes     with their tool axes, (n, 3)
    before     the stock before a pass

    Raises ``InputError`` if a part comes into the stock, or nearer to it than is told apart.
    """
    nearest: dict[Role, tuple[float, Floats, Floats]] = {}
    outlines = list(_outlines(tool, radius, narrowest))
    for one, axes in passes:
        stock = before(one)
        tree = import_extra("scipy.spatial", "impeller").cKDTree(stock)
        rows = distinct(np.linspace(0, len(one) - 1, _POSES).astype(int))
        for role, outline in outlines:
            off = _distances(one.centre[rows], axes[rows], outline, stock, tree).min(axis=1)
            k = int(off.argmin())
            if role not in nearest or off[k] < nearest[role][0]:
                nearest[role] = float(off[k]), one.centre[rows[k]], axes[rows[k]]
    problems = [
        Problem(tool.name, 0, _into(role, off, centre - radius * axis))
        for role, (off, centre, axis) in nearest.items()
        if off <= 0.0
    ]
    if problems:
        raise InputError(problems)
    return tuple(
        PartClearance(role, "the stock", off, _triple(centre), _triple(axis))
        for role, (off, centre, axis) in nearest.items()
        if off < _FAR
    )


def stock_before(impeller: Impeller, step: MachiningStep, width: float) -> Callable[[Pass], Outline]:
    """Return the stock before a pass of a step; ``width`` is what one pass of stock roughing takes across."""
    definition = impeller.definition
    stock = definition.stock
    outside, ends = stock.diameter / 2.0, np.array([stock.top, stock.bottom])
    if step.kind is StepKind.STOCK_ROUGHING:
        return lambda one: _dense(np.column_stack((np.full(2, outside - width * one.layer), ends)))
    rough = rough_before(definition, step)
    if not is_roughed(definition, step):
        side = np.column_stack((np.full(2, outside), ends))
    else:
        allowance, step_down = (rough.allowance, rough.step_down) if rough else (0.0, 0.0)
        heights, form = shroud_form(impeller, allowance)
        limit = np.maximum.accumulate(form[::-1])[::-1]
        # A flat mill leaves at a height what its end has left by one turn below.
        turned = np.interp(heights - step_down, heights, limit)
        side = np.column_stack((np.minimum(turned, outside), heights))[::-1]
    outline = _dense(side)
    return lambda _: outline


def is_roughed(definition: ImpellerDefinition, step: MachiningStep) -> bool:
    """Whether the stock has the form of the shroud before a step: by stock roughing, here or elsewhere."""
    return StepKind.STOCK_ROUGHING in definition.premachined or rough_before(definition, step) is not None


def rough_before(definition: ImpellerDefinition, step: MachiningStep) -> MachiningStep | None:
    """Return the last stock roughing before a step; None: there is none."""
    earlier = definition.steps[: definition.steps.index(step)]
    return next((one for one in reversed(earlier) if one.kind is StepKind.STOCK_ROUGHING), None)


def _into(role: Role, off: float, tip: Floats) -> Wording:
    """Return what is wrong where a part comes into the stock."""
    at: dict[str, object] = {"radius": np.hypot(tip[0], tip[1]), "height": tip[2]}
    if off < -_SPACING:
        return Wording("IMP323", "shank_in_stock" if role is Role.SHANK else "holder_in_stock", depth=-off, **at)
    return Wording("IMP323", "shank_at_stock" if role is Role.SHANK else "holder_at_stock", spacing=_SPACING, **at)


def _dense(side: Floats) -> Outline:
    """Return the outline of a stock from the points of its side, (n, 2), from the top down."""
    return filled(np.vstack(([[0.0, side[0, 1]]], side)))


def filled(points: Floats) -> Floats:
    """Points (n, 2) with others between them, so that none are farther apart than ``_SPACING``."""
    counts = np.ceil(np.linalg.norm(np.diff(points, axis=0), axis=1) / _SPACING).astype(int)
    parts = [
        a + (b - a) * np.arange(count)[:, None] / count
        for a, b, count in zip(points[:-1], points[1:], counts.tolist(), strict=True)
        if count
    ]
    return np.vstack((*parts, points[-1:]))


def _outlines(tool: ToolShape, radius: float, narrowest: float) -> Iterator[tuple[Role, Outline]]:
    """Shank and holder: points of their outlines, with heights from those of passes."""
    for section in tool.sections:
        if section.role is Role.CUTTER:
            continue
        corners = [(0.0, section.bottom), *(point for one in section.outline for point in (one.start, one.end))]
        points = filled(np.array([*corners, (0.0, section.top)]) - [0.0, radius])
        points = points[points[:, 0] > narrowest + _SAME]
        if len(points):
            yield section.role, points


def _distances(centre: Floats, axis: Floats, tool: Outline, stock: Outline, tree: Any) -> Floats:
    """Distances (n, k) of points round a tool to the stock, less what points are apart; below 0: in it."""
    across = np.hypot(centre[:, 0], centre[:, 1])
    lean = np.einsum("ij,ij->i", axis[:, :2], centre[:, :2]) / np.maximum(across, 1e-12)
    count = 1 if np.abs(lean).max(initial=0.0) < _SAME else _ROUND
    turn = np.linspace(0.0, np.pi, count)[None, None, :]
    wide, up = tool[None, :, :1], tool[None, :, 1:]
    s, c = lean[:, None, None], axis[:, 2, None, None]
    inward = across[:, None, None] + up * s - wide * np.cos(turn) * c
    height = centre[:, 2, None, None] + up * c + wide * np.cos(turn) * s
    points = np.stack((np.hypot(inward, wide * np.sin(turn)), height), axis=-1)
    points = points.reshape(-1, 2)
    off = tree.query(points)[0]
    inside = _is_inside(points, stock)
    found = np.where(inside, -off, off) - _SPACING
    return np.asarray(found.reshape(len(centre), -1))


def _is_inside(points: Floats, stock: Outline) -> Flags:
    """Whether points (n, 2) are in the stock."""
    side = stock[stock[:, 1].argmax() + int((stock[:, 1] == stock[:, 1].max()).sum()) - 1 :][::-1]
    low, high = side[[0, -1], 1]
    within = (points[:, 1] >= low) & (points[:, 1] <= high)
    return np.asarray(within & (points[:, 0] <= np.interp(points[:, 1], side[:, 1], side[:, 0])))


def _triple(values: Floats) -> tuple[float, float, float]:
    x, y, z = values.tolist()
    return x, y, z
