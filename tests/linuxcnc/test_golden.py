"""LinuxCNC takes the golden programs that are written for it."""

from pathlib import Path

import pytest

from tests.support.linuxcnc.interpreter import interpret, needs_linuxcnc
from tests.support.locations import GOLDEN

NAMES = sorted(path.name for path in (GOLDEN / "linuxcnc").glob("*.expected.ngc"))


@needs_linuxcnc
@pytest.mark.parametrize("name", NAMES)
def test_linuxcnc_takes_it(name: str, tmp_path: Path) -> None:
    canon = interpret((GOLDEN / "linuxcnc" / name).read_text(encoding="utf-8"), tmp_path, "XYZAC")
    cuts = [move for move in canon.moves if move.kind == "line"]
    assert cuts
    assert all(move.offset and move.sense == 1 and move.feed > 0.0 for move in cuts)
    assert any(move.tcp for move in cuts) == name.startswith(("blade.", "plate."))
