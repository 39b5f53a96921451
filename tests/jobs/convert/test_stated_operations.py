"""Settings of operations in a conversion: they do what they state, or are refused."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.errors import InputError

_CUT = "CUTCOM/LEFT\nGOTO/20,9,5\nGOTO/20,20,5\nCUTCOM/OFF\nGOTO/30,20,5\n"


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """A program with radius compensation."""
    part, found = tmp_path / "part.cls", tmp_path / "part.mpf"
    part.write_text(HEAD + _CUT + FOOT)
    assert trunnion.post(part, machine="yl569", output=found).passed
    return found


@pytest.mark.parametrize(("stated", "left"), [({}, 1), ({"compensation": "left_out"}, 0)])
def test_compensation_is_left_out_of_a_converted_program(program: Path, stated: dict[str, str], left: int) -> None:
    found = trunnion.convert(
        program, machine="yl569", to_machine="xyzac_trt", settings=stated, output=program.with_suffix(".ngc")
    )
    assert found.passed
    text = program.with_suffix(".ngc").read_text("utf-8")
    assert text.split().count("G41") == left
    assert len([each for each in found.problems if each.wording.variant == "cutcom_left_out"]) == 1 - left


@pytest.mark.parametrize("left", [False, True])
def test_and_of_a_cl_file(program: Path, left: bool) -> None:
    cl = program.with_suffix(".cls2")
    settings = {"compensation": "left_out"} if left else {}
    trunnion.convert(program, machine="yl569", to_cl=True, settings=settings, output=cl)
    assert ("CUTCOM/LEFT" in cl.read_text("utf-8")) is not left


@pytest.mark.parametrize(
    "settings", [{"open_cycle": "ends"}, {"cutcom": "contour"}, {"spindle": "NONE:900"}, {"missing_feed": "NONE:9"}]
)
def test_what_a_conversion_cannot_do_is_refused(program: Path, settings: dict[str, str]) -> None:
    with pytest.raises(InputError, match=r"CL files are read|none of that name"):
        trunnion.convert(program, machine="yl569", to_machine="dmu65", settings=settings)
