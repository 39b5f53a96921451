"""Records as plain data, and data as JSON."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any, Final

from trunnion.errors import Problem
from trunnion.results.figures import EXACT, Figure, figures_of

_PLAIN: Final = Figure()


def to_data(value: Any, *, decimals: int | None = None, only: Sequence[str] = ()) -> Any:
    """Return a record, or a sequence of records, as data for JSON.

    A class with a ``SCHEMA`` is a document: that number comes first, and its ``DECIMALS`` are those of all that it has
    unless a figure says otherwise. Numbers that are not finite become None, paths
    and enumerations texts, arrays lists; a ``Problem`` has the same seven keys wherever it stands.

    value     records, numbers, texts, arrays, and sequences and mappings of them
    decimals  to which numbers are rounded unless their figure says it; None: they are not
    only      keys of the record, or of each record of a sequence; by default all
    """
    return _converted(value, _PLAIN, decimals, tuple(only))


def as_json(value: Any) -> str:
    """Return data as text, one line for each value."""
    return json.dumps(value, ensure_ascii=False, allow_nan=False, indent=1)


def _converted(value: Any, figure: Figure, decimals: int | None, only: tuple[str, ...] = ()) -> Any:
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, str):  # of an enumeration its value
        return str(value)
    if isinstance(value, int | float):
        return _number(value, figure, decimals)
    if isinstance(value, Mapping):
        return {str(key): _converted(each, figure, decimals, only) for key, each in value.items()}
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, Problem):
        return _remark(value)
    if is_dataclass(value):
        return _record(value, decimals if figure.decimals is None else figure.decimals, only)
    if hasattr(value, "tolist"):  # of NumPy, which this module does without
        return _converted(value.tolist(), figure, decimals)
    assert isinstance(value, Iterable), f"{type(value).__name__} is no data"
    return [_converted(each, figure, decimals, only) for each in value]


def _number(value: float, figure: Figure, decimals: int | None) -> float | None:
    """Return a number of a figure; one that has a unit, and is rounded, is no count, even if it is whole."""
    places = decimals if figure.decimals is None else figure.decimals
    if isinstance(value, int) and not (figure.unit or figure.decimals is not None):
        return value
    if not math.isfinite(value):
        return None
    return value if places in (None, EXACT) else round(float(value), places) + 0.0


def _record(record: Any, decimals: int | None, only: tuple[str, ...]) -> dict[str, Any]:
    kind = type(record)
    schema, decimals = getattr(kind, "SCHEMA", None), getattr(kind, "DECIMALS", decimals)
    found: dict[str, Any] = {} if schema is None or only else {"schema": schema}
    known = {each.key: each for each in figures_of(kind)} if only else {}
    figures = [known[key] for key in only] if only else [each for each in figures_of(kind) if not each.figure.is_extra]
    for each in figures:
        figure, value = each.figure, _converted(each.value(record), each.figure, decimals)
        if figure.is_flat:
            found |= value
        elif figure.is_optional and value is None:
            continue
        else:
            group = found.setdefault(figure.within, {}) if figure.within else found
            group[each.key] = value
    return found


def _remark(problem: Problem) -> dict[str, Any]:
    """Return a problem; its subject is what of the file or the call it is about."""
    is_argument = bool(problem.argument)
    kind, name = ("argument", problem.argument) if is_argument else ("key", problem.key)
    return {
        "severity": str(problem.severity),
        "code": problem.code or None,
        "file": None if is_argument else problem.file,
        "line": problem.line or None,
        "text": problem.what,
        "cure": problem.cure or None,
        "subject": {"kind": kind, "name": name} if name else None,
    }
