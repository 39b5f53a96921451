"""LinuxCNC programs byte for byte, as it takes them: a five-axis cut, and holes by cycles and by motion."""

from pathlib import Path

import pytest

from tests.linuxcnc.interpreter import interpret, needs_linuxcnc
from tests.verify.proven import unproven
from trunnion.cli import main

FOLDER = Path(__file__).parents[1] / "golden" / "linuxcnc"
NAMES = ("dome", "plate")


@pytest.mark.parametrize("name", NAMES)
def test_the_program_comes_out_and_is_proven(name: str, capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    asked = ["--machine", "xyzac_trt", "--output", "-", "--set", f"title={name}"]
    code = main(["post", str(FOLDER / f"{name}.cls"), *asked])
    out, err = capfdbinary.readouterr()
    told = (" made as motion", "cannot follow the feed everywhere")
    said = "".join(line for line in err.decode().splitlines(True) if not any(words in line for words in told))
    assert (code, unproven(said)) == (0, "")
    assert out == (FOLDER / f"{name}.expected.ngc").read_bytes()


@needs_linuxcnc
@pytest.mark.parametrize("name", NAMES)
def test_linuxcnc_takes_it(name: str, tmp_path: Path) -> None:
    text = (FOLDER / f"{name}.expected.ngc").read_text(encoding="utf-8")
    canon = interpret(text, tmp_path, "XYZAC")
    cuts = [move for move in canon.moves if move.kind == "line"]
    assert cuts
    assert all(move.offset and move.sense == 1 and move.feed > 0.0 for move in cuts)
    assert {move.tcp for move in cuts} == ({True} if name == "dome" else {True, False})
