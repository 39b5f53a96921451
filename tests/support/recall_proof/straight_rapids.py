"""Rapids that the next one takes over: without their point, or with another, nothing changes.

Along the tool axis they go on in the same direction; that rule reads Z alone, in blocks that leave X and Y where they
are. Across it, the next rapid says X or Y again at the same height.
"""

import math
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.support.recall_proof.edits import Block
    from tests.support.recall_proof.languages import Language

#: A number of a block, and comments that are blanked out.
_NUMBER = re.compile(r"^/?N?\d+ ")
#: How much higher than its point a rapid may begin that comes from home: at least this, mm.
_BELOW_HOME = 1.0


def is_on_rapid_way(blocks: "list[Block]", k: int, language: "Language", z: float | None = None) -> bool:
    """Whether a rapid along Z passes through its end: the next motion goes on in the same direction, at rapid too.

    z  a height in place of its own; without it the block must hold nothing but its way
    """
    block = blocks[k]
    if not block.rapids or block.cycle or not _is_along_z(block) or (z is None and _rest(block, language)):
        return False
    following = _next_motion(blocks, k)
    if following is None or not _is_along_z(blocks[following]):
        return False
    own, start = _height(block), _start(blocks, k, language)
    if blocks[following].cycle:
        end = _retract_height(blocks, following)
    else:
        end = _height(blocks[following]) if blocks[following].rapids else None
    if start is None or own is None or end is None:
        return False
    heights = [own] if z is None else [own, z]
    if math.isinf(start):
        start = own + _BELOW_HOME
    return all(min(start, end) <= height <= max(start, end) for height in heights)


def is_said_again(blocks: "list[Block]", k: int, letter: str) -> bool:
    """Whether the next rapid goes to the place of one, and says X or Y of it again: the way there is in the air."""
    following = next((block for block in blocks[k + 1 :] if block.words), None)
    if letter not in "XY" or following is None or not (blocks[k].rapids and following.rapids) or following.cycle:
        return False
    place = {word[1]: float(word[2]) for word in blocks[k].words}
    again = {word[1]: float(word[2]) for word in following.words}
    return letter in again and all(place.get(each) == value for each, value in again.items())


def _retract_height(blocks: "list[Block]", k: int) -> float | None:
    """The height to which a cycle goes at rapid before its hole, if it does not matter where it has begun."""
    code = blocks[k].code
    if re.search(r"\bE-?\d", code):  # of a Fidia, whose cycles have a height of their own between holes
        return _height(blocks[k])
    found = re.search(r"\bR(-?[\d.]+)", code)
    is_known = re.search(r"\bG99\b", code) or (re.search(r"\bG98\b", code) and returns_on_the_way(blocks, k))
    return float(found[1]) if found and is_known else None


def returns_on_the_way(blocks: "list[Block]", k: int) -> bool:
    """Whether the cycle of one hole in block ``k`` is left along Z, higher than it can have begun: where it returns to
    is on that way.
    """
    end = k + 1
    if end >= len(blocks) or not re.search(r"\bG80\b", blocks[end].code):
        return False
    following = _next_motion(blocks, end)
    if following is None or not blocks[following].rapids or blocks[following].cycle:
        return False
    if not _is_along_z(blocks[following]):
        return False
    begun = [_height(each) for each in blocks[:k] if each.rapids and not each.cycle and _height(each) is not None]
    left = _height(blocks[following])
    return bool(begun) and left is not None and left >= (begun[-1] or 0.0)


def _next_motion(blocks: "list[Block]", k: int) -> int | None:
    """The next block with coordinates, if none before it has code."""
    for at in range(k + 1, len(blocks)):
        if blocks[at].words:
            return at
        if _NUMBER.sub("", blocks[at].code).strip():
            return None
    return None


def _is_along_z(block: "Block") -> bool:
    stays = all(block.before.get(word[1]) == float(word[2]) for word in block.words if word[1] != "Z")
    return stays and _height(block) is not None and not re.search(r"\b[IJK][-+]?[\d.]", block.code)


def _height(block: "Block") -> float | None:
    return next((float(word[2]) for word in block.words if word[1] == "Z"), None)


def _start(blocks: "list[Block]", k: int, language: "Language") -> float | None:
    """The height before a block, infinite at home, or nothing where none is stated."""
    for block in reversed(blocks[:k]):
        if re.search(language.away, block.code) and (_height(block) is not None or not block.words):
            return math.inf
        if _height(block) is not None:
            return None if block.cycle else _height(block)
    return None


def _rest(block: "Block", language: "Language") -> str:
    """What a block says besides its way."""
    code = re.sub(language.rapid, "", _NUMBER.sub("", block.code))
    return re.sub(r"\b[XYZ][-+]?[\d.]+|\bL\b|\bG0?1\b", "", code).strip()
