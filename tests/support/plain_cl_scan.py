"""What a CL file says of points, arcs, holes, tools and extents, counted with a few lines of text."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from trunnion.model.toolpath import CycleOff, CycleOn, Kind, LoadTool, Operation, Toolpath

_NUMBER = re.compile(r"[-+]?[0-9]*\.?[0-9]+")


def plain_scan(path: Path) -> dict[str, Any]:
    """Count the statements of a CL file in any of the dialects; its extents in mm.

    Of splines, whose points are not in the file, it gives neither points nor extents.
    """
    text = re.sub(r"\$[ \t]*\r?\n", " ", path.read_text(encoding="latin-1"))
    points: list[list[float]] = []
    loaded: list[int] = []
    arcs, holes, is_hole = 0, 0, False
    for line in text.splitlines():
        word = re.sub(r"\s", "", line.partition("/")[0]).upper()
        rest = line.partition("/")[2]
        if word == "GOTO" or (word == "GOHOME" and rest):
            points.append([float(number) for number in _NUMBER.findall(rest)[:3]])
            holes += is_hole and word == "GOTO"
        elif word == "CIRCLE":
            arcs += 1
        elif word in ("GOFWD", "TLON,GOFWD"):
            arcs += 1
            points.append([float(number) for number in _NUMBER.findall(rest)[-3:]])
        elif word == "CYCLE":
            is_hole = not re.match(r"\s*(OFF|INIT|CLEAR|ON)", rest)
        elif word in ("LOAD", "LOADTL"):
            number = int(_NUMBER.findall(rest)[0])
            if loaded[-1:] != [number]:
                loaded.append(number)
    found: dict[str, Any] = {"points": len(points), "arcs": arcs, "holes": holes, "tools": loaded}
    if re.search(r"^ *NURBS", text, re.MULTILINE):
        return found | {"points": None, "extents": None}
    unit = 25.4 if re.search(r"^ *UNITS? */ *(INCH|IN)", text, re.MULTILINE) else 1.0
    mm = np.array(points) * unit
    return found | {"extents": (mm.min(axis=0).tolist(), mm.max(axis=0).tolist()) if points else None}


def counts_of(toolpath: Toolpath) -> dict[str, Any]:
    """The same of what was read."""
    tip = np.concatenate([operation.moves.tip for operation in toolpath.operations])
    loaded: list[int] = []
    for operation in toolpath.operations:
        for event in operation.events:
            if isinstance(event, LoadTool) and loaded[-1:] != [event.number]:
                loaded.append(event.number)
    return {
        "points": len(tip),
        "arcs": sum(len(operation.arcs.row) for operation in toolpath.operations),
        "holes": sum(_hole_rows(operation) for operation in toolpath.operations),
        "tools": loaded,
        "extents": (tip.min(axis=0).tolist(), tip.max(axis=0).tolist()),
    }


def _hole_rows(operation: Operation) -> int:
    """Rows of an operation that are holes."""
    count, row, is_hole = 0, 0, False
    for event in [*operation.events, CycleOff(len(operation.moves), 0)]:
        if isinstance(event, CycleOn | CycleOff):
            count += is_hole * int((operation.moves.kind[row : event.row] != Kind.RAPID).sum())
            row, is_hole = event.row, isinstance(event, CycleOn)
    return count
