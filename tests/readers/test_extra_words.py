"""Words that a block of an ISO control has no use for: none is dropped without a word about it."""

from pathlib import Path

import pytest

from tests.support.extra_words import without_use
from tests.support.haas import HEAD, errors, read
from tests.support.program_heads import HEADS
from trunnion.machines import load_machine
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions

TAIL = "X8.\nG1 Y1. F100.\nZ5.\n"
FRAMES = {
    **{name: HEADS[name] for name in ("matsuura_mx330", "xyzac_trt", "hs664rt")},
    "haas_umc750": f"{HEAD}{{lines}}\nG1 Z5. F100.\nM30\n%\n",
}
WORDS = "X77. A5. C5. M5 M0 M9 M30 M4 F800. S700 T6 I3. J3. K3. R3. P5 P0.4 Q5. L2 D9 B5. U5. G91 G20 G95 G28 O5 FOO"
OF_ALL = (
    "G1 X10. F100.", "G0 X10.", "G53 G0 Z0.", "S600 M3", "F200.", "M8", "M0", "G40", "G17", "T6", "G43 H5 Z50.", "#1=5",
    "G81 G98 X5. Y5. Z-5. R2. F50.", "G98 G83 X5. Z-5. R2. Q2. F50.", "G98 G73 X5. Z-5. R2. Q2. F50.",
    "G98 G85 X5. Z-5. R2. F50.", "G41 D5 G1 X20. F100.",
)  # fmt: skip
OF_FANUC = (
    "IF[1EQ1]GOTO149|\nN149", "IF[1EQ2]GOTO149|\nN149", "IF[1EQ1]THEN#1=5", "IF[1EQ2]THEN#1=5", "GOTO149|\nN149",
    "WHILE[1EQ2]DO3|\nEND3", "#1=1\nWHILE[#1EQ1]DO3\n#1=2\nEND3|", "G61", "G64", "G98 G76 X5. Z-5. R2. Q1. F50.",
)  # fmt: skip
FORMS = {
    "matsuura_mx330": (*OF_ALL, *OF_FANUC, "G98 G82 X5. Z-5. R2. P300 F50.", "G98 G84 X5. Z-5. R2. F50.", "G4 P100",
                       "G98 G86 X5. Z-5. R2. F50.", "G98 G89 X5. Z-5. R2. P300 F50.", "G92 X0."),
    "haas_umc750": (*OF_ALL, *OF_FANUC, "G98 G82 X5. Z-5. R2. P0.3 F50.", "G98 G89 X5. Z-5. R2. P0.3 F50.", "G4 P100"),
    "xyzac_trt": (*OF_ALL, "G98 G82 X5. Z-5. R2. P0.3 F50.", "G98 G84 X5. Z-5. R2. F50.", "G4 P1", "G64 P0.1",
                  "G98 G89 X5. Z-5. R2. P0.3 F50."),
    "hs664rt": ("G1 X10. F100.", "G0 X10.", "S600 M3", "F200.", "G55 O2", "M8", "M0", "G40", "G17", "G90",
                "G81 X5. Y5. Z50. E-5. R2. F50.",
                "G85 X5. Y5. Z50. E-5. R2. F50."),
}  # fmt: skip


@pytest.mark.parametrize("machine", FORMS)
def test_no_extra_word_is_dropped(machine: str, tmp_path: Path) -> None:
    foot = dict.fromkeys(("G1 Z5. F100.\n", "G1 Z5. F100\n", "G1 Z5 F100\n"), TAIL)
    frame = FRAMES[machine]
    for old, new in foot.items():
        frame = frame.replace(old, new)
    dropped, faulty, count = without_use(tmp_path, machine, frame, dict.fromkeys(FORMS[machine], WORDS.split()))
    assert (dropped, faulty) == ({}, [])
    assert count == len(FORMS[machine]) * len(WORDS.split())


@pytest.mark.parametrize(
    ("line", "is_error"),
    [
        ("IF[1EQ2]GOTO#7\nN149", False),
        ("IF[1EQ2]GOTO[#7+1]\nN149", False),
        ("IF[1EQ2]GOTO[#7+1]M5\nN149", True),
        ("IF[#7EQ#0]THEN#3=[1+2]*SIN[30.]-#5/2", False),
        ("IF[1EQ2]THEN#3=[1+2]*SIN[30.]-#[#5]MOD2", False),
        ("IF[1EQ2]THEN#3=[1+2]*SIN[30.]M5", True),
        ("G98 G81 X5. Z-5. R2. P0 Q0 F50.\nG80", False),
        ("G98 G81 X5. Z-5. R2. L1 F50.\nG80", False),
        ("G98 G81 X5. Z-5. R2. L2 F50.\nG80", True),
        ("G98 G83 X5. Z-5. R2. Q2. P400 F50.\nG80", True),
        ("G98 G81 G53 X5. Z-5. R2. F50.\nG80", True),
        ("G98 G81 G54.1 P2 X5. Z-5. R2. F50.\nG80", False),
    ],
)
def test_on_a_fanuc(line: str, is_error: bool, tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_text(HEADS["matsuura_mx330"].format(lines=line))
    run = run_program(tmp_path / "part.nc", load_machine("matsuura_mx330"))
    assert bool(run.errors) == is_error, run.diagnostics


@pytest.mark.parametrize("cycle", ["G83", "G73"])
def test_a_haas_dwells_behind_the_last_peck(cycle: str, tmp_path: Path) -> None:
    run = read(tmp_path, f"G98 {cycle} X5. Z-5. R2. Q4. P0.4 F50.\nX9.\nG80")
    assert not run.errors
    assert [event.value for event in run.events if event.kind == "dwell"] == [0.4, 0.4]
    assert not [
        each for each in read(tmp_path, f"G98 {cycle} X5. Z-5. R2. Q4. F50.\nG80").events if each.kind == "dwell"
    ]


def test_a_dwell_of_another_cycle_is_none_of_pecks(tmp_path: Path) -> None:
    run = read(tmp_path, "G98 G82 X5. Z-5. R2. P0.4 F50.\nG98 G83 X9. Z-5. R2. Q4. F50.\nG80")
    assert [event.value for event in run.events if event.kind == "dwell"] == [0.4]
    assert errors(tmp_path, "G98 G81 X5. Z-5. R2. P0.4 F50.\nG80")


@pytest.mark.parametrize("line", ["G65 P9 X7. M5 M9", "G66 P9 X7. M5 M9\nG67", "G65 P9 X7. G4", "G65 P9 X7. G54.1"])
def test_a_macro_call_takes_no_other_codes(line: str, tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_text(HEADS["matsuura_mx330"].format(lines=line))
    (tmp_path / "O0009.nc").write_text("%\nO0009\nG1 X#24 F100.\nM99\n%\n")
    options = RunOptions(subprograms=[tmp_path / "O0009.nc"])
    assert run_program(tmp_path / "part.nc", load_machine("matsuura_mx330"), options).errors


def test_modes_beside_a_macro_call_hold_in_it(tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_text(HEADS["matsuura_mx330"].format(lines="G90 G65 P9 X7.\nG91 G65 P9 X7.\nG90"))
    (tmp_path / "O0009.nc").write_text("%\nO0009\nG1 X#24 F100.\nM99\n%\n")
    options = RunOptions(subprograms=[tmp_path / "O0009.nc"])
    run = run_program(tmp_path / "part.nc", load_machine("matsuura_mx330"), options)
    assert not run.errors
    assert run.tip[:, 0].tolist() == [0.0, 7.0, 14.0, 14.0]
