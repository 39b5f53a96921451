"""The same circles in other words: by their radius, by an absolute centre, in two pieces."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

from tests.support.recall_proof.edits import Block, Edit, numbered, with_lines

#: How an arc names its centre, and its radius: signed, more than half a circle where it is negative.
_RELATIVE, _ABSOLUTE, _POLE = "relative", "absolute", "pole"
_CENTRES = {
    "Sinumerik": _RELATIVE, "Fanuc": _RELATIVE, "Haas": _RELATIVE, "LinuxCNC": _RELATIVE, "Fidia": _ABSOLUTE,
    "Heidenhain": _POLE,
}  # fmt: skip
_RADIUS = {"Sinumerik": "CR=", "Fanuc": "R", "Haas": "R", "LinuxCNC": "R"}


@dataclass(frozen=True)
class _Arc:
    """An arc in the plane of X and Y: from start to end about a centre; ``sweep`` in radians with its sign."""

    start: tuple[float, float]
    end: tuple[float, float]
    centre: tuple[float, float]
    z: tuple[float, float] | None
    sweep: float

    @property
    def radius(self) -> float:
        return math.dist(self.start, self.centre)

    @property
    def is_full(self) -> bool:
        return math.dist(self.start, self.end) < 1e-6

    @property
    def middle(self) -> tuple[float, float]:
        """Its point half-way."""
        x, y = (a - b for a, b in zip(self.start, self.centre, strict=True))
        c, s = math.cos(0.5 * self.sweep), math.sin(0.5 * self.sweep)
        return self.centre[0] + c * x - s * y, self.centre[1] + s * x + c * y


def equivalent_arcs(blocks: list[Block], family: str) -> Iterator[Edit]:
    """Yield every arc of a program in other words."""
    if any(re.search(r"\bG1[89]\b|\bG93\b", block.code) for block in blocks):
        return
    for k, block in enumerate(blocks):
        if block.compensated:
            continue
        if family == "Heidenhain":
            yield from _klartext(blocks, k)
            continue
        arc = _iso_arc(block, _CENTRES[family])
        if arc is None:
            continue
        name = "a full circle as two halves" if arc.is_full else "an arc in two"
        yield Edit(name, k + 1, with_lines(blocks, k, *_two_pieces(block, arc, _CENTRES[family])))
        if family in _RADIUS and not arc.is_full and not math.radians(170) < abs(arc.sweep) < math.radians(190):
            line = re.sub(r" [IJ][-+]?[\d.]+", "", block.line)
            signed = arc.radius if abs(arc.sweep) < math.pi else -arc.radius
            yield Edit(
                "an arc by its radius", k + 1, with_lines(blocks, k, _behind(line, f"{_RADIUS[family]}{signed:.6f}"))
            )
        if family == "Sinumerik":
            line = re.sub(r" [IJ][-+]?[\d.]+", "", block.line)
            centre = f"I=AC({arc.centre[0]:.6f}) J=AC({arc.centre[1]:.6f})"
            yield Edit("an arc by its absolute centre", k + 1, with_lines(blocks, k, _behind(line, centre)))


def _value(code: str, letter: str) -> float | None:
    found = re.search(rf"(?<![A-Z_]){letter}([-+]?(?:\d+\.?\d*|\.\d+))", code)
    return float(found[1]) if found else None


def _swept(start: tuple[float, float], end: tuple[float, float], centre: tuple[float, float], way: int) -> float:
    a, b = (math.atan2(p[1] - centre[1], p[0] - centre[0]) for p in (start, end))
    angle = (way * (b - a)) % (2.0 * math.pi)
    return way * (angle if angle > 1e-9 else 2.0 * math.pi)


def _iso_arc(block: Block, centres: str) -> _Arc | None:
    i, j = _value(block.code, "I"), _value(block.code, "J")
    if not block.cuts or block.way == 0 or i is None or j is None or not {"X", "Y"} <= set(block.before):
        return None
    start = block.before["X"], block.before["Y"]
    x, y = (_value(block.code, letter) for letter in "XY")
    end = start[0] if x is None else x, start[1] if y is None else y
    centre = (i, j) if centres == _ABSOLUTE else (start[0] + i, start[1] + j)
    z = _value(block.code, "Z")
    if z is not None and "Z" not in block.before:
        return None
    rise = None if z is None else (block.before["Z"], z)
    return _Arc(start, end, centre, rise, _swept(start, end, centre, block.way))


def _two_pieces(block: Block, arc: _Arc, centres: str) -> list[str]:
    """Two blocks in place of one; the first keeps all other words."""
    mx, my = arc.middle
    first = _behind(re.sub(r" [XYZIJ][-+]?[\d.]+", "", block.line), _iso_words(arc.start, (mx, my), arc, 0.5, centres))
    return [first, *numbered(block, _iso_words((mx, my), arc.end, arc, 1.0, centres))]


def _iso_words(start: tuple[float, float], end: tuple[float, float], arc: _Arc, part: float, centres: str) -> str:
    x, y = arc.centre
    i, j = (x, y) if centres == _ABSOLUTE else (x - start[0], y - start[1])
    z = "" if arc.z is None else f" Z{arc.z[0] + part * (arc.z[1] - arc.z[0]):.6f}"
    return f"X{end[0]:.6f} Y{end[1]:.6f}{z} I{i:.6f} J{j:.6f}"


def _behind(line: str, words: str) -> str:
    """A block with more words, before its feed."""
    before, feed, after = line.partition(" F")
    return f"{before} {words}{feed}{after}"


# Klartext


def _klartext(blocks: list[Block], k: int) -> Iterator[Edit]:
    """A circle about a pole: through a middle, or by its radius."""
    block = blocks[k]
    pole = re.match(r"\d+ CC X([-+][\d.]+) Y([-+][\d.]+)$", blocks[k - 1].code.rstrip()) if k else None
    if pole is None or not {"X", "Y"} <= set(block.before):
        return
    centre = float(pole[1]), float(pole[2])
    start = block.before["X"], block.before["Y"]
    turned = re.match(r"\d+ CP IPA([-+])360 (?:IZ([-+][\d.]+) )?", block.code)
    if turned:
        rise = f"IZ{0.5 * float(turned[2]):+.6f} " if turned[2] else ""
        rest = block.line[turned.end() :]
        lines = [f"{block.line.split()[0]} CP IPA{turned[1]}180 {rise}{rest}" for _ in range(2)]
        yield Edit("a full circle as two halves", k + 1, with_lines(blocks, k, *lines))
    match = re.match(r"(\d+ )C (?:X([-+][\d.]+) )?(?:Y([-+][\d.]+) )?DR([-+])", block.code)
    if not match:
        return
    end = tuple(float(given) if given else at for given, at in zip(match.group(2, 3), start, strict=True))
    arc = _Arc(
        start, (end[0], end[1]), centre, None, _swept(start, (end[0], end[1]), centre, 1 if match[4] == "+" else -1)
    )
    rest = block.line[match.end() :]
    name = "a full circle as two halves" if arc.is_full else "an arc in two"
    pieces = [f"{match[1]}C X{x:+.6f} Y{y:+.6f} DR{match[4]}{rest}" for x, y in (arc.middle, arc.end)]
    yield Edit(name, k + 1, with_lines(blocks, k, *pieces))
    if not arc.is_full and not math.radians(170) < abs(arc.sweep) < math.radians(190):
        signed = arc.radius if abs(arc.sweep) < math.pi else -arc.radius
        line = f"{match[1]}CR X{arc.end[0]:+.6f} Y{arc.end[1]:+.6f} R{signed:+.6f} DR{match[4]}{rest}"
        yield Edit("an arc by its radius", k + 1, with_lines(blocks, k, line))
