"""Two G words of one group in a block are told: controls take one of them, or none."""

from pathlib import Path

import pytest

import trunnion
from tests.support.block_frames import HEADS, TAILS

#: A machine, a block, and the words that exclude each other; nothing where there are none.
BLOCKS = [
    *(
        (machine, block, told)
        for machine in ("matsuura_mx330", "haas_umc750")
        for block, told in (
            ("G28 G91 Z0. G90", "G91 and G90"), ("G90 G91", "G90 and G91"), ("G17 G18", "G17 and G18"),
            ("G54 G55", "G54 and G55"), ("G0 G1 X1. F100.", "G0 and G1"), ("G40 G41 D1", "G40 and G41"),
            ("G43 H1 G49", "G43 and G49"), ("G94 G95", "G94 and G95"), ("G61 G64", "G61 and G64"),
            ("G0 G98 G81 X1. Z-1. R1. F9.", "G0 and G81"), ("G90 G90 X1.", ""), ("G0 G80 G40 G49 G17 G90 G94", ""),
            ("G49 G53 G0 Z0.", ""),
        )
    ),
    ("xyzac_trt", "G90 G91", "G90 and G91"), ("xyzac_trt", "G28 G91 Z0 G90", "G91 and G90"),
    ("xyzac_trt", "G90 G90 X1", "G90 and G90"), ("xyzac_trt", "G28 G4 P1", "G28 and G4"),
    ("xyzac_trt", "M3 M5", "M3 and M5"), ("xyzac_trt", "M62 P0 M67 E0 Q1", "M62 and M67"),
    ("xyzac_trt", "G0 G80 G40 G49 G17 G90 G94 G64", ""), ("xyzac_trt", "G92.1 G28", ""),
    ("yl569", "G90 G91", "G90 and G91"), ("yl569", "G17 G18", "G17 and G18"), ("yl569", "G0 G1 X1 F100", "G0 and G1"),
    ("yl569", "G54 G500", "G54 and G500"), ("yl569", "G60 G64", "G60 and G64"), ("yl569", "G0 G40 G60 G601 G90", ""),
    ("hs664rt", "G90 G91", "G90 and G91"), ("hs664rt", "G17 G18", "G17 and G18"), ("hs664rt", "G90 G40 G17", ""),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "block", "told"), BLOCKS)
def test_two_words_of_one_group_in_a_block_are_an_error(tmp_path: Path, machine: str, block: str, told: str) -> None:
    program = tmp_path / "part.nc"
    program.write_text(HEADS[machine] + block + "\n" + TAILS.get(machine, "M30\n"), encoding="utf-8")
    run = trunnion.read_program(program, machine=machine)
    found = [each.text for each in run.errors if each.code == "NC212"]
    assert [told in text for text in found] == ([True] if told else [])
