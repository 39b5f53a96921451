"""CL files with OPSKIP around random stretches, on all machines: what is written is proven, and all else is refused."""

from pathlib import Path

import pytest

from tests.support.skipped_stretches import FILES, MACHINES, faults

#: Draws that failed their own proof once: by file and machine as ``DRAWS`` has them.
MENDED = (64, 153, 190, 256, 350, 600, 616, 670)

DRAWS = len(FILES) * len(MACHINES)


def test_what_failed_once_is_refused_or_proven(tmp_path: Path) -> None:
    assert faults(MENDED, tmp_path)[0] == []


@pytest.mark.nightly
@pytest.mark.parametrize("first", range(0, 2 * DRAWS, 65))
def test_any_stretch_is_refused_or_proven(first: int, tmp_path: Path) -> None:
    found, proven = faults(range(first, first + 65), tmp_path)
    assert found == []
    assert proven > 20
