"""What hooks return, checked as strictly as what readers make: events, motion, tools and coordinate systems.

In:     events and operations that a hook has made.
Out:    what is wrong with them, in words for a message; empty if nothing is.
"""

import hashlib
import math
import types
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Final, get_args, get_type_hints

import numpy as np

from trunnion.model.splines import Splines
from trunnion.model.toolpath import Arcs, Event, Frame, Kind, Moves, Operation, Phase, Tool

_TOOL_KINDS: Final = ("MILL", "TCUTTER", "BARREL", "DRILL", "UNKNOWN")

#: Values of a tool that cannot be below 0.
_SIZES: Final = (
    "diameter", "corner_radius", "length", "flute_length", "upper_radius", "extension", "set_length",
)  # fmt: skip

_FARTHEST: Final = 1e6  # mm
_LONGEST_TEXT: Final = 1000


def operation_fault(operation: Operation) -> str:
    """Return what no CL file could state of an operation, its events aside."""
    name, moves = operation.name, operation.moves
    fault = _column_fault(moves) or _arc_fault(moves, operation.arcs)
    if not fault and not (isinstance(name, str) and name and _is_plain(name)):
        fault = "has no name, or one with control characters"
    return fault or _header_fault(operation)


def fingerprint(operation: Operation) -> bytes:
    """Return what tells an operation from another one with any other value; columns may be millions of rows."""
    digest = hashlib.blake2b()
    waiting: list[object] = [operation]
    while waiting:
        value = waiting.pop()
        if isinstance(value, np.ndarray):
            digest.update(f"{value.dtype}{value.shape}".encode())
            digest.update(np.ascontiguousarray(value).tobytes())
        elif is_dataclass(value) and not isinstance(value, type):
            digest.update(f"{type(value).__qualname__}(".encode())
            waiting += [getattr(value, each.name) for each in fields(value)]
        elif isinstance(value, tuple | list):
            digest.update(f"[{len(value)}".encode())
            waiting += value
        else:
            digest.update(f"{value!r}\0".encode("utf-8", "surrogatepass"))
    return digest.digest()


def _header_fault(operation: Operation) -> str:
    """Return what no CL file could state of an operation besides its motion; empty if there is none."""
    tool, frame = operation.tool, operation.frame
    for what, record in (("tool", tool), ("coordinate system", frame)):
        fault = value_fault(record)
        if fault:
            return f"has a {what} with {fault}"
    below = next((name for name in _SIZES if getattr(tool, name) < 0.0), "")
    if below:
        return f"has a tool with {below} = {getattr(tool, below):g}, which is below 0"
    if tool.kind not in _TOOL_KINDS:
        return f"has a tool of the kind {tool.kind!r:.40}, which is none of {', '.join(_TOOL_KINDS)}"
    axes = np.array((frame.x, frame.y))
    if np.abs(axes @ axes.T - np.eye(2)).max() > 1e-6:
        return "has a coordinate system whose X and Y are no unit vectors at right angles"
    for name in ("intol", "outtol"):
        value = getattr(operation, name)
        if value is not None and not (_fits(value, float) and _is_plain(value) and value >= 0.0):
            return f"has {name} = {value!r:.40}, which is no tolerance"
    lines_fit = _fits(operation.line, int) and _fits(operation.joined, tuple[str, ...])
    return "" if lines_fit and isinstance(operation.splines, Splines) else "has a line, splines or joined that are none"


def value_fault(record: Event | Tool | Frame) -> str:
    """Return the first value of a record that is of another type, or that no CL file could have; empty if there is
    none.
    """
    kind: type = type(record)
    hints = _hints(kind)
    for each in fields(record):
        value = getattr(record, each.name)
        if not (_fits(value, hints[each.name]) and (value is None or _is_plain(value))):
            return f"{each.name} = {value!r:.60}"
    return ""


@cache
def _hints(kind: type) -> dict[str, object]:
    return get_type_hints(kind)


def _fits(value: object, hint: object) -> bool:
    """Whether a value is of a type, as records declare it."""
    if hint is float or hint is int:
        kinds = (int, float) if hint is float else int
        return isinstance(value, kinds) and not isinstance(value, bool)
    if isinstance(hint, type) and not isinstance(hint, types.GenericAlias):
        return isinstance(value, hint)
    parts = get_args(hint)
    if isinstance(hint, types.UnionType):
        return any(_fits(value, part) for part in parts)
    if not isinstance(value, tuple):
        return False
    if parts[-1] is Ellipsis:
        return all(_fits(each, parts[0]) for each in value)
    return len(value) == len(parts) and all(map(_fits, value, parts))


def _column_fault(moves: Moves) -> str:
    n = len(moves.tip)
    shapes = {"tip": (n, 3), "axis": (n, 3)} | dict.fromkeys(("kind", "phase", "feed", "per_rev", "line"), (n,))
    for name, shape in shapes.items():
        column = getattr(moves, name)
        if not isinstance(column, np.ndarray) or column.shape != shape:
            return f"has a column {name} of another shape than {shape}"
    if n == 0:
        return "has no points"
    types_ = {"tip": np.float64, "axis": np.float64, "feed": np.float64, "kind": np.uint8, "phase": np.uint8,
              "per_rev": np.bool_, "line": np.int32}  # fmt: skip
    for name, wanted in types_.items():
        if getattr(moves, name).dtype != wanted:
            return f"has a column {name} that is no {np.dtype(wanted).name}"
    if not (np.abs(moves.tip) <= _FARTHEST).all():
        return f"has a point that is none, or beyond {_FARTHEST:g} mm"
    if not (np.abs(np.linalg.norm(moves.axis, axis=1) - 1.0) <= 1e-6).all():
        return "has a tool axis that is no unit vector"
    if not ((moves.kind <= max(Kind)) & (moves.phase <= max(Phase))).all():
        return "has a kind or a phase that is none"
    if (moves.feed < 0.0).any() or np.isinf(moves.feed).any():
        return "has a feed that is none"
    return "has normals of another shape" if moves.normal is not None and moves.normal.shape != (n, 3) else ""


def _arc_fault(moves: Moves, arcs: Arcs) -> str:
    rows = np.flatnonzero(moves.kind == Kind.ARC)
    if not np.array_equal(rows, arcs.row):
        return "has other arcs than its rows of kind ARC"
    m = len(rows)
    shapes_fit = arcs.centre.shape == (m, 3) == arcs.normal.shape and arcs.radius.shape == (m,) == arcs.full_turns.shape
    values = (arcs.centre, arcs.normal, arcs.radius)
    return "" if shapes_fit and all(np.isfinite(each).all() for each in values) else "has an arc that is none"


def _is_plain(value: object) -> bool:
    """Whether a value of an event could come from a CL file."""
    if isinstance(value, str):
        return len(value) <= _LONGEST_TEXT and value.isprintable()
    if isinstance(value, tuple):
        return len(value) <= _LONGEST_TEXT and all(map(_is_plain, value))
    return isinstance(value, bool) or (isinstance(value, int | float) and math.isfinite(value) and abs(value) <= 1e9)
