"""Words of a control itself cannot be declared: the declaration would hide them from the proof."""

from pathlib import Path

import pytest

import trunnion
from tests.support.program_heads import HEADS
from trunnion.cli import main
from trunnion.errors import InputError, Severity
from trunnion.readers import check_reading, reader_of

MACHINES = sorted(HEADS)

OWN = {
    "yl569": [
        *("G91", "G01", "G54", "G64", "M5", "M30", "M6", "M3", "M17", "M70", "TRAORI", "TRAFOOF", "CYCLE800"),
        *("CYCLE81", "D", "T", "X", "F", "N450", "X100", "SUPA", "STOPRE", "ROT", "MCALL", "IF", "G17 G91"),
    ],
    "mikron_600u": [
        *("L", "LN", "L X", "M91", "M128", "M129", "M140", "M30", "M3", "M13", "TOOL CALL", "PLANE RESET", "FN 18"),
        *("CYCL DEF 7", "CYCL DEF 200", "CYCL DEF 32", "CYCL DEF", "CALL LBL 1", "CALL PGM", "FUNCTION TCPM", "Q1"),
        *("TCH", "CC", "FMAX", "R0", "X", "M120", "M114"),
    ],
    "matsuura_mx330": [
        *("G91", "G00", "G1", "G43.4", "G68.2", "G53.1", "G5.1", "G65", "M98", "M99", "M30", "M6", "M03", "M8"),
        *("X", "F", "N450", "T", "O1", "GOTO 5", "IF", "G91 G28", "G51", "G28"),
    ],
    "xyzac_trt": ["G91", "G0", "G43.4 H1", "G43", "M428", "M429", "M61", "M60", "M2", "M30", "X", "F", "O100", "M70"],
    "hs664rt": ["G91", "G0", "G96", "G196", "G154", "G55", "M306", "M242", "M30", "X", "T", "G290"],
}

#: Words of builders and shops, and calls of programs by their names.
DECLARED = {
    "yl569": ["M82", "L9906", "CYCLE977", "CALL MESS", "EXTCALL MESS", "G810", "M7777", "CLAMP"],
    "mikron_600u": ["M202", "M60", "CYCL DEF 392", "CYCL DEF 251", "CALL PGM MESS", "FUNCTION DCM", "TCH PROBE 400"],
    "matsuura_mx330": ["M60", "G187", "G65 P9810", "M98 P9001", "G399.1", "M11"],
    "xyzac_trt": ["M101", "M160", "G187", "O100 CALL"],
    "hs664rt": ["M60", "G901", "G187.5"],
}


#: What a Sinumerik reserves for the builder is no word of its own.
BUILDERS = {f"G{code}" for code in (810, 811, 812, 813, 814, 820, 821, 822, 823, 824)}


def definition(folder: Path, base: str, *lines: str, table: str = "known") -> Path:
    file = folder / "machine.toml"
    file.write_text("\n".join([f'extends = "{base}"', f"[control.{table}]", *lines, ""]), encoding="utf-8")
    return file


def not_own(machine: str, own: list[str]) -> list[str]:
    return [word for word in own if not (machine == "xyzac_trt" and word.startswith("G43.4"))]


@pytest.mark.parametrize("machine", MACHINES)
def test_own_words_are_refused_with_key_and_line(
    machine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = not_own(machine, OWN[machine])
    file = definition(tmp_path, machine, *(f'"{word}" = "no effect"' for word in words))
    assert main(["check", str(file)]) == 2
    assert f"{file}:3: error: " in capsys.readouterr().err
    with pytest.raises(InputError) as refused:
        check_reading(trunnion.load_machine(file))
    for line, word in enumerate(words, 3):
        found = next((str(each) for each in refused.value.problems if each.line == line), "")
        assert "is a word of the control itself" in found, word
        assert word in found


@pytest.mark.parametrize("machine", MACHINES)
def test_other_words_can_be_declared(machine: str, tmp_path: Path) -> None:
    file = definition(tmp_path, machine, *(f'"{word}" = "no effect"' for word in DECLARED[machine]))
    assert main(["check", str(file)]) == 0


@pytest.mark.parametrize("machine", MACHINES)
def test_the_library_refuses_them_when_the_definition_is_loaded(machine: str, tmp_path: Path) -> None:
    file = definition(tmp_path, machine, 'M30 = "no effect"')
    program, cl = tmp_path / "part.nc", tmp_path / "part.cls"
    program.write_text("", encoding="utf-8")
    for run in (
        lambda: trunnion.verify(program, machine=file),
        lambda: trunnion.post(cl, machine=file),
        lambda: trunnion.read_program(program, machine=file),
        lambda: trunnion.convert(program, machine=machine, to_machine=file),
    ):
        with pytest.raises(InputError, match="M30 is a word of the control itself"):
            run()


@pytest.mark.parametrize("machine", MACHINES)
def test_the_reader_understands_no_code_that_can_be_declared(machine: str, tmp_path: Path) -> None:
    """The list of own words misses none: each other code is an error of the reader, or an event of the builder."""
    loaded = trunnion.load_machine(machine)
    is_own = reader_of(loaded).is_own_word
    codes = [f"M{code}" for code in range(1000)] + [f"G{code}" for code in range(1000)]
    codes += [f"G{code}.{tenth}" for code in range(100) for tenth in range(1, 10)] if machine != "yl569" else []
    if machine == "mikron_600u":
        codes = [code for code in codes if code[0] == "M"]
    free = [code for code in codes if not is_own(code)]
    assert len(free) > 500
    head, tail = HEADS[machine].split("{lines}")
    program = tmp_path / "part.nc"
    program.write_text(head + "\n".join(free) + tail, encoding="utf-8")
    run = trunnion.read_program(program, machine=machine)
    first = head.count("\n") + 1
    told = {finding.line for finding in run.diagnostics}
    builder = {f"M{event.value:g}" for event in run.events if event.kind == "m"}
    missed = [code for line, code in enumerate(free, first) if line not in told and code not in builder]
    assert set(missed) <= BUILDERS


def test_a_word_that_a_control_does_not_have_can_be_declared(tmp_path: Path) -> None:
    file = tmp_path / "machine.toml"
    lines = 'extends = "matsuura_mx330"\n[control.reading.words]\nM7 = "unknown"\n[control.known]\nM7 = "no effect"\n'
    file.write_text(lines, encoding="utf-8")
    check_reading(trunnion.load_machine(file))


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ('M60 = "no effect"\nm60 = "stop"', "control.known.m60 says the same as 'M60'"),
        ('M60 = "no effect"\nM060 = "stop"', "control.known.M060 says the same as 'M60'"),
        ('G0901 = "stop"', "write G901"),
        ('"" = "stop"', "control.known has a word without letters"),
    ],
)
def test_entries_that_can_never_act_are_refused(line: str, what: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=what):
        check_reading(trunnion.load_machine(definition(tmp_path, "hs664rt", line)))


@pytest.mark.parametrize("machine", ["matsuura_mx330", "xyzac_trt", "hs664rt"])
@pytest.mark.parametrize("line", ['G234 = "G987"', 'M60 = "M777"', 'G1 = "G0"', 'M60 = "G54"'])
def test_words_that_mean_nothing_are_refused(
    machine: str, line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", str(definition(tmp_path, machine, line, table="reading.words"))]) == 2
    assert f"machine.toml:3: error: control.reading.words.{line.split()[0]} is " in capsys.readouterr().err


@pytest.mark.parametrize("machine", ["yl569", "mikron_600u"])
def test_readers_without_such_words_refuse_them(
    machine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["check", str(definition(tmp_path, machine, 'G234 = "G54"', table="reading.words"))]) == 2
    assert "machine.toml:" in capsys.readouterr().err


def test_smoothing_of_a_fanuc_can_be_declared(tmp_path: Path) -> None:
    file = definition(tmp_path, "matsuura_mx330", '"G5.1 Q3" = "no effect: nano smoothing within 0.01 mm"')
    program = tmp_path / "part.nc"
    program.write_text(HEADS["matsuura_mx330"].format(lines="G05.1 Q3 X0 Y0 Z0\nG5.1Q3\nG05.1 Q2"), encoding="utf-8")
    errors = trunnion.read_program(program, machine=file).errors
    assert [error.text.split(" smooths")[0] for error in errors] == ["G5.1 Q2"]


def test_a_code_with_tenths_is_another_word(tmp_path: Path) -> None:
    file = definition(tmp_path, "matsuura_mx330", 'G187 = "no effect"')
    program = tmp_path / "part.nc"
    program.write_text(HEADS["matsuura_mx330"].format(lines="G187.1"), encoding="utf-8")
    errors = trunnion.read_program(program, machine=file).errors
    assert [error.severity for error in errors] == [Severity.ERROR]
