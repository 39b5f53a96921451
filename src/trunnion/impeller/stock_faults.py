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
from trunnion.messages import Wording

#: Points may stand out of the stock by as much: tables are rounded.
_ROUNDED: Final = 0.1

#: A blade that reaches a smaller part of the stock's radius is in another unit.
_LEAST_PART: Final = 0.2

#: The stock's diameter may cut off so much of a blade without a word, as a part of the diameter.
_CUT_OFF: Final = 0.01


def stock_faults(definition: ImpellerDefinition, hub: Profile) -> Iterator[Problem]:
    """Yield what of the measured blades does not fit into the stock; a warning where its diameter only
    shortens them.
    """
    stock, tables = definition.stock, definition.sections
    radius = stock.diameter / 2.0
    points = np.vstack([table.points for table in tables])
    across, up = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    if across.max() < _LEAST_PART * radius:
        yield definition.problem(
            "blade.scale", Wording("IMP215", "blade_reaches_radius", max=across.max(), radius=radius)
        )
        return
    starts = np.cumsum([0, *(len(table.points) for table in tables[:-1])])
    yield from _across(definition, across, starts)
    heights = np.where(across <= radius + _ROUNDED, up, np.nan)
    if np.isnan(heights).all():
        return
    high, low = int(np.nanargmax(heights)), int(np.nanargmin(heights))
    if up[high] > stock.top + _ROUNDED:
        yield _problem(tables, high, Wording("IMP215", "reaches_height_here", up=up[high], top=stock.top))
    if up[low] < stock.bottom - _ROUNDED:
        yield _problem(tables, low, Wording("IMP215", "reaches_down_height", up=up[low], bottom=stock.bottom))
    yield from _bore(definition, hub)


def _across(definition: ImpellerDefinition, across: Floats, starts: Ints) -> Iterator[Problem]:
    """Points outside of the stock's diameter: a trailing edge that is cut may have them, a leading edge not."""
    stock, tables = definition.stock, definition.sections
    limit = stock.diameter / 2.0 + _ROUNDED
    if definition.trailing_edge == "cut":
        for k in starts[across[starts] > limit].tolist():
            yield _problem(tables, k, Wording("IMP215", "begins_radius_mm", across=across[k], diameter=stock.diameter))
            return
        k = int(across.argmax())
        if across[k] > stock.diameter / 2.0 + _CUT_OFF * stock.diameter:
            yield _problem(
                tables,
                k,
                Wording("IMP215", "goes_radius_mm", across=across[k], diameter=stock.diameter),
                severity=Severity.WARNING,
            )
    elif across.max() > limit:
        k = int(across.argmax())
        yield _problem(tables, k, Wording("IMP215", "reaches_radius_mm", across=across[k], diameter=stock.diameter))


def _bore(definition: ImpellerDefinition, hub: Profile) -> Iterator[Problem]:
    """Yield a bore that cuts the hub's surface, and with it the roots of the blades."""
    place = hub.curve.points(np.linspace(0.0, 1.0, 801))
    k = int(place[:, 0].argmin())
    if definition.stock.bore / 2.0 >= place[k, 0]:
        yield definition.problem(
            "stock.bore_mm",
            Wording(
                "IMP215", "stock_bore_mm", bore=definition.stock.bore, diameter=2.0 * place[k, 0], height=place[k, 2]
            ),
        )


def _problem(tables: tuple[PointTable, ...], k: int, wording: Wording, severity: Severity = Severity.ERROR) -> Problem:
    """Return a problem with a point of all tables together."""
    for table in tables:
        if k < len(table.points):
            return Problem(table.file, table.lines[k], wording.within("of_key", key=table.called), severity=severity)
        k -= len(table.points)
    raise IndexError(k)
