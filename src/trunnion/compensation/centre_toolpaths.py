"""CL files whose points are those of the contour, as the paths of the tool's centre that the control makes of them.

In:     toolpaths, and how the control compensates.
Out:    toolpaths of the centre, in which points under CUTCOM are those of the centre; where that is not known.
Units:  mm.

What a machine reaches and where a part fits stands on where the tool goes, and not on the points that it touches.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.compensation.inserted_rows import Insertion, arcs_with_inserted
from trunnion.compensation.notices import fault_notice, unknown_corners, unknown_radius
from trunnion.compensation.offsets import Fault
from trunnion.compensation.plane_insertions import PlaneMotions, plane_insertion
from trunnion.compensation.styles import STYLES, WIDEST, CompensationStyle
from trunnion.errors import Problem, Severity
from trunnion.model.splines import Splines
from trunnion.model.toolpath import CutterComp, Kind, Operation, Toolpath
from trunnion.records import dataclass

#: The axis perpendicular to each plane of CUTCOM; without one the control works in XY.
_NORMALS: Final = {"": 2, "XYPLAN": 2, "ZXPLAN": 1, "YZPLAN": 0}

#: A direction along an axis may be off it by so much, as the sine of the angle.
_ASKEW: Final = 1e-3


@dataclass(frozen=True, slots=True)
class _Stretch:
    """Rows ``first`` to ``end`` behind a CUTCOM whose points are those of the contour; ``side`` 1 left, -1 right."""

    first: int
    end: int
    side: int
    event: CutterComp


def toolpaths_of_centre(toolpaths: Iterable[Toolpath], style: int) -> tuple[list[Toolpath], list[Problem]]:
    """Return CL files as the paths of the tool's centre; those without points of a contour stay as they are.

    style  how the control compensates, a key of ``STYLES``. Where that is not known, corners are taken for the widest
           that are known, and a warning says so
    """
    found, problems = list[Toolpath](), list[Problem]()
    for toolpath in toolpaths:
        operations = [_operation_of_centre(each, toolpath.file, style, problems) for each in toolpath.operations]
        same = all(one is other for one, other in zip(operations, toolpath.operations, strict=True))
        found.append(toolpath if same else replace(toolpath, operations=tuple(operations)))
    return found, problems


def _operation_of_centre(operation: Operation, file: str, style: int, problems: list[Problem]) -> Operation:
    stretches = list(_stretches(operation))
    if not stretches:
        return operation
    file, known = operation.file or file, STYLES.get(style)
    if not operation.tool.diameter:
        problems.append(unknown_radius(file, stretches[0].event.line))
        return operation
    if known is None:
        problems.append(unknown_corners(file, stretches[0].event.line))
    insertions = list[Insertion]()
    for stretch in stretches:
        normal = _normal(operation, stretch)
        if normal is None:
            problems.append(fault_notice(file, stretch.event.line, Fault.UNSURE, Severity.WARNING))
            continue
        insertion, faults = _insertion(operation, stretch, normal, known or WIDEST)
        lines = operation.moves.line
        problems += [fault_notice(file, int(lines[row]), fault, Severity.WARNING) for row, fault in faults]
        if insertion is not None:
            insertions.append(insertion)
    return _with_inserted(operation, insertions) if insertions else operation


def _stretches(operation: Operation) -> Iterator[_Stretch]:
    """Yield where points are those of the contour, each up to the next CUTCOM."""
    events = [event for event in operation.events if isinstance(event, CutterComp)]
    ends = [*(event.row for event in events[1:]), len(operation.moves)]
    side = 0
    for event, end in zip(events, ends, strict=False):
        side = {"LEFT": 1, "RIGHT": -1, "ON": side}.get(event.side, 0)
        if event.contour and side and end > event.row:
            yield _Stretch(event.row, end, side, event)


def _normal(operation: Operation, stretch: _Stretch) -> Floats | None:
    """Return the normal of the plane in which the control compensates, from where left is left; None: there is none.

    It is across the tool. In planes of the coordinate system it points along their axes, in tilted ones to the tool.
    """
    axes = operation.moves.axis[stretch.first : stretch.end]
    normal = axes[0]
    if np.abs(axes - normal).max(initial=0.0) > _ASKEW:
        return None
    along = float(normal[_NORMALS.get(stretch.event.plane, 2)])
    is_plane = abs(along) > 1.0 - _ASKEW**2
    return np.asarray(-normal if is_plane and along < 0.0 else normal)


def _insertion(
    operation: Operation, stretch: _Stretch, normal: Floats, style: CompensationStyle
) -> tuple[Insertion | None, list[tuple[int, Fault]]]:
    moves, first = operation.moves, stretch.first
    rows = np.arange(first, len(moves))
    # Where the tool comes from before its first point is not known here, nor does it matter to where it goes then.
    before = moves.tip[first - 1] if first else _behind(moves.tip, normal)
    tip = np.vstack([before[None], moves.tip[first:]])
    motions = PlaneMotions(rows, tip, moves.kind[rows] == Kind.ARC, operation.arcs, stretch.end)
    return plane_insertion(motions, normal, 0.5 * stretch.side * operation.tool.diameter, style)


def _behind(tip: Floats, normal: Floats) -> Floats:
    """Return a point behind the first one, from which the tool comes on a line."""
    across = np.cross(normal, np.eye(3)[int(np.abs(normal).argmin())])
    return np.asarray(tip[0] - across / np.linalg.norm(across))


def _with_inserted(operation: Operation, insertions: Sequence[Insertion]) -> Operation:
    """Return an operation along the centre, with rows between its rows; lines stand for its splines."""
    moves, n = operation.moves, len(operation.moves)
    before = np.concatenate([each.before for each in insertions])
    count = np.bincount(before, minlength=n)
    take = np.repeat(np.arange(n), count + 1)
    row_of = np.arange(n) + np.cumsum(count)
    first = np.append(row_of - count, len(take))
    added = np.ones(len(take), np.bool_)
    added[row_of] = False
    at = np.flatnonzero(added)
    tip, kind = moves.tip[take].copy(), moves.kind[take].copy()
    for each in insertions:
        tip[row_of[each.rows]] = each.tip
    tip[at] = np.concatenate([each.inserted for each in insertions])
    curved = np.abs(np.concatenate([each.normal for each in insertions])).max(axis=1, initial=0.0) > 0.0
    kind[at] = np.where(curved, Kind.ARC, np.where(kind[at] == Kind.ARC, Kind.LINEAR, kind[at]))
    return replace(
        operation,
        moves=replace(moves.select(take), tip=tip, kind=kind),
        arcs=arcs_with_inserted(operation.arcs, insertions, row_of, at[curved]),
        events=tuple(
            replace(each, row=int(first[each.row]), contour=False)
            if isinstance(each, CutterComp)
            else replace(each, row=int(first[each.row]))
            for each in operation.events
        ),
        splines=Splines.empty(),
    )
