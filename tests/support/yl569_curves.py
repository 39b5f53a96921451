"""The curves of the YL569's axes over its programs, read from their text without any reader or map of the product.

The control moves the tool tip: X Y Z are those of the workpiece after G54, and B and C are the axes. Both turn the
part, C about Z and B about Y, about lines through the machine's zero, so that the tool axis (sinB cosC, sinB sinC,
cosB) comes to stand along Z.
"""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from trunnion.arrays import Floats

_WORD = re.compile(r"([A-Z])(-?\d*\.?\d+)(?![\d.]*=)")

#: Points of an arc, and degrees that B and C turn in a part of a line, on which tip and rotary axes go evenly.
_ARC, _TURN = 7200, 0.5


def tips_and_angles(programs: Iterable[Path]) -> Floats:
    """(n, 5) of programs one after the other: X Y Z of the tip, mm, B and C, degrees, along each block."""
    return np.concatenate([np.array(_rows_of(program)) for program in programs])


def _rows_of(program: Path) -> list[list[float]]:
    now = dict.fromkeys("XYZBC", 0.0)
    rows: list[list[float]] = []
    arc, seen, home, known = 0, set[str](), True, False
    for line in program.read_text(encoding="utf-8").splitlines():
        block = line.partition(";")[0].partition(" ")[2]
        if block.startswith("SUPA"):
            home = True
        if "=" in block or "(" in block:
            continue
        words = {letter: float(value) for letter, value in _WORD.findall(block)}
        for code in re.findall(r"\bG([0123])\b", block):
            arc = int(code)
        if block.startswith("G54"):
            home, known, seen = False, False, set()
        moves = words.keys() & set("XYZBC")
        begin = now.copy()
        now |= {letter: words[letter] for letter in moves}
        seen |= moves
        if home or not moves or not seen.issuperset("XYZ"):
            continue
        if arc in (2, 3) and "I" in words:
            rows += _on_arc(begin, now, words, -1.0 if arc == 2 else 1.0)
        elif known:
            rows += _on_line(begin, now)
        rows.append([now[letter] for letter in "XYZBC"])
        known = True
    return rows


def _on_line(begin: dict[str, float], end: dict[str, float]) -> list[list[float]]:
    """Points of a line; C goes the shorter way."""
    first, way = (np.array([each[letter] for letter in "XYZBC"]) for each in (begin, end))
    way = way - first
    way[4] = (way[4] + 180.0) % 360.0 - 180.0
    parts = int(np.ceil(np.abs(way[3:]).max() / _TURN))
    return [(first + way * k / parts).tolist() for k in range(1, parts)]


def _on_arc(begin: dict[str, float], end: dict[str, float], words: dict[str, float], sense: float) -> list[list[float]]:
    """Points of an arc in X and Y about begin + (I, J)."""
    x, y = begin["X"] + words["I"], begin["Y"] + words["J"]
    first = np.arctan2(begin["Y"] - y, begin["X"] - x)
    way = sense * (np.arctan2(end["Y"] - y, end["X"] - x) - first) % (2.0 * np.pi)
    way = 2.0 * np.pi if way < 1e-9 else way
    radius = np.hypot(begin["X"] - x, begin["Y"] - y)
    angles = first + sense * way * np.linspace(0.0, 1.0, _ARC)
    rest = [begin[letter] for letter in "ZBC"]
    return [[x + radius * np.cos(a), y + radius * np.sin(a), *rest] for a in angles.tolist()]


def curves(rows: Floats, zero: Sequence[float], tool_length: float) -> dict[str, Floats]:
    """The positions of each axis in rows (n, 5) with the workpiece zero there, mm and degrees."""
    x, y, z = (rows[:, :3] + zero).T
    b, c = np.radians(rows[:, 3]), np.radians(rows[:, 4])
    along, across = x * np.cos(c) + y * np.sin(c), y * np.cos(c) - x * np.sin(c)  # C turns the part by -C
    return {
        "X": along * np.cos(b) - z * np.sin(b),
        "Y": across,
        "Z": along * np.sin(b) + z * np.cos(b) + tool_length,
        "B": rows[:, 3],
        "C": rows[:, 4],
    }
