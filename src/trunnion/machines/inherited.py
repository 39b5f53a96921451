"""What a definition has from another machine: measured values of the one that it extends, which is no measurement.

In:     the table of a definition, merged with those that it extends.
Out:    such values, each with its place.

A machine is that of the file that gives it its name. What files below say, that this one extends, is of another
machine; a file without a name changes the machine of the file that it extends. No file of one's own changes a shipped
machine: with a name or without, what a shipped definition says was measured elsewhere. Shipped definitions that extend
others are settled.
"""

from collections.abc import Iterator
from typing import Final

from trunnion.definitions import Table
from trunnion.definitions.marked_values import MarkedValue

#: Keys of axes that no two machines of a type share for certain.
_OF_AXES: Final = (
    "point_mm", "limits_mm", "limits_deg", "endless", "output", "positive", "home_mm", "home_deg", "rapid_mm_min",
    "rapid_deg_min", "acceleration_mm_s2", "acceleration_deg_s2",
)  # fmt: skip

#: Such keys of other tables.
_OF_TABLES: Final = (("spindle", "gauge_point_mm"), ("spindle", "max_rpm"), ("workpiece", "zero_mm"))


def inherited_values(table: Table, library: str) -> Iterator[MarkedValue]:
    """Yield the measured values that a definition has from another machine, of bodies their shapes.

    library  the folder of shipped definitions
    """
    others, own = _others(table, library), table.unread_copy()
    if not others:
        return
    for name, key in _OF_TABLES:
        yield from _inherited(own.table(name), key, name, others)
    for axis in own.tables("axis"):
        for key in _OF_AXES:
            yield from _inherited(axis, key, "axis", others)
    for body in own.tables("body"):
        yield from _inherited(body, "shape", "body", others)


def _others(table: Table, library: str) -> frozenset[str]:
    """Return the files of other machines: those below the one of one's own that gives the machine its name, and
    shipped ones.
    """
    named, _ = table.location("name")
    if named not in table.sources or table.sources[0].startswith(library):
        return frozenset()
    shipped = {file for file in table.sources if file.startswith(library)}
    return frozenset(shipped.union(() if named in shipped else table.sources[table.sources.index(named) + 1 :]))


def _inherited(part: Table, key: str, table: str, others: frozenset[str]) -> Iterator[MarkedValue]:
    """Yield a value that another machine's file says."""
    if key not in part:
        return
    file, line = part.location(key)
    if file in others:
        name = part.to_dict().get("name", table)
        yield MarkedValue(f"{name} {key}", file, line, "", table)
