"""What is told of a stretch in which two bodies touch: how deep they were at most, and where first."""

import numpy as np
import pytest

from trunnion.simulation.collisions.watching import _Sample, _Stretch


@pytest.mark.parametrize("change", [-0.00005, 0.00005], ids=["coming out slowly", "as deep but for rounding"])
def test_the_first_of_the_deepest_poses_is_told(change: float) -> None:
    """Each pose is less than a ten-thousandth of a millimetre from the one before."""
    samples = [_Sample(row, 1.0, float(row), np.zeros(5)) for row in range(4)]
    stretch = _Stretch(samples[0], 0.0, fine=16)
    for sample, depth in zip(samples, (0.5, 1.0, 1.0 + change, 1.0 + min(2.0 * change, 0.00008)), strict=True):
        stretch.measure(sample, depth, np.zeros(3))
    assert (stretch.worst, stretch.deepest) == (samples[1], 1.0)
