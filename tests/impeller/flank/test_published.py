"""Published ruled blades: what a path leaves of the better side is at most what others reached, by the slow measure."""

import pytest

from tests.support.flanks import PUBLISHED, mill

#: Greatest overcut and undercut, mm; benchmarks/flank.py has the other surfaces.
BOUNDS = {"default": (1.0, 0.122)}


@pytest.mark.nightly
@pytest.mark.parametrize("name", BOUNDS)
def test_what_is_left_is_within_the_bound(name: str) -> None:
    side, bound = BOUNDS[name]
    cut = mill(PUBLISHED[name], side)
    assert cut.left.largest <= bound
    assert cut.left.largest < cut.begun.largest
