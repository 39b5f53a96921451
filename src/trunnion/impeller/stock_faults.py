"""A stock that the impeller does not fit into: blades that stand out of it, and a bore that is wider than the hub.

In:     ``ImpellerDefinition`` and its hub.
Out:    problems, with the rows of the points or the line of the stock's size.
Units:  mm.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import Problem, Severity
from trunnion.geometry.point_tables import PointTable
from trunnion.impeller.definition import ImpellerDefinition
from trunnion.impeller.profiles import Profile

#: Points may stand out of the stock by as much: tables are rounded.
_ROUNDED: Final = 0.1

#: A blade that reaches a smaller part of the stock's radius is in another unit.
_LEAST_PART: Final = 0.2

#: The stock's diameter may cut off so much of a blade without a word, as a part of the diameter.
_CUT_OFF: Final = 0.01

_SIZES: Final = "check stock.height_mm, stock.bottom_mm and blade.scale"


def stock_faults(definition: ImpellerDefinition, hub: Profile) -> Iterator[Problem]:
    """What of the measured blades does not fit into the stock; a warning where its diameter only shortens them."""
    stock, tables = definition.stock, definition.sections
    radius = stock.diameter / 2.0
    points = np.vstack([table.points for table in tables])
    across, up = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    if across.max() < _LEAST_PART * radius:
        what = f"the blade reaches a radius of {across.max():.4g} mm only, and that of the stock is {radius:g}"
        cure = "check blade.scale, the unit of the points and stock.diameter_mm"
        yield definition.problem("blade.scale", what, cure, code="IMP215")
        return
    starts = np.cumsum([0, *(len(table.points) for table in tables[:-1])])
    yield from _across(definition, across, starts)
    heights = np.where(across <= radius + _ROUNDED, up, np.nan)
    if np.isnan(heights).all():
        return
    high, low = int(np.nanargmax(heights)), int(np.nanargmin(heights))
    if up[high] > stock.top + _ROUNDED:
        what = f"reaches height {up[high]:.3f} here, and the stock ends at {stock.top:g}"
        yield _problem(tables, high, what, _SIZES)
    if up[low] < stock.bottom - _ROUNDED:
        what = f"reaches down to height {up[low]:.3f} here, and the stock begins at {stock.bottom:g}"
        yield _problem(tables, low, what, _SIZES)
    yield from _bore(definition, hub)


def _across(definition: ImpellerDefinition, across: Floats, starts: Ints) -> Iterator[Problem]:
    """Points outside of the stock's diameter: a trailing edge that is cut may have them, a leading edge not."""
    stock, tables = definition.stock, definition.sections
    limit = stock.diameter / 2.0 + _ROUNDED
    cure = "check stock.diameter_mm and blade.scale"
    outside = f"outside of the stock of {stock.diameter:g} mm in diameter"
    if definition.trailing_edge == "cut":
        for k in starts[across[starts] > limit].tolist():
            yield _problem(tables, k, f"begins at a radius of {across[k]:.3f} mm, {outside}", cure)
            return
        k = int(across.argmax())
        if across[k] > stock.diameter / 2.0 + _CUT_OFF * stock.diameter:
            what = f"goes on to a radius of {across[k]:.3f} mm here, {outside}, which cuts the blade off"
            yield _problem(tables, k, what, cure, Severity.WARNING)
    elif across.max() > limit:
        k = int(across.argmax())
        yield _problem(tables, k, f"reaches a radius of {across[k]:.3f} mm here, {outside}", cure)


def _bore(definition: ImpellerDefinition, hub: Profile) -> Iterator[Problem]:
    """A bore that cuts the hub's surface, and with it the roots of the blades."""
    place = hub.curve.points(np.linspace(0.0, 1.0, 801))
    k = int(place[:, 0].argmin())
    if definition.stock.bore / 2.0 >= place[k, 0]:
        what = f"is {definition.stock.bore:g}, and the hub is {2.0 * place[k, 0]:.3f} mm in diameter at height"
        yield definition.problem(
            "stock.bore_mm", f"stock.bore_mm {what} {place[k, 2]:.3f}", "make the bore smaller", code="IMP215"
        )


def _problem(
    tables: tuple[PointTable, ...], k: int, what: str, cure: str, severity: Severity = Severity.ERROR
) -> Problem:
    """A problem with a point of all tables together."""
    for table in tables:
        if k < len(table.points):
            return Problem(table.file, table.lines[k], f"{table.called} {what}", cure, severity, code="IMP215")
        k -= len(table.points)
    raise IndexError(k)
