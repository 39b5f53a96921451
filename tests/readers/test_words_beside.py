"""Declared words without effect among the other words of a block."""

from pathlib import Path

import pytest

import trunnion
from tests.support.program_heads import HEADS
from trunnion.model.run import Run
from trunnion.readers.registry import reader_of

#: By machines: a word, and blocks of every kind that a code of theirs begins, with a word that takes their positions.
BLOCKS = {
    "matsuura_mx330": ("G187", ["G91", "G1 X20. F100.", "M5", "T2 M6", "G20", "G0 G90 X5.", "G2 X10. Y0. I5. J0. F50.",
                                "G94 G91 G1 X3. F50.", "G28 Z0.", "G53 G0 Z0.", "G4 P100", "S2000 M4", "F200.", "G55",
                                "G81 X5. Y5. Z-5. R2. F50.", "G80", "G10 L2 P1 X0. Y0. Z0.", "#1=5", "N10 G1 X7."]),
    "xyzac_trt": ("G187", ["G91", "G1 X20. F100.", "M5", "T2 M6", "G20", "G0 G90 X5.", "G2 X10. Y0. I5. J0. F50.",
                           "G28 Z0", "G53 G0 Z0", "G4 P1", "S2000 M4", "F200", "G55", "G81 X5 Y5 Z-5 R2 F50", "G80",
                           "#1=5", "G10 L2 P1 X0 Y0 Z0"]),
    "hs664rt": ("G901", ["G91", "G1 X20. F100.", "M5", "G0 X5. Y5.", "S2000 M4", "F200.", "G55 O2", "G80"]),
    "yl569": ("TUNED", ["G91", "G1 X20 F100", "M5", "T2 M6", "G70", "G0 G90 X5 Y5", "G2 X10 Y0 I5 J0 F50", "G4 F1",
                        "S2000 M4", "F200", "G55", "TRANS X5", "SUPA G0 Z0 D0", "R1=5", "N10 G1 X7 F50", "ROT Z45"]),
    "mikron_600u": ("M202", ["L X+20 F100", "M5", "L X+5 Y+5 R0 FMAX M4", "CC X+0 Y+0", "M140 MB5"]),
}  # fmt: skip


def run_of(folder: Path, base: str, known: str, lines: str) -> Run:
    (folder / "machine.toml").write_text(f'extends = "{base}"\n[control.known]\n{known}\n')
    (folder / "part.nc").write_text(HEADS[base].format(lines=lines))
    return trunnion.read_program(folder / "part.nc", machine=folder / "machine.toml")


def everything(run: Run) -> str:
    columns = (run.tip, run.kind, run.spindle, run.tool, run.feed, run.work_offset, run.machine_frame)
    events = [(each.before_row, each.kind, each.value) for each in run.events]
    events = [each for each in events if each[1] != "known" and each[1:] != ("m", 202.0)]
    return repr(([column.tolist() for column in columns], events, [error.text for error in run.errors]))


@pytest.mark.third
@pytest.mark.parametrize(("base", "block"), [(base, block) for base, own in BLOCKS.items() for block in own[1]])
def test_a_word_without_effect_takes_only_itself_out_of_a_block(base: str, block: str, tmp_path: Path) -> None:
    word = BLOCKS[base][0]
    known = f'{word} = "no effect"'
    plain = everything(run_of(tmp_path, base, known, block))
    parts = block.split(" ")
    first = 1 if parts[0].startswith("N") else 0
    places = range(first, len(parts) + 1) if base != "mikron_600u" and parts[0] != "M140" else (0, len(parts))
    for k in {first, first + (len(parts) - first) // 2, len(parts)} & set(places):
        line = " ".join((*parts[:k], word, *parts[k:]))
        assert everything(run_of(tmp_path, base, known, line)) == plain, line


@pytest.mark.parametrize(
    ("base", "known", "line"),
    [
        ("matsuura_mx330", 'G187 = "no effect"', "G187 X20."),
        ("matsuura_mx330", 'G187 = "no effect"', "X20. G187"),
        ("matsuura_mx330", 'G187 = "no effect"', "G90 G187 X20."),
        ("matsuura_mx330", 'G187 = "no effect"', "G187 P1 G1 X20. F50."),
        ("matsuura_mx330", '"G187 P1" = "no effect"', "G187 P1 X20."),
        ("matsuura_mx330", 'G187 = "comes back"', "G187 G91"),
        ("matsuura_mx330", '"G65 P9810" = "no effect"', "G65 P9810 G91"),
        ("matsuura_mx330", '"M98 P9810" = "no effect"', "M98 P9810 G91"),
        ("xyzac_trt", 'G187 = "no effect"', "G187 A20."),
        ("hs664rt", 'G901 = "no effect"', "G901 X20."),
        ("yl569", 'G187 = "no effect"', "G187 X20"),
        ("yl569", 'TUNED = "no effect"', "G90 TUNED X=20"),
        ("mikron_600u", 'TUNED = "no effect"', "TUNED L X+20"),
        ("mikron_600u", 'TUNED = "no effect"', "TUNED M5"),
    ],
)
def test_of_positions_and_codes_that_may_be_hidden_is_an_error(
    base: str, known: str, line: str, tmp_path: Path
) -> None:
    assert run_of(tmp_path, base, known, line).errors


@pytest.mark.parametrize(
    ("base", "known", "line"),
    [
        ("matsuura_mx330", 'G187 = "no effect"', "N5 G187 P1 E0.01 (SMOOTH)"),
        ("matsuura_mx330", '"G187 P1" = "no effect"', "G91G187P1"),
        ("matsuura_mx330", '"G65 P9810" = "no effect"', "G65 P9810 X1. Z-5. F100."),
        ("yl569", 'TUNED = "no effect"', 'TUNED(1,"A)",AC(2))'),
        ("yl569", 'TUNED = "no effect"', "GOTOF TUNED\nTUNED: M5"),
        ("yl569", 'TUNED = "no effect"', "TUNED=0.5 M5"),
    ],
)
def test_a_word_has_its_own_arguments(base: str, known: str, line: str, tmp_path: Path) -> None:
    assert not run_of(tmp_path, base, known, line).errors


def test_raw_text_hides_no_code_behind_a_declared_word(tmp_path: Path) -> None:
    machine = run_of(tmp_path, "matsuura_mx330", 'G187 = "no effect"', "G187 P1").machine
    words = reader_of(machine).raw_words
    assert words.not_known("G187 P1", machine) == ""
    assert words.not_known("G187 G91", machine)
