"""LinuxCNC takes the golden programs that are written for it."""

from pathlib import Path

import pytest

from tests.support.linuxcnc.interpreter import interpret, needs_linuxcnc
from tests.support.locations import GOLDEN

NAMES = sorted(
    f"{path.parent.name}/{path.name}"
    for folder in ("four_axis", "linuxcnc")
    for path in (GOLDEN / folder).glob("*.expected.ngc")
)


@needs_linuxcnc
@pytest.mark.parametrize("name", NAMES)
def test_linuxcnc_takes_it(name: str, tmp_path: Path) -> None:
    coordinates = "XYZA" if name.startswith("four_axis") else "XYZAC"
    canon = interpret((GOLDEN / name).read_text(encoding="utf-8"), tmp_path, coordinates)
    cuts = [move for move in canon.moves if move.kind == "line"]
    assert cuts
    assert all(move.offset and move.sense == 1 and move.feed > 0.0 for move in cuts)
    assert any(move.tcp for move in cuts) == name.startswith(("linuxcnc/blade.", "linuxcnc/plate."))
