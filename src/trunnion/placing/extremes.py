"""Where slides reach farthest, for a workpiece zero: the question that cutting planes ask again and again.

In:     the forms of a path.
Out:    the least and the greatest value of each slide, and the samples that have them.

Neighbouring samples have nearly the same normals. Blocks of them are bounded by their mean normal, how far others are
off it, and their extremes at one place; only blocks whose bound is beyond what has been found are looked into.
"""

from dataclasses import field, replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Floats2, Floats3, Ints2
from trunnion.jit import kernel
from trunnion.placing.axis_equations import AxisEquations
from trunnion.records import dataclass

#: Samples of a block.
_BLOCK: Final = 64


@dataclass(frozen=True, slots=True, eq=False)
class Extremes:
    """The extremes of the slides of a path at any workpiece zero.

    forms   of its samples
    centre  (3,) mm: the place for which blocks know their extremes
    mean    (b, 3, 3) mean normals; spread (b, 3): how far normals are off them
    reach   (b, 3, 2) least and greatest values at the centre, mm
    turn    (3, 3): the part is turned by it, together with the rotary axis at ``pivot`` (3,) mm that carries it. The
            slides stand as they did for the part as it was, with the zero turned back about the pivot
    """

    forms: AxisEquations
    centre: Floats
    mean: Floats
    spread: Floats
    reach: Floats
    turn: Floats = field(default_factory=lambda: np.eye(3))
    pivot: Floats = field(default_factory=lambda: np.zeros(3))

    @staticmethod
    def of(forms: AxisEquations, centre: Floats) -> "Extremes":
        """Prepare the blocks of a path; quick near ``centre``, exact anywhere."""
        blocks = -(-len(forms) // _BLOCK)
        mean, spread, reach = np.empty((blocks, 3, 3)), np.empty((blocks, 3)), np.empty((blocks, 3, 2))
        _fill_blocks(forms.normals, forms.offsets, centre, mean, spread, reach)
        return Extremes(forms, np.array(centre), mean, spread, reach)

    def turned(self, turn: Floats, pivot: Floats) -> "Extremes":
        """Those of the part turned together with the rotary axis that carries it."""
        return replace(self, turn=turn, pivot=pivot)

    def form(self, sample: int, slide: int) -> tuple[Floats, float]:
        """Return normal (3,) and offset, mm, of a slide in a sample."""
        normal, offset = self.forms.normals[sample, slide], float(self.forms.offsets[sample, slide])
        turned = self.turn @ normal
        return turned, offset + float((normal - turned) @ self.pivot)

    def at(self, zero: Floats) -> tuple[Floats, Ints2]:
        """Least and greatest value of each slide, (3, 2) mm, and the samples that have them, (3, 2)."""
        values, samples = np.empty((3, 2)), np.empty((3, 2), np.int64)
        zero = self.pivot + self.turn.T @ (zero - self.pivot)
        _find_extremes(
            self.forms.normals, self.forms.offsets, self.centre, self.mean, self.spread, self.reach, zero, values,
            samples,
        )  # fmt: skip
        return values, samples


@kernel(writes="mean spread reach")
def _fill_blocks(
    normals: Floats3, offsets: Floats2, centre: Floats, mean: Floats3, spread: Floats2, reach: Floats3
) -> None:
    """Write the blocks of all samples."""
    for block in range(len(mean)):
        first, end = block * _BLOCK, min((block + 1) * _BLOCK, len(offsets))
        for slide in range(3):
            x, y, z = 0.0, 0.0, 0.0
            low, high = np.inf, -np.inf
            for m in range(first, end):
                a = normals[m, slide]
                x, y, z = x + a[0], y + a[1], z + a[2]
                value = a[0] * centre[0] + a[1] * centre[1] + a[2] * centre[2] + offsets[m, slide]
                low, high = min(low, value), max(high, value)
            count = end - first
            x, y, z = x / count, y / count, z / count
            widest = 0.0
            for m in range(first, end):
                a = normals[m, slide]
                dx, dy, dz = a[0] - x, a[1] - y, a[2] - z
                widest = max(widest, dx * dx + dy * dy + dz * dz)
            mean[block, slide, 0], mean[block, slide, 1], mean[block, slide, 2] = x, y, z
            # Rounding must not make a bound too narrow.
            spread[block, slide] = np.sqrt(widest) * (1.0 + 1e-9) + 1e-12
            reach[block, slide, 0], reach[block, slide, 1] = low, high


@kernel(writes="values samples")
def _find_extremes(
    normals: Floats3,
    offsets: Floats2,
    centre: Floats,
    mean: Floats3,
    spread: Floats2,
    reach: Floats3,
    zero: Floats,
    values: Floats2,
    samples: Ints2,
) -> None:
    """Write the extremes of all slides, and their samples."""
    dx, dy, dz = zero[0] - centre[0], zero[1] - centre[1], zero[2] - centre[2]
    away = np.sqrt(dx * dx + dy * dy + dz * dz)
    for slide in range(3):
        for side in range(2):
            sign = 2.0 * side - 1.0
            best, at = -np.inf, -1
            # The block of the greatest bound first, so that most others are never looked into.
            likely, bound = 0, -np.inf
            for block in range(len(mean)):
                a = mean[block, slide]
                here = sign * (reach[block, slide, side] + a[0] * dx + a[1] * dy + a[2] * dz)
                if here > bound:
                    likely, bound = block, here
            for step in range(-1, len(mean)):
                block = likely if step < 0 else step
                a = mean[block, slide]
                here = sign * (reach[block, slide, side] + a[0] * dx + a[1] * dy + a[2] * dz)
                if here + spread[block, slide] * away + 1e-9 < best:
                    continue
                for m in range(block * _BLOCK, min((block + 1) * _BLOCK, len(offsets))):
                    a = normals[m, slide]
                    value = sign * (a[0] * zero[0] + a[1] * zero[1] + a[2] * zero[2] + offsets[m, slide])
                    if value > best:
                        best, at = value, m
            values[slide, side], samples[slide, side] = sign * best, at
