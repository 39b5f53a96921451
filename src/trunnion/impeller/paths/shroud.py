"""The form of the shroud, turned by milling: a helix round Z that goes down along it.

In:     an impeller, the tool and step-overs.
Out:    passes with their tool axes: the tool axis is in the plane of Z and the tool, tilted outward by a fixed angle.
Units:  mm, degrees.

Roughing is with the end of a flat mill, one turn below the other; finishing with a ball that touches the form.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.paths.passes import Pass, Stepover
from trunnion.messages import Wording
from trunnion.records import dataclass

#: Heights at which the form is looked at, per mm of it.
_PER_MM: Final = 20.0

#: Rounds in which the side of a tool is kept out of the form.
_ROUNDS: Final = 60

#: A step has no more points.
_MOST_POINTS: Final = 5_000_000


@dataclass(frozen=True, slots=True, eq=False)
class TurnedPasses:
    """Passes round Z, and the tool axes of their points, (n, 3) each.

    left  how much more than wanted stays on the form at most, where the side of the tool would have cut into it
    """

    passes: tuple[Pass, ...]
    axes: tuple[Floats, ...]
    left: float = 0.0


def stock_roughing(
    impeller: Impeller, radius: float, step_down: float, widest: float, allowance: float, tolerance: float
) -> TurnedPasses:
    """Return a helix of a flat mill of a radius, tool axis Z: ball centres are its tips.

    radius     of the mill
    step_down  by which a turn is below the one before
    widest     that one turn may cut across; where more stands, helices follow each other from outside
    allowance  that stays on the form of the shroud
    tolerance  of chords

    Raises ``InputError`` if the stock has nothing outside of the shroud, or the helices have too many points.
    """
    stock = impeller.definition.stock
    heights, form = shroud_form(impeller, allowance)
    limit = np.maximum.accumulate(form[::-1])[::-1]  # the mill stands in all that is above its tip
    outside = stock.diameter / 2.0
    stands = limit < outside
    if not stands.any():
        raise InputError(Problem(impeller.definition.file, 0, Wording("IMP327", "no_stock_stands")))
    lowest, top = float(heights[stands].min()), stock.top
    count = max(1, math.ceil((outside - float(limit[stands].min())) / widest - 1e-9))
    _check_count(count * ((top - lowest) / step_down + 2.0), outside + radius, tolerance)
    passes = []
    for k in range(count):
        inner = outside - widest * (k + 1)
        end = float(heights[stands & (np.maximum(limit, inner) < outside - widest * k)].min(initial=top))
        if end >= top:
            continue
        turns = max(1, math.ceil((top - end) / step_down - 1e-9))
        angle = _angles(outside + radius, turns + 1.0, tolerance)
        z = np.maximum(top - (top - end) * angle / (2.0 * math.pi * turns), end)
        around = np.maximum(np.interp(z, heights, limit), inner) + radius
        passes.append(_helix(around, z, angle, np.zeros(len(z)), np.ones(len(z)), layer=k))
    axes = tuple(np.tile([0.0, 0.0, 1.0], (len(one), 1)) for one in passes)
    if lowest > stock.top - 1e-9 or not passes:
        raise InputError(Problem(impeller.definition.file, 0, Wording("IMP327", "no_stock_stands")))
    return TurnedPasses(tuple(passes), axes)


def shroud_finish(
    impeller: Impeller, radius: float, stepover: Stepover, tilt: float, allowance: float, tolerance: float
) -> TurnedPasses:
    """Return a helix of a ball down the form of the shroud.

    radius     of the ball, and of the tool above it
    stepover   of one turn to the next, on the form
    tilt       of the tool axis, outward, degrees: 0 is a three-axis helix, 90 a turning tool's
    allowance  that stays on the form
    tolerance  of chords
    """
    stock = impeller.definition.stock
    heights, form = shroud_form(impeller)
    inside = form < stock.diameter / 2.0
    lowest = float(heights[inside].min())
    z = np.linspace(stock.top + radius, lowest, max(2, math.ceil((stock.top + radius - lowest) * _PER_MM)))
    r = np.interp(z, heights, form)
    slope_r, slope_z = np.gradient(r), np.gradient(z)
    size = np.hypot(slope_r, slope_z)
    normal = np.column_stack((-slope_z, slope_r)) / size[:, None]  # outward: to greater radii
    reach = radius + allowance
    centre = np.column_stack((r, z)) + reach * normal
    lean = np.array([math.sin(math.radians(tilt)), math.cos(math.radians(tilt))])
    kept = _kept_out(centre, lean, np.column_stack((form[inside], heights[inside])), reach)
    left = float(np.einsum("ij,ij->i", kept - centre, normal).max())
    way = np.r_[0.0, np.cumsum(size[1:])]
    bends = np.linalg.norm(np.diff(normal, axis=0), axis=1) / np.maximum(np.diff(way), 1e-12)
    convex = np.einsum("ij,ij->i", np.diff(normal, axis=0), np.diff(np.column_stack((r, z)), axis=0)) > 0.0
    pitch = stepover.on(radius, float((bends * convex).max(initial=0.0)))
    turns = max(1, math.ceil(way[-1] / pitch - 1e-9))
    _check_count(turns + 2.0, float(kept[:, 0].max()), tolerance)
    angle = _angles(float(kept[:, 0].max()), turns + 2.0, tolerance)
    at = np.clip(angle / (2.0 * math.pi) - 1.0, 0.0, turns) / turns * way[-1]  # a whole turn at either end
    r_at, z_at = (np.interp(at, way, kept[:, k]) for k in (0, 1))
    normal_r, normal_z = (np.interp(at, way, normal[:, k]) for k in (0, 1))
    helix = _helix(r_at, z_at, angle, normal_z, normal_r)
    axis = np.column_stack((lean[0] * np.cos(angle), -lean[0] * np.sin(angle), np.full(len(angle), lean[1])))
    return TurnedPasses((helix,), (axis,), max(left, 0.0))


def shroud_form(impeller: Impeller, allowance: float = 0.0) -> tuple[Floats, Floats]:
    """Heights within the stock, from below to above, and the radius of the shroud there, with an allowance on it."""
    definition, stock = impeller.definition, impeller.definition.stock
    outline = impeller.shroud.outline(1e-4, 2.0 * (stock.height + stock.diameter))
    falls = np.diff(outline[:, 1])
    if (falls > 1e-9).any():
        z = float(outline[int(np.argmax(falls > 1e-9)), 1])
        raise InputError(Problem(definition.file, 0, Wording("IMP327", "shroud_rises_towards", z=z)))
    along = np.gradient(outline, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    outline = outline + allowance * np.column_stack((-along[:, 1], along[:, 0]))
    heights = np.linspace(stock.bottom, stock.top, math.ceil(stock.height * _PER_MM) + 1)
    return heights, np.interp(heights, outline[::-1, 1], outline[::-1, 0])


def _kept_out(centre: Floats, lean: Floats, form: Floats, reach: float) -> Floats:
    """Centres (k, 2) moved outward until the side of the tool, from the ball up, is ``reach`` from all of the form."""
    found = centre.copy()
    across = np.array([lean[1], -lean[0]])  # outward of the axis
    for _ in range(_ROUNDS):
        moved = 0.0
        for k in range(len(found)):
            away = form - found[k]
            up = away @ lean
            beside = away @ across
            inside = np.where(up >= 0.0, beside + reach, reach - np.hypot(away[:, 0], away[:, 1]))
            most = float(inside.max())
            if most > 1e-9:
                found[k, 0] += most / max(float(across[0]), 0.1)
                moved = max(moved, most)
        if moved <= 1e-9:
            break
    return found


def _check_count(turns: float, radius: float, tolerance: float) -> None:
    """Raise ``InputError`` for turns of more points than there is memory for."""
    count = turns * len(_angles(radius, 1.0, tolerance))
    if count > _MOST_POINTS:
        most = _MOST_POINTS / 1e6
        raise InputError(
            Problem("", 0, Wording("IMP328", "turns_have_million", turns=turns, count=count / 1000000.0, most=most))
        )


def _angles(radius: float, turns: float, tolerance: float) -> Floats:
    """Angles (n,) of a helix, radians, whose chords are within a tolerance on a circle of a radius."""
    step = 2.0 * math.acos(max(1.0 - tolerance / radius, -1.0))
    return np.linspace(0.0, 2.0 * math.pi * turns, math.ceil(2.0 * math.pi * turns / step) + 1)


def _helix(around: Floats, z: Floats, angle: Floats, up: Floats, out: Floats, layer: int = 0) -> Pass:
    """Return a pass clockwise round Z, seen from above: with the part on its right, a tool that turns
    clockwise climbs.
    """
    cosine, sine = np.cos(angle), -np.sin(angle)
    centre = np.column_stack((around * cosine, around * sine, z))
    normal = np.column_stack((out * cosine, out * sine, up))
    return Pass(centre, normal, (angle / angle[-1])[:, None], layer)
