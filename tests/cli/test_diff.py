"""``trunnion diff``: the same motion in other words is the same."""

import re
from pathlib import Path

import pytest

from tests.support.locations import YL569
from trunnion.cli import main

PROGRAM = YL569 / "3_blade_finish.expected.mpf"
ARCS = YL569 / "1_contour_rough.expected.mpf"
TEXT = PROGRAM.read_text(encoding="utf-8")


def diff(
    capfd: pytest.CaptureFixture[str], folder: Path, text: str, first: Path = PROGRAM, *more: str
) -> tuple[int, str]:
    """Exit code and stdout of a program against another text."""
    second = folder / "second.mpf"
    second.write_text(text, encoding="utf-8")
    code = main(["diff", str(first), str(second), "--machine", "yl569", *more])
    out, err = capfd.readouterr()
    assert err == ""
    return code, out.replace(str(second), "second").replace(str(first), "first")


def without_numbers(text: str) -> str:
    return re.sub(r"^N\d+ ", "", text, flags=re.MULTILINE)


def renumbered(text: str) -> str:
    """Every line with a number, 5 more than that of the line before."""
    return "".join(f"N{5 * k} {line}\n" for k, line in enumerate(without_numbers(text).splitlines(), 1))


def terse(text: str) -> str:
    """Numbers without zeros that say nothing, words without blanks between them."""
    lines = []
    for line in text.splitlines():
        if re.search(r" [XYZBC]-?[\d.]", line) and ";" not in line and "SUPA" not in line:
            line = re.sub(r"(?<=[XYZBC])(-?)0(?=\.)|(?<=\.\d)0+(?= |$)|\.0*(?= |$)", r"\1", line).replace(" ", "")
        lines.append(line)
    return "\n".join(lines) + "\n"


def wordy(text: str) -> str:
    """Every motion block with its G word, its feed and all its coordinates, zeros in front."""
    lines, held, g, feed = [], {}, "G0", ""
    for line in text.splitlines():
        if ";" in line or "SUPA" in line or not re.search(r" [XYZ]-?[\d.]", line) or re.search(r"G[23]", line):
            lines.append(line)
            continue
        words = line.split()
        for word in words:
            if word in ("G0", "G1"):
                g = word
            elif word[0] == "F":
                feed = word
            elif word[0] in "XYZBC":
                held[word[0]] = f"{float(word[1:]):+010.5f}"
        rest = [w for w in words[1:] if w[0] not in "XYZBCFG"]
        lines.append(
            " ".join([words[0], g, *(k + v for k, v in held.items()), *([feed] if feed and g == "G1" else []), *rest])
        )
    return "\n".join(lines) + "\n"


def test_a_program_is_the_same_as_itself(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert diff(capfd, tmp_path, TEXT) == (
        0,
        "same: 150 points, tips within 0.000000 mm, tool axes within 0.000000 degrees\n",
    )


@pytest.mark.parametrize(
    "rewrite", [without_numbers, renumbered, terse, wordy, str.lower, lambda text: text.replace("\n", "\r\n")]
)
def test_other_words_for_the_same_motion_are_the_same(
    rewrite: object, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert callable(rewrite)
    assert rewrite(TEXT) != TEXT
    assert diff(capfd, tmp_path, rewrite(TEXT))[0] == 0


def test_points_on_the_way_and_points_said_twice_are_the_same(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    # half-way between N510 and N520, and N520 once more
    more = TEXT.replace(
        "N520 X47.2619 Y-2.54083 Z-20.39393\n",
        "X47.6553 Y-2.2755 Z-20.08575\nN520 X47.2619 Y-2.54083 Z-20.39393\nX47.2619\n",
    )
    assert diff(capfd, tmp_path, more)[0] == 0
    assert main(["diff", str(tmp_path / "second.mpf"), str(PROGRAM), "--machine", "yl569"]) == 0


def test_a_circle_in_two_parts_is_the_same_circle(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    text = ARCS.read_text(encoding="utf-8")
    two = text.replace("N390 G2 X-41.213 Y0.0 I41.213 J0.0\n", "G2 X0 Y41.213 I41.213 J0\nX-41.213 Y0 I0 J-41.213\n")
    assert two != text
    assert diff(capfd, tmp_path, two, ARCS)[0] == 0


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("X47.2619 ", "X47.3619 ", "52 (N520) against second:52 (N520): tips are 0.100000 mm apart"),
        ("C11.03423", "C11.13423", "60 (N600) against second:60 (N600): tips are 0.000000 mm apart, tool axes 0.0"),
        ("N500 X48", "N500 G0 X48", "50 (N500) against second:50 (N500): line against rapid"),
        ("F250.", "F251.", "feed 250 against 251 mm/min"),
        ("S2500 D1 M3", "S2500 D1 M4", "spindle S2500 clockwise against S2500 counterclockwise"),
        ("T=2", "T=3", "tool 2 against 3"),
        ("S2500 D1 M3", "S2500 D1 M3 M8", "coolant differs"),
        ("N520 X47.2619 Y-2.54083 Z-20.39393\n", "", "the first program has 1 more point"),
        ("N420 TRAORI\n", "", "tips are"),
    ],
)  # fmt: skip
def test_a_difference_is_named_with_both_blocks(
    old: str, new: str, says: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    code, out = diff(capfd, tmp_path, TEXT.replace(old, new, 1))
    assert code == 1
    assert says in out
    assert out.startswith("different: ")
    assert "\nfirst: " in out


def test_words_that_only_one_program_has_and_nobody_knows_are_a_difference(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    code, out = diff(capfd, tmp_path, TEXT.replace("N560 ;Cutting", "N560 FROBNICATE(1)"))
    assert code == 1
    assert out.startswith("second:56: not understood: ")
    assert out.count("not understood") == 1


def test_the_worst_difference_is_named_besides_the_first(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    code, out = diff(capfd, tmp_path, TEXT.replace("X47.2619 ", "X47.3619 ").replace("X45.92544 ", "X49.92544 "))
    assert code == 1
    assert out.splitlines()[0].startswith("different: 2 places")
    assert "worst: first:54 (N540) against second:54 (N540): tips are 4.000000 mm apart" in out


def test_differences_have_the_block_numbers_of_both_programs(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    other = renumbered(TEXT.replace("X47.2619 ", "X47.3619 ").replace("X45.92544 ", "X49.92544 "))
    code, out = diff(capfd, tmp_path, terse(other))
    assert code == 1
    assert "first: first:52 (N520) against second:52 (N260): tips are 0.100000 mm apart" in out
    assert "worst: first:54 (N540) against second:54 (N270): tips are 4.000000 mm apart" in out


def test_a_program_for_another_machine_is_the_same_if_the_tool_does_the_same(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    programs = []
    for machine in ("yl569", "generic_head_head_ca"):
        programs.append(str(tmp_path / f"{machine}.mpf"))
        assert main(["post", str(YL569 / "2_hub_rough.cls"), "--machine", machine, "--output", programs[-1]]) == 0
    command = ["diff", *programs, "--machine", "yl569", "--to-machine", "generic_head_head_ca"]
    assert main(command) == 0, capfd.readouterr().out
    assert main([*command[:-1], "yl569"]) == 1
    assert "not understood" in capfd.readouterr().out


def test_a_tolerance_says_what_is_the_same(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    other = TEXT.replace("X47.2619 ", "X47.2629 ")
    assert diff(capfd, tmp_path, other, PROGRAM, "--tolerance", "0.0005")[0] == 1
    assert diff(capfd, tmp_path, other, PROGRAM, "--tolerance", "0.002")[0] == 0


def test_programs_are_compared_with_the_subprograms_that_are_named(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    sub = tmp_path / "BLADE.SPF"
    sub.write_text(TEXT.replace("M30", "M17"), encoding="utf-8")
    text = 'EXTCALL("BLADE")\nM30\n'
    assert diff(capfd, tmp_path, text, PROGRAM, "--to-with", str(sub))[0] == 0
    assert diff(capfd, tmp_path, text, PROGRAM, "--with", str(sub))[0] == 1
