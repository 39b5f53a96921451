"""Shank and holder near the stock, as it is then: bodies that stand out farther all around meet it.

In:     the body of a tool and a distance; what its pieces have met in rows of a run.
Out:    the pieces of the tool with thicker ones around shank and holder; near misses as ``Finding`` records.
Units:  mm, frame of the tool.

A section that stands out by d meets what is nearer than d. Several thicknesses, one in the other, say between which two
of them the stock is, and how deep the thinner one that meets it is in it says how near it is.

A shank that is as thick as its cutter, or thicker, rubs along a wall that stands higher than the flutes: what the
cutter has taken there in an earlier pass is as wide as the shank, so that nothing is met. That is always told.
"""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.run import Run
from trunnion.simulation.cutting.measurements import RowsCut
from trunnion.simulation.finding import Finding, What
from trunnion.simulation.findings import rows_together, tool_name
from trunnion.simulation.tools.pieces import RevolvedPieces, revolved_pieces
from trunnion.simulation.tools.profile import Point, ProfileArc, ProfileLine, Role, Section, ToolShape, cutting_width

#: Thicknesses of a section.
_LEVELS: Final = 4

#: A shank rubs where a section that stands out by so many tolerances is more than half of that in the stock.
_RUBS: Final = 4.0

#: A shank that is thinner by less than this, mm, is as thick as its cutter.
_AS_THICK: Final = 1e-3

#: Chords of a round element, and of a quarter circle around a corner.
_CHORDS: Final = 8
_CORNER: Final = 3


def pieces_with_near(shape: ToolShape, near: float, tolerance: float, facets: float) -> tuple[RevolvedPieces, float]:
    """Return what ``revolved_pieces`` does, with thicker sections around shank and holder.

    ``tolerance`` is how far motions may be off, ``facets`` that of ``revolved_pieces``. The number of a thicker section
    in ``RevolvedPieces.section`` is ``len(shape.sections) + section`` where it shows that a shank rubs, and
    ``2 * len(shape.sections) + _LEVELS * section + level`` of those that show how near it is.
    """
    thicker, numbers = list[Section](), list[int]()
    count = len(shape.sections)
    for number, section in enumerate(shape.sections):
        if section.role is Role.CUTTER:
            continue
        rubbing = list(_rubbing(shape, section, _RUBS * tolerance)) if section.role is Role.SHANK else []
        thicker += rubbing
        numbers += [count + number] * len(rubbing)
        for level in range(_LEVELS if near > 0.0 else 0):
            for low, high in _lines(section):
                thicker.append(Section(section.role, _around(low, high, near * (level + 1) / _LEVELS), section.name))
                numbers.append(2 * count + _LEVELS * number + level)
    whole = ToolShape((*shape.sections, *thicker), shape.name)
    pieces, error = revolved_pieces(whole, facets)
    owners = np.array([*range(count), *numbers], np.int64)[pieces.section]
    owners.setflags(write=False)
    return pieces._replace(section=owners), error


def _rubbing(shape: ToolShape, section: Section, distance: float) -> Iterator[Section]:
    """Yield what is around a shank where it is as thick as the cutter, from a distance above the flutes on."""
    cutters = [each for each in shape.sections if each.role is Role.CUTTER]
    radius = 0.5 * cutting_width(shape) - _AS_THICK
    lowest = max((each.top for each in cutters), default=0.0) + distance
    for low, high in _lines(section):
        if min(low[0], high[0]) < radius or high[1] <= lowest:
            continue
        share = max(lowest - low[1], 0.0) / (high[1] - low[1])
        start = low[0] + share * (high[0] - low[0]) + distance, max(low[1], lowest)
        yield Section(section.role, (ProfileLine(start, (high[0] + distance, high[1])),), section.name)


def _lines(section: Section) -> Iterator[tuple[Point, Point]]:
    """Yield the outline of a section as lines that go up."""
    for element in section.outline:
        points = [element.start, element.end]
        if isinstance(element, ProfileArc):
            heights = np.linspace(element.start[1], element.end[1], _CHORDS + 1).tolist()
            points = [(element.radius_at(z), z) for z in heights]
        yield from ((low, high) for low, high in pairwise(points) if high[1] - low[1] > 1e-9)


def _around(low: Point, high: Point, distance: float) -> tuple[ProfileLine, ...]:
    """Return the outline of what is no farther than a distance from a frustum."""
    lean = math.atan2(low[0] - high[0], high[1] - low[1])  # of the normal, from level
    angles = [
        (low, np.linspace(-0.5 * math.pi, lean, _CORNER + 1)),
        (high, np.linspace(lean, 0.5 * math.pi, _CORNER + 1)),
    ]
    points = [
        (centre[0] + distance * max(math.cos(angle), 0.0), centre[1] + distance * math.sin(angle))
        for centre, around in angles
        for angle in around.tolist()
    ]
    return tuple(ProfileLine(one, other) for one, other in pairwise(points) if other[1] - one[1] > 1e-9)


def near_findings(run: Run, rows: RowsCut, shape: ToolShape, near: float, tolerance: float) -> Iterator[Finding]:
    """Yield where shank and holder come nearer to the stock than ``near`` mm, or rub along it, and do not meet it.

    ``depth`` of these findings is how far they are apart, 0 where they rub; what is met no deeper than ``tolerance`` mm
    is not met.
    """
    for number, section in enumerate(shape.sections):
        if section.role is Role.CUTTER or number not in rows.met:
            continue
        apart, place = _distance(rows, 2 * len(shape.sections) + _LEVELS * number, near, tolerance)
        met = rows.met[number].depth
        apart[met > tolerance] = np.inf
        around = rows.met.get(len(shape.sections) + number)
        if around is not None:
            rubs = (around.depth > 0.5 * _RUBS * tolerance) & (met <= 2.0 * tolerance)
            apart[rubs], place[rubs] = 0.0, around.place[rubs]
        body = f"{section.role} of {tool_name(run, rows.tool)}"
        for part in rows_together(np.isfinite(apart)):
            worst = int(part[apart[part].argmin()])
            x, y, z = place[worst].tolist()
            first, last = int(part[0]) + rows.first, int(part[-1]) + rows.first
            yield Finding(What.NEAR, (body, "stock"), (first, last), worst + rows.first, float(apart[worst]), (x, y, z))


def _distance(rows: RowsCut, first: int, near: float, limit: float) -> tuple[Floats, Floats]:
    """How far a section is from the stock in each row, and where; infinite where it is farther than ``near``."""
    apart, place = np.full(len(rows.removed), np.inf), np.full((len(rows.removed), 3), np.nan)
    for level in reversed(range(_LEVELS)):
        if first + level not in rows.met:
            continue
        met, reach = rows.met[first + level], near * (level + 1) / _LEVELS
        hit = met.depth > limit
        apart[hit] = np.clip(reach - met.depth[hit], reach - near / _LEVELS, reach)
        place[hit] = met.place[hit]
    return apart, place
