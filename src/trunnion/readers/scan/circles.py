"""Circles of plain blocks, between the two steps of a scan; what is odd about one is left to the interpreter."""

import math
from typing import Final

from trunnion.arrays import Floats
from trunnion.jit import kernel
from trunnion.readers.scan.buffers import (
    CENTRE,
    MOTION_BITS,
    ROTARY_BITS,
    SLIDE,
    VECTOR_BITS,
    BlockWords,
    ScannedCircles,
)

#: Radii at start and end that differ by less, mm, make a circle on every control.
_SAME_RADIUS: Final = 0.004

#: A circle that ends nearer to its start than this, mm, and not there, is odd, and so is one of a smaller radius.
_NEAR: Final = 0.01

_LINE: Final = 1


@kernel(writes="circles")
def find_circles(
    count: int, words: BlockWords, length_unit: float, plane: int, turned: bool, start: Floats, circles: ScannedCircles
) -> tuple[int, int]:
    """Work out the circles of ``count`` blocks; returns the blocks before the first odd one, and their circles.

    length_unit  mm of a programmed length
    plane        the axis normal to the plane of the circles
    turned       circles stay circles where rotary axes turn on the way; else one behind a turn is odd
    start        (3,) programmed position before the first block, mm
    """
    x, y, z = start[0], start[1], start[2]
    u, v = (plane + 1) % 3, (plane + 2) % 3
    found = row = 0
    turns = False
    for block in range(count):
        seen = words.seen[block]
        here = (x, y, z)
        if seen & (1 << SLIDE):
            x = words.values[block, SLIDE] * length_unit
        if seen & (1 << (SLIDE + 1)):
            y = words.values[block, SLIDE + 1] * length_unit
        if seen & (1 << (SLIDE + 2)):
            z = words.values[block, SLIDE + 2] * length_unit
        if not seen & MOTION_BITS:
            continue
        turns = turns or seen & (ROTARY_BITS | VECTOR_BITS) != 0
        if words.kind[block] > _LINE:
            there = (x, y, z)
            i = words.values[block, CENTRE + u] * length_unit if seen & (1 << (CENTRE + u)) else 0.0
            j = words.values[block, CENTRE + v] * length_unit if seen & (1 << (CENTRE + v)) else 0.0
            about_u, about_v = here[u] + i, here[v] + j
            radius = math.hypot(here[u] - about_u, here[v] - about_v)
            at_end = math.hypot(there[u] - about_u, there[v] - about_v)
            chord = math.hypot(there[u] - here[u], there[v] - here[v])
            if (
                (turns and not turned)
                or not radius > _NEAR
                or not abs(at_end - radius) < _SAME_RADIUS
                or 0.0 < chord < _NEAR
            ):
                return block, found
            circles.block[found] = block
            circles.row[found] = row
            for axis in range(3):
                circles.start[found, axis] = here[axis]
                circles.centre[found, axis] = here[axis]
            circles.centre[found, u] = about_u
            circles.centre[found, v] = about_v
            circles.radius[found] = radius
            found += 1
        row += 1
    return count, found
