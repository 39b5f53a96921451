"""Tables of measured points: text with a line for a point and columns for X, Y and Z of one or more curves.

    index,tip_x_mm,tip_y_mm,tip_z_mm,hub_x_mm,hub_y_mm,hub_z_mm
    1,35.515,-21.597,44.149,11.690,-12.681,46.682

Columns whose names end in ``x``, ``y`` and ``z`` (and ``_mm``, ``_in`` or ``_inch``) after the same beginning are a
curve; others are left out. Columns are parted by commas, semicolons, tabs or blanks. Where semicolons or tabs do it,
a comma may be the decimal sign. Empty lines and those that begin with ``#`` are passed over. Without names there are
three columns, or four of which the first numbers the points.

A table as books print it has the names of its curves in a line of their own, above columns that repeat:

    序号  叶顶曲线              叶根曲线
          X/(mm) Y/(mm) Z/(mm)  X/(mm) Y/(mm) Z/(mm)

Without that line curves whose columns repeat are called ``curve_1``, ``curve_2`` and so on.
"""

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.encoding import EncodingDetector
from trunnion.errors import InputError, Problem, unusable_file
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass

#: So many bytes tell whether a file is text.
_HEAD: Final = 1000

#: Larger files are no tables of measured points.
_MOST_BYTES: Final = 64_000_000

_COLUMN: Final = re.compile(
    r"(?:(?P<curve>.{1,80})[_ .])?(?P<axis>[xyz])(?:[_ ]?/?[(\[（]?(?P<unit>mm|毫米|inch|in)[)\]）]?)?", re.IGNORECASE
)

#: What numbers the points, in the line of the names of curves.
_NUMBERING: Final = frozenset({"序号", "编号", "点号", "no", "no.", "nr", "nr.", "index", "point"})

#: Columns of a coordinate in a unit that is not read: nobody wants a curve left out for it.
_OTHER_UNIT: Final = re.compile(
    r"(?:.{1,80}[_ .])?[xyz][_ ]?/?[(\[（]?(?P<unit>[nµμu]m|cm|dm|m|km|ft|feet|foot|inches|mils?|thou)[)\]）]?",
    re.IGNORECASE,
)

_INCH: Final = 25.4

#: A curve has no more points, so that none takes minutes without a word.
MOST_POINTS: Final = 20_000

#: Columns of a table without names: X, Y and Z, after a number of the point if there is one.
_UNNAMED: Final = {3: (0, 1, 2), 4: (1, 2, 3)}

#: No machine cuts what is larger, mm.
_GREATEST: Final = 1e6


@dataclass(frozen=True, slots=True, eq=False)
class PointTable:
    """The points of a curve of a table.

    file    what messages call it
    name    of the curve; empty if the table gives none
    points  (n, 3) mm
    lines   of the points in the file
    """

    file: str
    name: str
    points: Floats
    lines: Sequence[int]

    @property
    def called(self) -> str:
        """What messages call the curve."""
        return f"the curve {self.name}" if self.name else "the curve"


def scaled(table: PointTable, scale: float) -> PointTable:
    """Return the points of a table times a number."""
    return replace(table, points=table.points * scale)


@dataclass(frozen=True, slots=True)
class _Columns:
    """Where a curve stands in a line."""

    name: str
    places: tuple[int, ...]
    unit: float


def read_point_table(file: Path) -> list[PointTable]:
    """Return the curves of a table, in the order of their columns.

    Raises ``InputError`` if the file cannot be read, or is no table of points; with every mistake and its line.
    """
    problem = unusable_file(file, phrase("file_of_points"))
    if problem is not None:
        raise InputError(problem)
    with file.open("rb") as stream:
        data = stream.read(_MOST_BYTES + 1)
    if len(data) > _MOST_BYTES:
        raise InputError(Problem(str(file), 0, Wording("IMP110", "larger_mb", most_bytes=_MOST_BYTES // 1000000)))
    if b"\0" in data[:_HEAD]:
        raise InputError(Problem(str(file), 0, Wording("IMP110", "no_text_utf")))
    detector = EncodingDetector()
    detector.add(data.removeprefix(b"\xef\xbb\xbf"))
    text = data.decode("utf-8-sig" if detector.encoding() == "utf-8" else detector.encoding(), "replace")
    return parse_point_table(str(file), text)


def parse_point_table(file: str, text: str) -> list[PointTable]:
    """Return the curves of a table's text; ``file`` is for messages. Errors as ``read_point_table`` raises them."""
    rows = list(_rows(text))
    if not rows:
        raise InputError(Problem(file, 0, Wording("IMP111", "holds_no_points")))
    first_line, first = rows[0]
    if _has_number(first):
        columns = _unnamed(file, first_line, first)
    else:
        names = _names_above(rows)
        if names:
            rows = rows[1:]
            first_line, first = rows[0]
        rows = rows[1:]
        if rows and len(rows[0][1]) == len(first) + 1:  # nothing stands above the numbers of the points
            first = ["", *first]
        columns = _named(file, first_line, first, names)
    if len(rows) > MOST_POINTS:
        raise InputError(Problem(file, rows[MOST_POINTS][0], too_many(len(rows))))
    problems: list[Problem] = []
    tables = [_table(file, each, rows, len(first), problems) for each in columns]
    problems += _torn(file, rows, len(first))
    empty = [one for one in tables if not len(one.points)]
    problems += [Problem(file, first_line, Wording("IMP111", "no_points", called=one.called)) for one in empty]
    if problems:
        raise InputError(sorted(problems, key=lambda one: one.line))
    return tables


def too_many(count: int) -> Wording:
    """Return what is wrong with so many points."""
    return Wording("IMP120", "too_many", count=count, most=MOST_POINTS)


def _rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Line and cells of each line that has any."""
    lines = [(number, line.strip()) for number, line in enumerate(text.splitlines(), 1)]
    lines = [(number, line) for number, line in lines if line and not line.startswith("#")]
    if not lines:
        return
    head = lines[0][1]
    separator = next((sign for sign in (";", "\t", ",") if sign in head), None)
    comma_is_decimal = separator == ";" or (separator == "\t" and any("," in line for _, line in lines))
    for number, line in lines:
        cells = [cell.strip().strip('"') for cell in line.split(separator)]
        if comma_is_decimal:  # a comma beside a point is no decimal sign, and no number either
            cells = [cell if "." in cell else cell.replace(",", ".") for cell in cells]
        yield number, cells


def _number(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if "_" not in cell else None


def _has_number(cells: Sequence[str]) -> bool:
    return any(_number(cell) is not None for cell in cells)


def _unnamed(file: str, line: int, cells: Sequence[str]) -> list[_Columns]:
    count = len(cells)
    if count not in _UNNAMED:
        raise InputError(Problem(file, line, Wording("IMP111", "column_without_names", count=count)))
    return [_Columns("", _UNNAMED[count], 1.0)]


def _names_above(rows: Sequence[tuple[int, list[str]]]) -> list[str]:
    """Return the names of curves that stand in a line of their own, above that of the columns; empty: there is none."""
    if len(rows) < 2 or any(map(_COLUMN.fullmatch, rows[0][1])) or not any(map(_COLUMN.fullmatch, rows[1][1])):
        return []
    return [cell for cell in rows[0][1] if cell and cell.lower() not in _NUMBERING]


def _with_curves(cells: Sequence[str], names: Sequence[str]) -> list[str]:
    """Return the names of columns with that of their curve where plain X, Y and Z repeat."""
    plain = [place for place, cell in enumerate(cells) if (match := _COLUMN.fullmatch(cell)) and not match["curve"]]
    count = len(plain) // 3
    if len(plain) % 3 or (count < 2 and len(names) != 1):
        return list(cells)
    called = names if len(names) == count else [f"curve_{number + 1}" for number in range(count)]
    found = list(cells)
    for order, place in enumerate(plain):
        found[place] = f"{called[order // 3]}_{cells[place]}"
    return found


def _named(file: str, line: int, cells: Sequence[str], names: Sequence[str]) -> list[_Columns]:
    """Return the curves that the names of columns tell of; ``names`` are those in the line above."""
    cells = _with_curves(cells, names)
    found: dict[str, dict[str, tuple[int, float]]] = {}
    problems, curves = list[Problem](), []
    for place, cell in enumerate(cells):
        match = _COLUMN.fullmatch(cell)
        if match is None:
            other = _OTHER_UNIT.fullmatch(cell)
            if other is not None:
                problems.append(Problem(file, line, Wording("IMP113", "column", cell=cell, other=other["unit"])))
            continue
        axes = found.setdefault(match["curve"] or "", {})
        axis, unit = match["axis"].lower(), (match["unit"] or "mm").lower()
        if axis in axes:
            raise InputError(Problem(file, line, Wording("IMP111", "two_columns", cell=cell)))
        axes[axis] = place, 1.0 if unit in ("mm", "毫米") else _INCH
    for name, axes in found.items():
        missing = [axis for axis in "xyz" if axis not in axes]
        units = {unit for _, unit in axes.values()}
        if missing:
            problems.append(
                Problem(
                    file,
                    line,
                    Wording("IMP111", "curve_no_column", name=name or "without a name", missing=tuple(missing)),
                )
            )
        elif len(units) > 1:
            problems.append(Problem(file, line, Wording("IMP113", "curve_mm_inches", name=name)))
        else:
            curves.append(_Columns(name, tuple(axes[axis][0] for axis in "xyz"), units.pop()))
    if problems:
        raise InputError(problems)
    if not curves:
        raise InputError(Problem(file, line, Wording("IMP111", "names_no_columns")))
    return curves


def _table(
    file: str, columns: _Columns, rows: Sequence[tuple[int, list[str]]], width: int, problems: list[Problem]
) -> PointTable:
    """Return the points of a curve; adds what is wrong with its cells.

    Where it ends before the others, cells are empty.
    """
    points, lines = list[list[float]](), list[int]()
    ended = 0
    for line, cells in rows:
        if len(cells) != width:
            continue  # told once for all curves
        texts = [cells[place] for place in columns.places]
        if not any(texts):
            ended = ended or line
            continue
        values = [_number(text) for text in texts]
        bad = [text for text, value in zip(texts, values, strict=True) if value is None or not math.isfinite(value)]
        if bad:
            problems.append(Problem(file, line, _no_number(bad[0])))
            continue
        if ended:
            problems.append(
                Problem(file, line, Wording("IMP112", "curve_goes_after", columns=columns.name, ended=ended))
            )
            break
        point = [columns.unit * value for value in values if value is not None]
        if max(map(abs, point)) > _GREATEST:
            problems.append(Problem(file, line, Wording("IMP113", "mm_away", abs=max(map(abs, point)))))
        points.append(point)
        lines.append(line)
    return PointTable(file, columns.name, np.array(points, float).reshape(-1, 3), lines)


def _no_number(cell: str) -> Wording:
    """Return what is wrong with a cell: a comma may be meant as the decimal sign, and part columns instead."""
    parts = cell.replace(",", ".").split()
    if _number(cell) is None and parts and all(_number(part) is not None for part in parts):
        return Wording("IMP112", "no_number_but_commas", cell=repr(cell))
    return Wording("IMP112", "no_number", cell=repr(cell))


def _torn(file: str, rows: Sequence[tuple[int, list[str]]], width: int) -> Iterator[Problem]:
    """Lines with more or fewer cells than the first."""
    for line, cells in rows:
        if len(cells) != width:
            yield Problem(file, line, Wording("IMP112", "column_where_first", count=len(cells), width=width))
