"""Points on the straight way from the point before to the one behind: without them, or elsewhere on that way, nothing
changes.

The rule reads the words of three blocks. How far a point is off counts in each coordinate: 0.001 mm or degrees, the
last digit of most programs, and 0.00002 of the components of a tool axis.
"""

import re
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from tests.support.recall_proof.edits import Block

_SAME: Final = 0.001
_SAME_VECTOR: Final = 2e-5
_VECTOR = re.compile(r"(?<![A-Z_$=(])([IJK])([-+]?\d*\.?\d+)")
#: All words of a block but its number, G1 and its coordinates.
_OTHERS = re.compile(r"^N?\d+ |\bG0?1\b|\bL\b|(?<![A-Z_$=(,])[XYZABCIJK][-+]?\d*\.?\d*(?![\w.(])")


def is_on_straight_way(blocks: "list[Block]", k: int, changed: dict[str, float] | None = None) -> bool:
    """Whether block ``k`` ends on the straight way from the block before to that behind, all of them lines at one feed.

    changed  coordinates in place of its own; without them the block must hold nothing but coordinates
    """
    if k == 0 or k + 1 >= len(blocks):
        return False
    block, following = blocks[k], blocks[k + 1]
    for each in (block, following):
        if not each.cuts or each.cycle or each.compensated or each.arc_in_force or re.search(r"\bG0?[23]\b", each.code):
            return False
    if _others(following.code) or (changed is None and _others(block.code)):
        return False
    start = {**block.before, **_vector(blocks[k - 1].code)}
    point = {**start, **_coordinates(block), **_vector(block.code), **(changed or {})}
    end = {**point, **_coordinates(following), **_vector(following.code)}
    if changed and not changed.keys() <= _coordinates(following).keys():
        return False  # it stays there
    if point.keys() != start.keys() or end.keys() != start.keys():
        return False
    way = {name: end[name] - start[name] for name in start}
    length = sum(way[name] ** 2 for name in way if name in "XYZ")
    part = sum((point[name] - start[name]) * way[name] for name in way if name in "XYZ") / max(length, 1e-12)
    return 0.0 <= part <= 1.0 and all(
        abs(point[name] - start[name] - part * way[name]) <= (_SAME_VECTOR if name in "IJK" else _SAME) for name in way
    )


def is_near_straight_way(blocks: "list[Block]", k: int, tolerance: float) -> bool:
    """Whether the axes come so near to the end of block ``k`` without it that the tip need not leave its tolerance.

    Without TCP the axes go evenly from the point before to that behind. How far linear axes are off there is how far
    the tip is; part of that may be along its way. So twice the tolerance, mm, is no harm that is sure.
    """
    if not 0 < k < len(blocks) - 1 or blocks[k].tcp or blocks[k].cycle or blocks[k + 1].cycle:
        return False
    if not (blocks[k].cuts and blocks[k + 1].cuts) and not (blocks[k].rapids and blocks[k + 1].rapids):
        return False
    start = blocks[k].before
    point = {**start, **_coordinates(blocks[k])}
    end = {**point, **_coordinates(blocks[k + 1])}
    if point.keys() != start.keys() or end.keys() != start.keys():
        return False
    way = {name: end[name] - start[name] for name in start}
    turning = max((name for name in way if name in "ABC"), key=lambda name: abs(way[name]), default="")
    if not turning or abs(way[turning]) <= _SAME:
        return False
    part = (point[turning] - start[turning]) / way[turning]
    return 0.0 < part < 1.0 and all(
        abs(point[name] - start[name] - part * way[name]) <= (_SAME if name in "ABC" else 2.0 * tolerance)
        for name in way
    )


def _coordinates(block: "Block") -> dict[str, float]:
    return {word[1]: float(word[2]) for word in block.words}


def _vector(code: str) -> dict[str, float]:
    return {word[1]: float(word[2]) for word in _VECTOR.finditer(code)}


def _others(code: str) -> str:
    return _OTHERS.sub("", code).strip()
