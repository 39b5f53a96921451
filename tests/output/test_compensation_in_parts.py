"""A stretch with radius compensation stays in one file: the control looks ahead in it."""

from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.output.subprograms import MIN_SUBPROGRAM_BYTES

#: What would hide that radius compensation is on: blocks that may be skipped.
SKIPPED = {
    "": "",
    "coolant": "OPSKIP/ON\nCOOLNT/MIST\nOPSKIP/OFF\n",
    "the end": "OPSKIP/ON\nCUTCOM/OFF\nGOTO/45,0,5\nOPSKIP/OFF\n",
}

#: Files of parts, and the words with which radius compensation begins and ends.
LANGUAGES = {
    "yl569": ("*.spf", "G41", "G40"),
    "dmu65": ("*.H", "RL", "R0"),
    "matsuura_mx330": ("O*.nc", "G41", "G40"),
    "xyzac_trt": ("*.ngc", "G41", "G40"),
}


@pytest.mark.third
@pytest.mark.parametrize("skipped", SKIPPED.values(), ids=SKIPPED.keys())
@pytest.mark.parametrize("machine", LANGUAGES)
def test_no_part_ends_within_compensation(machine: str, skipped: str, tmp_path: Path) -> None:
    contour = "".join(f"GOTO/{50 + k / 500:.3f},{k / 50:.3f},5\n" for k in range(1, 900))
    text = f"GOTO/20,0,5\nCUTCOM/LEFT\nGOTO/30,0,5\nGOTO/40,0,5\n{skipped}GOTO/50,0,5\n{contour}"
    cl = tmp_path / "contour.cls"
    end = "CUTCOM/OFF\nGOTO/99,0,5\n" + "".join(f"GOTO/99,{k / 50:.3f},5\n" for k in range(1, 900))
    cl.write_text(HEAD + text + end + FOOT, encoding="utf-8")
    settings = {"programs": "operations", "split": str(MIN_SUBPROGRAM_BYTES)}
    trunnion.post(cl, machine=machine, output=tmp_path / f"{machine}.x", settings=settings, force=True)
    files, on, off = LANGUAGES[machine]
    parts = [path.read_text(encoding="utf-8").split() for path in sorted(tmp_path.glob(files))]
    assert len(parts) > 1
    holders = [words for words in parts if on in words]
    assert len(holders) == 1
    last_on = len(holders[0]) - holders[0][::-1].index(on)
    assert holders[0][last_on:].count(off) >= 1 + skipped.count("CUTCOM/OFF")
