"""The contour of cycles 27 and 28: a subprogram whose blocks are not motions, unrolled from the cylinder.

A point has two coordinates: that of the rotary axis, degrees or a length of arc as the cycle states, and that of the
linear axis along it. Corners are rounded and chamfered in the unrolled plane.
"""

import math
import re
from collections.abc import Collection, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.messages import Wording
from trunnion.readers.control.axis_word import PositionMode
from trunnion.readers.control.hole_motion import CycleExecutionError
from trunnion.readers.families.heidenhain.lexer import split_line, words
from trunnion.readers.families.heidenhain.parameters import KlartextError, Parameters
from trunnion.readers.families.heidenhain.path_blocks import only, read_block
from trunnion.records import dataclass

#: Arcs of rounded corners become lines that leave them by no more, mm.
CHORD: Final = 0.001

#: What the blocks of a contour take.
_OF_LINES: Final = frozenset("XYZABC") | {"R0", "RL", "RR"}


#: The labels of cycle 14, behind the text of the control.
_LABELS: Final = re.compile(r"[^0-9]*?([0-9]{1,5}(?:[ \t]*/[ \t]*[0-9]{1,5})*)[ \t]*$")


def labels_of(text: str) -> tuple[str, ...]:
    """Return the labels of the line of cycle 14."""
    match = _LABELS.fullmatch(text)
    if match is None:
        raise KlartextError(Wording("NC210", "contour_needs_labels"))
    return tuple(str(int(label)) for label in match[1].split("/"))


class ContourBlockError(CycleExecutionError):
    """A block of the contour that is not understood, with its line in the program."""

    def __init__(self, line: int, text: str, wording: Wording) -> None:
        super().__init__(wording.within("block_not_understood", text=text[:80]))
        self.line = line


@dataclass(frozen=True, slots=True)
class CylinderContour:
    """A contour on a cylinder.

    points     (n, 2) mm: length of arc at the radius of the cylinder, and the coordinate along it
    rotary     letter of the rotary axis
    along      letter of the linear axis
    side       1 for RL, -1 for RR, 0: the contour is the way of the tool's centre
    """

    points: Floats
    rotary: str
    along: str
    side: int


@dataclass(slots=True)
class _Corner:
    """What the next line makes of the corner at the last point: its size, mm; a radius, or the side of a chamfer."""

    size: float
    chamfer: bool


def read_contour(
    lines: Sequence[tuple[int, str]], parameters: Parameters, *, unit: float, arc_unit: float
) -> CylinderContour:
    """Return the contour of the lines of a label, which come with their numbers.

    unit       millimetres of a length
    arc_unit   millimetres of arc of a rotary word

    Raises ``CycleExecutionError``.
    """
    corners: list[tuple[Floats, _Corner | None]] = []
    letters = side = None
    for number, raw in lines:
        parts = split_line(raw)
        statement = parts.statement
        if not statement:
            continue
        try:
            keyword, _, rest = statement.partition(" ")
            if parts.block_skip or parts.continues:
                raise KlartextError(Wording("NC220", "not_in_cylinder_contour", word="/" if parts.block_skip else "~"))
            if statement.startswith(("RND", "CHF")):
                if not corners or corners[-1][1] is not None or len(corners) < 2:
                    raise KlartextError(Wording("NC210", "corner_between_lines", word=statement[:3]))
                corners[-1] = corners[-1][0], _corner(statement, parameters, unit)
                continue
            if keyword != "L":
                raise KlartextError(Wording("NC220", "not_in_cylinder_contour", word=keyword))
            block = read_block(words(rest), parameters)
            only(block.written, _OF_LINES, "L")
        except KlartextError as error:
            raise ContourBlockError(number, statement, error.wording) from None
        if block.side:
            if side is not None or corners:
                raise ContourBlockError(
                    number, statement, Wording("NC210", "block_takes_no", block="L", word=block.side)
                )
            side = {"RL": 1, "RR": -1, "R0": 0}[block.side]
        if letters is None:
            letters = _letters(number, statement, block.axes.keys())
        if block.axes.keys() - set(letters):
            name = min(block.axes.keys() - set(letters))
            raise ContourBlockError(number, statement, Wording("NC210", "block_takes_no", block="L", word=name))
        point = corners[-1][0].copy() if corners else np.zeros(2)
        for place, (name, scale) in enumerate(zip(letters, (arc_unit, unit), strict=True)):
            if name in block.axes:
                value, mode = block.axes[name]
                point[place] = value * scale + (point[place] if mode is PositionMode.INCREMENTAL else 0.0)
        corners.append((point, None))
    if letters is None or len(corners) < 2:
        raise CycleExecutionError(Wording("NC380", "contour_too_short"))
    if corners[-1][1] is not None:
        raise CycleExecutionError(Wording("NC380", "contour_ends_in_corner"))
    return CylinderContour(_with_corners(corners), letters[0], letters[1], side or 0)


def _letters(number: int, statement: str, names: Collection[str]) -> tuple[str, str]:
    """Return the rotary and the linear axis of the first block, which states both."""
    rotary, linear = sorted(set(names) & set("ABC")), sorted(set(names) & set("XYZ"))
    if len(rotary) != 1 or len(linear) != 1:
        raise ContourBlockError(number, statement, Wording("NC220", "cylinder_contour_axes"))
    return rotary[0], linear[0]


def _corner(statement: str, parameters: Parameters, unit: float) -> _Corner:
    """Return the corner of an RND or CHF block, which has its size alone."""
    chamfer = statement.startswith("CHF")
    block = read_block(words(statement if chamfer else statement[3:]), parameters, ("CHF",))
    only(block.written, {"CHF"} if chamfer else {"R"}, statement[:3])
    size = block.sizes.get("CHF", 0.0) if chamfer else block.radius or 0.0
    if not size > 0.0:
        raise KlartextError(Wording("NC210", "corner_needs_size", word="CHF" if chamfer else "RND R"))
    return _Corner(size * unit, chamfer)


def _with_corners(corners: Sequence[tuple[Floats, _Corner | None]]) -> Floats:
    """Return the points of a contour with its corners rounded and chamfered."""
    points = [corners[0][0]]
    free = 0.0  # how much of the line before a corner the last one has left
    for (before, _), (here, corner), (after, _) in zip(corners, corners[1:], corners[2:], strict=False):
        back, on = before - here, after - here
        lengths = float(np.hypot(*back)), float(np.hypot(*on))
        if corner is None:
            points.append(here)
            free = 0.0
            continue
        if not min(lengths) > 0.0:
            raise CycleExecutionError(Wording("NC380", "corner_without_room"))
        back, on = back / lengths[0], on / lengths[1]
        half = 0.5 * math.acos(min(max(float(back @ on), -1.0), 1.0))
        if half >= 0.5 * math.pi - 1e-9:
            points.append(here)
            free = 0.0
            continue
        if half < 1e-9:
            raise CycleExecutionError(Wording("NC380", "corner_without_room"))
        room = corner.size if corner.chamfer else corner.size / math.tan(half)
        if room > lengths[0] - free + 1e-9 or room > lengths[1] + 1e-9:
            raise CycleExecutionError(Wording("NC380", "corner_without_room"))
        points.append(here + room * back)
        if not corner.chamfer:
            points += _arc(here, (back, on), half, corner.size)
        points.append(here + room * on)
        free = room
    return np.array([*points, corners[-1][0]])


def _arc(corner: Floats, directions: tuple[Floats, Floats], half: float, radius: float) -> list[Floats]:
    """Return the points within the arc of a radius that rounds a corner; ``half`` of its angle, radians."""
    back, on = directions
    middle = back + on
    centre = corner + middle / np.hypot(*middle) * (radius / math.sin(half))
    start = corner + back * (radius / math.tan(half)) - centre
    turn = math.pi - 2.0 * half
    end = corner + on * (radius / math.tan(half)) - centre
    turn = turn if float(start[0] * end[1] - start[1] * end[0]) > 0.0 else -turn
    step = 2.0 * math.acos(max(1.0 - CHORD / radius, 0.0))
    count = max(math.ceil(abs(turn) / step), 2)
    found = []
    for k in range(1, count):
        cos, sin = math.cos(turn * k / count), math.sin(turn * k / count)
        found.append(centre + np.array([cos * start[0] - sin * start[1], sin * start[0] + cos * start[1]]))
    return found
