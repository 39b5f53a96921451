"""A program or CL file that is read badly: the first error of each kind with their number, and what the file is."""

from pathlib import Path

import pytest

import trunnion
from trunnion.cli import main
from trunnion.errors import Problem, first_of_kinds
from trunnion.messages import Wording
from trunnion.readers.program.error_tally import ErrorTally
from trunnion.readers.program.limits import MAX_ERRORS

Capture = pytest.CaptureFixture[str]

#: A Klartext program that stands on values which only the control knows, and with a word that there is not.
KLARTEXT = (
    "BEGIN PGM A MM\nTOOL CALL 5 Z S500\nL X+0 Y+0 Z+50 R0 FMAX M3\n"
    + "".join(f"Q{k} = Q{100 + k} + 1\n" for k in range(1, 16))
    + "L X+1 KNURL\nL Z+5 F100\nM30\nEND PGM A MM\n"
)


@pytest.fixture
def program(tmp_path: Path) -> Path:
    file = tmp_path / "part.h"
    file.write_text(KLARTEXT, encoding="utf-8")
    return file


def lines_of(program: Path, text: str) -> list[str]:
    """The lines that name the program, without what follows."""
    return [line for line in text.splitlines() if line.startswith(f"{program}:")]


@pytest.mark.parametrize("command", ["verify", "convert", "diff", "view"])
def test_each_kind_stands_once_with_its_number(command: str, program: Path, capsys: Capture) -> None:
    more = {
        "convert": ["--to-machine", "yl569", "--output", str(program.parent / "out.mpf")],
        "diff": [str(program)],
        "view": ["--output", str(program.parent / "out.html")],
    }
    main([command, str(program), *more.get(command, []), "--machine", "mikron_600u"])
    said = capsys.readouterr()
    lines = lines_of(program, said.out + said.err)
    of_values = [line for line in lines if "has no value" in line]
    assert len(of_values) == 1, lines
    assert f"the first of {30 if command == 'diff' else 15} of this kind" in of_values[0]
    assert f"{program}:4:" in of_values[0]
    assert sum("KNURL" in line for line in lines) == 1
    assert "program for another control" not in said.out + said.err


def test_the_library_has_all_of_them(program: Path) -> None:
    with pytest.raises(trunnion.RefusedError) as caught:
        trunnion.convert(program, machine="mikron_600u", to_machine="yl569")
    assert sum(each.code == "NC223" for each in caught.value.problems) == 15


def test_the_rest_of_many_kinds_is_counted() -> None:
    kinds = [
        ("CL310", "number_expected"),
        ("CL340", "delay_negative"),
        ("CL715", "fedrat_0"),
        ("CL350", "end_path_without"),
    ]
    problems = [Problem("a.cls", 3 + k, Wording(*kinds[k % 4])) for k in range(40)]
    found, left = first_of_kinds([*problems, Problem("a.cls", 0, Wording("CL180", "more", more=7))], 3)
    assert [each.line for each in found] == [3, 4, 5, 0]
    assert left == 10
    assert first_of_kinds(problems[:3], 3) == (problems[:3], 0)


def test_other_words_are_other_kinds() -> None:
    def unknown(line: int, variant: str, **parameters: object) -> Problem:
        return Problem("a.nc", line, Wording("NC211", variant, **parameters))

    problems = [unknown(k, "unknown_g_word", code=f"9{k % 3}.1") for k in range(1, 13)]
    problems += [unknown(k, "unknown_word", word=f"V{k}.5") for k in range(20, 30)]
    found, left = first_of_kinds(problems, 10)
    assert [each.line for each in found] == [1, 2, 3, 20]
    assert left == 0
    assert "the first of 4 of this kind" in found[0].what
    assert "the first of 10 of this kind" in found[3].what


def test_other_names_are_other_kinds_in_lists_and_in_what_ends_a_program() -> None:
    wordings = [Wording("NC132", "unknown_or_missing", call=f"SUB{k % 2}") for k in range(6)]
    wordings += [Wording("NC220", "known_not_simulated", words=f"{word} [ X ] = {k}") for k, word in enumerate("FLFV")]
    wordings += [
        Wording("NC211", "unknown_extended_word", letter="V", extension=str(k % 2), number=k) for k in (1, 2, 3)
    ]
    found, left = first_of_kinds([Problem("a.nc", 1 + k, each) for k, each in enumerate(wordings)], 10)
    assert ([each.line for each in found], left) == ([1, 2, 7, 8, 10, 11, 12], 0)
    tally = ErrorTally()
    codes = ["91.1", "92.1"] * (MAX_ERRORS // 2)
    for each in codes[1:]:
        tally.add("a.nc", 1, Wording("NC211", "unknown_g_word", code=each))
    with pytest.raises(trunnion.InputError, match=r"G92\.1.*G91\.1"):
        tally.add("a.nc", 1, Wording("NC211", "unknown_g_word", code="93.1"))


def test_a_program_in_place_of_a_cl_file_is_named(program: Path, capsys: Capture) -> None:
    for command in (["info"], ["post", "--machine", "yl569", "--output", "-"]):
        assert main([*command[:1], str(program), *command[1:]]) == 2
        first = capsys.readouterr().err.splitlines()[0]
        assert "this is a Heidenhain Klartext program and no CL file, by BEGIN PGM in line 1" in first
        assert first.endswith("and verify proves it [CL110]")


def test_a_flood_of_a_cl_file_names_a_kind_that_comes_late(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "part.cls"
    head = "TOOL PATH/A,TOOL,D10\nLOAD/TOOL,1\nFEDRAT/MMPM,300\nGOTO/0,0,50,0,0,1\n"
    file.write_text(head + "GOTO/1,2\n" * 150 + "DELAY/-1\nEND-OF-PATH\n", encoding="utf-8")
    assert main(["info", str(file)]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert [line.rpartition("[")[2] for line in lines] == ["CL310]", "CL340]", "CL180]"]
    assert "the first of 100 of this kind" in lines[0]
