"""The setting first_block, and corners of BLK FORM without a minus before zero."""

import re
from pathlib import Path

import pytest

from tests.support.posting import FOOT, HEAD
from tests.support.proof import unproven
from trunnion.cli import main
from trunnion.controls import load_control
from trunnion.machines import load_machine
from trunnion.output.families.heidenhain import writer as heidenhain


@pytest.mark.parametrize(("name", "step"), [("yl569", 10), ("matsuura_mx330", 10), ("hs664rt", 10)])
def test_blocks_are_numbered_from_it_by_the_step_of_the_control(
    name: str, step: int, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(HEAD + FOOT, encoding="utf-8")
    code = main(["post", str(cl), "--machine", name, "--output", "-", "--set", "first_block=107"])
    out, err = capfd.readouterr()
    found = [int(number) for number in re.findall(r"(?m)^N(\d+)", out)]
    assert (code, unproven(err)) == (0, "")
    assert found == list(range(107, 107 + step * len(found), step))


@pytest.mark.parametrize("number", ["-1", "2.5", "99999990", "one"])
def test_a_number_from_which_blocks_cannot_be_counted_is_refused(
    number: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(HEAD + FOOT, encoding="utf-8")
    assert main(["post", str(cl), "--machine", "yl569", "--output", "-", "--set", f"first_block={number}"]) != 0
    assert "first_block" in capfd.readouterr().err


@pytest.mark.parametrize("low", ["-0", "-0.0", "-0.00001", "0"])
def test_no_corner_of_a_block_form_is_minus_zero(low: str) -> None:
    settings = {**load_control(load_machine("dmu65").control).settings, "blank": f"{low},-5,-7.5,10,-0.0,0.00004"}
    said = heidenhain.template_values(settings, None)
    assert (said["blank_low"], said["blank_high"]) == ("X+0 Y-5 Z-7.5", "X+10 Y+0 Z+0")
