"""``diff`` compares what programs leave on, the words that retract, and how the tool axis turns between points."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS, YL569

CASES = TESTS / "data" / "cases"

#: Words before the end of a program that leave something on, by machine.
LEFT = [
    ("yl569", "TRANS X1"), ("yl569", "ROT Z5"), ("yl569", "TRAORI"), ("matsuura_mx330", "G92 X10."),
    ("matsuura_mx330", "G55"), ("matsuura_mx330", "G91"), ("haas_umc750", "G55"), ("hs664rt", "G91"),
    ("xyzac_trt", "G92 X10"), ("dmu65", "M136"),
]  # fmt: skip


def posted(machine: str, folder: Path) -> list[str]:
    program = folder / "one.nc"
    trunnion.post(CASES / "tilted_flood.cls", machine=machine, output=program)
    return program.read_text(encoding="utf-8").splitlines()


def another(folder: Path, lines: list[str]) -> Path:
    file = folder / "other.nc"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


@pytest.mark.third
@pytest.mark.parametrize(("machine", "word"), LEFT)
def test_what_a_program_leaves_on_is_a_difference(machine: str, word: str, tmp_path: Path) -> None:
    lines = posted(machine, tmp_path)
    end = next(k for k in range(len(lines) - 1, 0, -1) if lines[k].split()[-1] in ("M30", "M2", "M02"))
    number = f"{lines[end].split()[0]} " if lines[end][0].isdigit() else ""
    other = another(tmp_path, [*lines[:end], number + word, *lines[end:]])
    assert not trunnion.diff(tmp_path / "one.nc", other, machine=machine).same
    both = another(tmp_path, lines)
    assert trunnion.diff(tmp_path / "one.nc", both, machine=machine).same


def test_a_second_program_in_the_file_is_a_difference(tmp_path: Path) -> None:
    lines = posted("matsuura_mx330", tmp_path)
    other = another(tmp_path, [*lines[:-1], "O0002", "G0 X10.", "M30", "%"])
    found = trunnion.diff(tmp_path / "one.nc", other, machine="matsuura_mx330")
    assert not found.same
    assert "stands behind the end of the program" in found.unknown_words[0]


def test_a_retract_that_is_left_out_is_a_difference(tmp_path: Path) -> None:
    lines = posted("hs664rt", tmp_path)
    at = [k for k, line in enumerate(lines) if "M242" in line]
    assert len(at) > 3
    for k in at:
        other = another(tmp_path, lines[:k] + lines[k + 1 :])
        assert not trunnion.diff(tmp_path / "one.nc", other, machine="hs664rt").same


def test_how_the_tool_axis_turns_between_points_is_a_difference(tmp_path: Path) -> None:
    program = YL569 / "3_blade_finish.expected.mpf"
    text = program.read_text(encoding="utf-8")
    other = another(tmp_path, text.replace("ORIAXES", "ORIVECT").splitlines())
    found = trunnion.diff(program, other, machine="yl569")
    assert found.first is not None
    assert found.first.text.startswith("rotary axes turn evenly between points against the tool axis turns on a great")
    # Where the tool axis stays the word makes no difference.
    plane = YL569 / "1_contour_rough.expected.mpf"
    level = plane.read_text(encoding="utf-8").replace("G54", "ORIVECT\nG54", 1)
    assert trunnion.diff(plane, another(tmp_path, level.splitlines()), machine="yl569").same


#: CL files, machines, words of their programs, and what takes their place: the path stays.
CONDITIONS = [
    (TESTS / "golden" / "hs664rt" / "radial_holes.cls", "hs664rt", "N120 G71\n", "", "in mm or inches"),
    (TESTS / "golden" / "fanuc" / "flange.cls", "matsuura_mx330", "G21 G17", "G17", "in mm or inches"),
    (YL569 / "1_contour_rough.cls", "yl569", "N310 M6", "N305 M3 S500\nN310 M6", "tool change while the spindle"),
    (YL569 / "3_blade_finish.cls", "yl569", "D1 M3\n", "D1 M4 M3\n", "one block turns the spindle"),
    (CASES / "contour.cls", "matsuura_mx330", "N280 M3\nN290 M8\n", "N280 M3\n", "coolant flood after a stop"),
    (CASES / "contour.cls", "yl569", "N710 Z5. M3 M8\n", "N710 Z5. M8\n", "spindle clockwise after a stop"),
    (CASES / "contour.cls", "hs664rt", "M9\nN", "M8\nN", "tool change while coolant flows (flood)"),
    (CASES / "contour.cls", "yl569", " G710", "", "relies on G71, which it does not say"),
    (CASES / "contour.cls", "dmu65", "L Z+560 R0 FMAX M91", "L Z+560 R0 FMAX M92", "the builder has set M92"),
    (CASES / "contour.cls", "yl569", "N280 SUPA G0 Z=_Z_HOME D0\n", "", "not stated yet against"),
    (CASES / "contour.cls", "dmu65", "L Z+560 R0 FMAX M91", "M5", "not stated yet against"),
    (CASES / "contour.cls", "matsuura_mx330", "G49 G53 G0 Z0.", "G49", "not stated yet against"),
    (CASES / "contour.cls", "haas_umc750", "G49 G53 G0 Z0.", "G49", "not stated yet against"),
    (CASES / "contour.cls", "xyzac_trt", "G53 G0 Z0.", "G0", "not stated yet against"),
    (CASES / "contour.cls", "xyzac_trt", "G0 A0. C0.\n", "G0 A0.\n", "axis C: stated in G54 against stated"),
    (CASES / "tilted.cls", "generic_head_table_bc", "N620 CYCLE800()\n", "", "while a tilted plane is on"),
]  # fmt: skip


@pytest.mark.third
@pytest.mark.parametrize(("source", "machine", "words", "others", "what"), CONDITIONS)
def test_conditions_that_the_path_does_not_show_are_differences(
    source: Path, machine: str, words: str, others: str, what: str, tmp_path: Path
) -> None:
    one, two = tmp_path / "one.nc", tmp_path / "two.nc"
    trunnion.post(source, machine=machine, output=one)
    text = one.read_text(encoding="utf-8")
    assert words in text
    two.write_text(text.replace(words, others, 1), encoding="utf-8")
    found = trunnion.diff(one, two, machine=machine)
    assert found.first is not None
    assert what in found.first.text
    assert not found.same


def test_a_spindle_that_turns_while_rotary_axes_are_positioned_is_a_difference(tmp_path: Path) -> None:
    program = TESTS / "golden" / "hs664rt" / "radial_holes.expected.txt"
    lines = program.read_text(encoding="utf-8").splitlines()
    at = max(k for k, line in enumerate(lines) if line.endswith(" M5"))
    for changed in ([*lines[:at], *lines[at + 1 :]], [*lines[:at], f"/{lines[at]}", *lines[at + 1 :]]):
        found = trunnion.diff(program, another(tmp_path, changed), machine="hs664rt")
        assert found.first is not None
        assert "rotary axes are positioned while the spindle turns clockwise" in found.first.text


def test_a_tool_that_is_put_away_at_the_end_is_compared(tmp_path: Path) -> None:
    program = YL569 / "1_contour_rough.expected.mpf"
    lines = program.read_text(encoding="utf-8").splitlines()
    assert [line.split()[-1] for line in lines[-3:]] == ["T0", "M6", "M30"]
    for last in ([lines[-1]], [lines[-3], f"/{lines[-2]}", lines[-1]]):
        found = trunnion.diff(program, another(tmp_path, [*lines[:-3], *last]), machine="yl569")
        assert found.first is not None
        assert found.first.text.startswith("change to tool 0 behind the last motion")
