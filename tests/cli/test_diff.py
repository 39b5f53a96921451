"""``trunnion diff``: the same motion in other words is the same."""

import re
from pathlib import Path

import pytest

from tests.support.locations import TESTS, YL569
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
    assert out.splitlines()[1:] == ["not compared: 1 word not understood; otherwise the same: 150 points"]


def test_words_that_both_programs_have_and_nobody_knows_prove_nothing(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """What they do may depend on all that comes before: here on R1."""
    first = tmp_path / "first.mpf"
    first.write_text(TEXT.replace("N560 ;Cutting", "R1=1\nFROBNICATE(R1)\nR1=0"), encoding="utf-8")
    code, out = diff(capfd, tmp_path, first.read_text(encoding="utf-8").replace("R1=1", "R1=9"), first)
    assert code == 1
    assert out.splitlines()[-1] == "not compared: 2 words not understood; otherwise the same: 150 points"


def test_programs_that_move_nothing_are_not_the_same(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    first = tmp_path / "first.mpf"
    first.write_text("M30\n", encoding="utf-8")
    assert diff(capfd, tmp_path, "M30\n", first) == (1, "not compared: neither program moves the tool\n")


FANUC = """O0001
G21 G17 G40 G80 G90 G94
T3 M6
G54
G0 A0. C0.
S2000 M3
G0 X0. Y0.
G43 H3 Z50.
G1 Z-5. F100.
G41 D3 X10.
X20.
G40 X30.
G0 Z50.
M30
"""

KLARTEXT = """0 BEGIN PGM PART MM
1 TOOL CALL 3 Z S2000
2 CYCL DEF 247 DATUM SETTING ~
  Q339=+1 ;DATUM NUMBER
3 CYCL DEF 32.0 TOLERANCE
4 CYCL DEF 32.1 T0.01
5 M3
6 L X+0 Y+0 Z+50 R0 FMAX
7 L Z-5 F100
8 L X+10 RL
9 L X+20
10 L X+30 R0
11 L Z+50 FMAX
12 END PGM PART MM
"""

LINUXCNC = """G21 G17 G40 G80 G90 G94
T3 M6
G54
G64 P0.01
S2000 M3
G0 X0. Y0.
G43 H3 Z50.
G1 Z-5. F100.
X20.
G0 Z50.
M2
"""

REGISTERS = [
    ("yl569", TEXT, "G54", "G55", "work offset G54 against G55"),
    ("yl569", TEXT, "S2500 D1 M3", "S2500 D2 M3", "cutting edge D1 against D2"),
    ("yl569", TEXT, "N420 TRAORI", "TOFFL=5\nTRAORI", "added to the tool: nothing against TOFFL 5 mm"),
    ("yl569", TEXT.replace("N420", "TOFFL=5\nN420"), "N560 ;", "TOFFL=0 ;", "TOFFL 5 mm against nothing"),
    ("yl569", TEXT, "CYCLE832(_camtolerance,", "CYCLE832(5,", "tolerance 0.06 mm against 5 mm"),
    ("yl569", TEXT, "_ORI_ROUGH,1)", "_ORI_ROUGH,.5)", "tolerance of the tool axis 1 degrees against 0.5 degrees"),
    ("yl569", TEXT, "N560 ;", "OTOL=0.1 ;", "tolerance of the tool axis 1 degrees against 0.1 degrees"),
    ("dmu65", KLARTEXT, "5 M3", "CYCL DEF 32.2 TA0.5\n5 M3", "tolerance of the tool axis none against 0.5 degrees"),
    ("matsuura_mx330", FANUC, "H3", "H4", "tool length H3 against H4"),
    ("matsuura_mx330", FANUC, "D3", "D4", "radius of D3 against D4"),
    ("matsuura_mx330", FANUC, "G41", "G42", "radius compensation left against right"),
    ("matsuura_mx330", FANUC, "G41 D3 ", "", "radius compensation left against off"),
    ("matsuura_mx330", FANUC, "G54", "G54.1 P2", "work offset G54 against G54.1 P2"),
    ("dmu65", KLARTEXT, "Q339=+1", "Q339=+2", "work offset preset 1 against preset 2"),
    ("dmu65", KLARTEXT, "S2000", "S2000 DL+5", "added to the tool: nothing against DL 5 mm"),
    ("dmu65", KLARTEXT, "RL", "RR", "radius compensation left against right"),
    ("dmu65", KLARTEXT, "T0.01", "T1", "tolerance 0.01 mm against 1 mm"),
    ("linuxcnc_5axis", LINUXCNC, "G54", "G59.3", "work offset G54 against G59.3"),
    ("linuxcnc_5axis", LINUXCNC, "H3", "H4", "tool length H3 against H4"),
    ("linuxcnc_5axis", LINUXCNC, "P0.01", "P5", "tolerance 0.01 mm against 5 mm"),
]


@pytest.mark.third
@pytest.mark.parametrize(("machine", "text", "old", "new", "says"), REGISTERS, ids=[case[-1] for case in REGISTERS])
def test_what_moves_the_tool_off_its_positions_is_compared(
    machine: str, text: str, old: str, new: str, says: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    programs = [tmp_path / "first.nc", tmp_path / "second.nc"]
    assert old in text
    for program, its in zip(programs, (text, text.replace(old, new, 1)), strict=True):
        program.write_text(its, encoding="utf-8")
    assert main(["diff", str(programs[0]), str(programs[0]), "--machine", machine]) == 0, capfd.readouterr().out
    capfd.readouterr()
    assert main(["diff", *map(str, programs), "--machine", machine]) == 1
    out = capfd.readouterr().out
    assert says in out
    # Where rotary axes are positioned in another work offset, that is a difference by itself.
    assert re.match("different: (1 place|2 places); on the same path: ", out)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("F250.", "F251.", "feed 250 against 251 mm/min"),
        ("S2500 D1 M3", "S2400 D1 M3", "spindle S2500 clockwise against S2400 clockwise"),
        ("T=2", "T=3", "tool 2 against 3"),
        ("S2500 D1 M3", "S2500 D1 M3 M8", "coolant differs"),
        ("G54", "", "work offset G54 against none"),
    ],
)
def test_what_stays_different_counts_once_and_hides_no_difference_of_the_path(
    old: str, new: str, says: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    code, out = diff(capfd, tmp_path, TEXT.replace(old, new).replace("X45.92544 ", "X49.92544 "))
    count, first, worst = out.splitlines()
    assert (code, count.partition(" points")[0]) == (1, "different: 2 places; on the same path: 149")
    assert says in first
    assert re.search(r", up to \d+ \(N\d+\) against \d+ \(N\d+\)$", first)
    assert worst.startswith("worst: first:54 (N540) against second:54 (N540): tips are 4.000000 mm apart")


def test_each_way_in_which_a_feed_differs_counts_once(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """F251, F252 and, after the feed of both for a while, F251 again."""
    text = TEXT.replace("F250.", "F251.")
    for number, feed in (("N500 ", 252), ("N540 ", 250), ("N600 ", 251)):
        assert text.count(number) == 1
        text = text.replace(number, f"{number}F{feed} ")
    code, out = diff(capfd, tmp_path, text)
    assert (code, out.splitlines()[0].split(";")[0]) == (1, "different: 3 places")
    assert "feed 250 against 251 mm/min" in out


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("N540 ", "M0\nN540 ", "54 (N540) against second:55 (N540): nothing against stop"),
        ("N540 ", "M1\nN540 ", "nothing against optional stop"),
        ("N540 ", "G4 F2\nN540 ", "nothing against dwell of 2 s"),
        ("N540 ", "G4 S3\nN540 ", "nothing against dwell of 3 revolutions"),
        ("N2010", "M0\nN2010", "nothing against stop"),
    ],
)
def test_stops_and_dwells_are_compared_at_their_places(
    old: str, new: str, says: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert TEXT.count(old) == 1
    code, out = diff(capfd, tmp_path, TEXT.replace(old, new))
    assert (code, out.partition(";")[0]) == (1, "different: 1 place")
    assert says in out
    first = tmp_path / "first.mpf"
    first.write_text(TEXT.replace(old, new), encoding="utf-8")
    assert diff(capfd, tmp_path, without_numbers(TEXT.replace(old, new)), first)[0] == 0


def test_an_event_before_a_point_that_only_one_program_has_is_at_the_same_place(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    first = tmp_path / "first.mpf"
    first.write_text(TEXT.replace("N520 ", "M0\nN520 "), encoding="utf-8")
    between = "X47.6553 Y-2.2755 Z-20.08575\n"
    assert diff(capfd, tmp_path, TEXT.replace("N520 ", f"M0\n{between}N520 "), first)[0] == 0
    code, out = diff(capfd, tmp_path, TEXT.replace("N520 ", f"{between}M0\nN520 "), first)
    assert (code, out.partition(";")[0]) == (1, "different: 2 places")


def test_words_of_the_builder_are_compared_on_one_machine(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    programs = [tmp_path / "first.nc", tmp_path / "second.nc"]
    for program, text in zip(programs, (FANUC, FANUC.replace("S2000 M3", "S2000 M3\nM88")), strict=True):
        program.write_text(text, encoding="utf-8")
    assert main(["diff", *map(str, programs), "--machine", "matsuura_mx330"]) == 1
    assert "nothing against M88" in capfd.readouterr().out


def test_between_languages_work_offsets_are_compared_by_their_order(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """G54 and the preset 3 may be one place; G54 twice, and 1 and then 2, are not."""
    fanuc, twice, klartext = (tmp_path / name for name in ("fanuc.nc", "twice.nc", "klartext.h"))
    body = KLARTEXT.replace("Q339=+1", "Q339=+3").replace(" RL", "").replace("RL", "")
    klartext.write_text(body, encoding="utf-8")
    plain = (
        FANUC.replace("G41 D3 ", "")
        .replace("G40 X30", "X30")
        .replace("G0 X0. Y0.\nG43 H3 Z50.", "G43 H3 G0 X0. Y0. Z50.")
    )
    fanuc.write_text(plain, encoding="utf-8")
    twice.write_text(plain.replace("X20.\n", "G55\nX20.\n"), encoding="utf-8")
    machines = ["--machine", "matsuura_mx330", "--to-machine", "dmu65"]
    assert main(["diff", str(fanuc), str(klartext), *machines]) == 0, capfd.readouterr().out
    assert main(["diff", str(twice), str(klartext), *machines]) == 1
    assert "work offset G55 against preset 3" in capfd.readouterr().out


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
    assert diff(capfd, tmp_path, text, PROGRAM, "--to-subprograms", str(sub))[0] == 0
    assert diff(capfd, tmp_path, text, PROGRAM, "--subprograms", str(sub))[0] == 1


@pytest.mark.parametrize(
    ("part", "old", "new", "says"),
    [
        ("holes", "G84", "G74", "right-hand thread, after which the spindle turns clockwise against left-hand thread"),
        ("holes", "M30", "M99", "end of the program by M30 against nothing"),
        ("contour", "M5\nN270 M0", "\nN270 M0", "stop against stop while the spindle turns clockwise"),
    ],
)
def test_what_the_path_does_not_show_is_compared(
    part: str, old: str, new: str, says: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    program, other = tmp_path / "one.nc", tmp_path / "two.nc"
    cl = TESTS / "data" / "cases" / f"{part}.cls"
    assert main(["post", str(cl), "--machine", "matsuura_mx330", "--output", str(program)]) == 0
    text = program.read_text(encoding="utf-8")
    assert old in text
    other.write_text(text.replace(old, new), encoding="utf-8")
    capfd.readouterr()
    assert main(["diff", str(program), str(other), "--machine", "matsuura_mx330"]) == 1
    assert says in capfd.readouterr().out


HELIX = "G0 X8 Y-7 Z0\nG1 Z-1 F200\n{}\nG1 X9\n"
WHOLE = HELIX.format("G3 X8 Y-7 Z-3 I-6 J0")


@pytest.mark.parametrize(("pieces", "same"), [
    ("G3 X-4 Y-7 Z-2 I-6 J0\nX8 Y-7 Z-3 I6 J0", 0),
    ("G3 X2 Y-1 Z-1.5 I-6 J0\nX-4 Y-7 Z-2 I0 J-6\nX8 Y-7 Z-3 I6 J0", 0),
    ("G3 X-4 Y-7 Z-1.9 I-6 J0\nX8 Y-7 Z-3 I6 J0", 1),
    ("G3 X-4 Y-7 Z-2 I-6 J0\nG2 X8 Y-7 Z-3 I6 J0", 1),
])  # fmt: skip
def test_a_helix_may_be_made_in_pieces(
    pieces: str, same: int, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    head, end = "G71 G17 G90 G94 G40 G54\nT1\nM6\nS1000 M3\nG0 Z50 D1\n", "G0 Z50\nM30\n"
    first = tmp_path / "first.mpf"
    first.write_text(head + WHOLE + end, encoding="utf-8")
    assert diff(capfd, tmp_path, head + HELIX.format(pieces) + end, first)[0] == same
