"""What a Haas does otherwise than a Fanuc, read from programs; facts from its operator's manual."""

from dataclasses import replace
from pathlib import Path

import pytest

import trunnion
from tests.support.haas import HEAD, errors, read
from trunnion.machines import load_machine


@pytest.mark.parametrize(
    ("words", "seconds"), [("G4 P2.", 2.0), ("G4 P1500", 1.5), ("G98 G82 X1. Z-5. R2. P.5 F100.", 0.5)]
)
def test_a_dwell_with_a_point_is_in_seconds(words: str, seconds: float, tmp_path: Path) -> None:
    run = read(tmp_path, words)
    assert run.errors == ()
    assert [event.value for event in run.events if event.kind == "dwell"] == [pytest.approx(seconds)]


@pytest.mark.parametrize("words", ["J2", "J2.", "J9"])
def test_a_thread_may_be_left_faster_than_it_was_cut(words: str, tmp_path: Path) -> None:
    plain, faster = (read(tmp_path, f"G98 G84 X1. Z-5. R2. {more} F500.") for more in ("", words))
    assert faster.errors == plain.errors == ()
    assert faster.joints.tolist() == plain.joints.tolist()


def test_a_tool_change_switches_the_spindle_and_coolant_off(tmp_path: Path) -> None:
    run = read(tmp_path, "M3\nM8\nT6 M6\nG0 X1.")
    assert [(each.kind, each.value) for each in run.events if each.kind in ("spindle", "coolant")][-2:] == [
        ("spindle", "off"),
        ("coolant", "off"),
    ]
    assert read(tmp_path, "M3\nM8\nT6 M6\nG0 X1.", "matsuura_mx330").spindle[-1] == 1


@pytest.mark.parametrize("machine", ["haas_umc750", "matsuura_mx330"])
def test_an_end_of_scaling_and_h0_on_the_way_home_change_no_path(machine: str, tmp_path: Path) -> None:
    """G50 ends G51, which is an error of its own; H0 names no length, and home counts in the machine's frame."""
    plain = read(tmp_path, "G1 X5. F100.\nG91 G28 Z0.", machine)
    said = read(tmp_path, "G50\nG1 X5. F100.\nG91 G28 Z0. H0", machine)
    assert said.errors == plain.errors == ()
    assert said.joints.tolist() == plain.joints.tolist()
    assert any("scaling" in error.text for error in read(tmp_path, "G51 X0. Y0. P2.", machine).errors)


@pytest.mark.parametrize(
    ("lines", "what"),
    [
        ("G98 G82 X1. Z-5. R2. P500 F100.", "seconds or milliseconds"),
        ("G4 X2.", "the time of a dwell is P"),
        ("G98 G83 X1. Z-5. R2. I2. J.5 K1. F100.", "describes pecks or a retract"),
        ("G98 G83 X1. Z-5. R2. Q2. K3 F100.", "describes pecks or a retract"),
        ("G98 G84 X1. Z-5. R2. J12 F500.", "describes pecks or a retract"),
        ("G98 G81 X1. Z-5. R2. J2 F500.", "describes pecks or a retract"),
        ("M29", "unknown word M29"),
        ("M46 P10", "unknown word M46"),
        ("G98 G81 X1. Z-5. R2. L3 F100.", "L repeats a cycle with G91 only"),
        ("G98 G81\nX1. Z-5. R2. F100.", "a cycle without a position, Z and R"),
        ("G98 G86 X1. Z-5. R2. F100.", "unknown word G86"),
        ("G98 G88 X1. Z-5. R2. F100.", "unknown word G88"),
        ("G43.4 H5 Z60.", "unknown word G43.4"),
        ("G68.2 X0. Y0. Z0. I0. J30. K0.", "unknown word G68.2"),
        ("G268 X0. Y0. Z0. I0. J30. K0.", "unknown word G268"),
        ("G143 H5 Z60.", "unknown word G143"),
        ("G52 X10.", "unknown word G52"),
        ("G92 X10.", "unknown word G92"),
        ("M97 P100", "there is no block N100 to go to"),
        ("M97", "a local subprogram needs P"),
        ("N10 G0 X1.\nM96 P10 Q27", "M96 jumps to N10 unless input 27 is on"),
        ("M96 P10", "M96 jumps to N10 unless an input is on"),
        ("G103 P16", "look-ahead P16"),
        ("G103 P1\nG41 D1 G1 X5. F100.", "the control reads only 1 block ahead"),
        ("G41 D1 G1 X5. F100.\nG103 P3", "the control reads only 3 blocks ahead"),
        ("M97 P10\nM30\nN10 X1.\nM99\nN10 X2.\nM99", "goes to N10, which lines 10 and 12 both have"),
        ("M8 M3", "two M words in a block"),
        ("G154 P100", "P of G154 is not from 1 to 99"),
        ("G154", "G154 needs P"),
        ("G54 P3", "P"),
        ("G254\nG0 B30.", "rotary axes turn in the plane of the rotary position"),
        ("G0 B30.\nG254\nX0. Y0.\nG1 X5. F100.", "in a new plane before a rapid there states Z"),
        (
            "G0 B30.\nG254\nG0 Z60.\nG98 G81 X5. Y0. Z-5. R2. F100.",
            "in a new plane before a rapid there states X, Y",
        ),
        ("G0 B30.\nG254\nG0 G53 X0. Y0. Z0.\nG1 X5. F100.", "in a new plane before a rapid there states X, Y, Z"),
        ("G254\nG234 H5 Z60.", "the control has one or the other"),
        ("G234 H5 Z60.\nG254", "the control has one or the other"),
        ("G98 G84 X1. Z-5. R2. F500.\nG80\nG1 X5. F100.", "a thread has stopped it"),
        ("G98 G84 X1. Z-5. R2. F500.\nG81 X5. Z-5. R2. F100.", "a thread has stopped it"),
    ],
)
def test_what_is_not_settled_or_not_there_is_an_error(lines: str, what: str, tmp_path: Path) -> None:
    assert any(what in error for error in errors(tmp_path, lines)), errors(tmp_path, lines)


@pytest.mark.parametrize(
    "lines",
    [
        "G98 G81 L0\nX1. Z-5. R2. F100.",
        "G98 G84 X1. Z-5. R2. F500.\nG80\nG0 Z60.\nM3\nG1 X5. F100.",
        "G98 G84 X1. Z-5. R2. F500.\nX5.\nG80\nG0 Z60.",
        "G0 B30. C-400.\nG254\nX0. Y0.\nZ60.\nG53 Z0.\nG255\nB0. C0.",
        "G234 H5 Z60.\nG1 X1. B5. F100.\nG49\nG0 G53 Z0.",
        "G154 P3\nG0 X1.",
        "G187 P3 E0.02\nM11\nM13\nM16 T6",
        "G103 P1\nG103\nG41 D1 G1 X5. F100.",
        "G103 P15\nG103 P0\nG1 X5. F100.",
    ],
)
def test_what_the_manual_has_is_understood(lines: str, tmp_path: Path) -> None:
    assert errors(tmp_path, lines) == []


def test_m_words_act_at_the_end_of_their_block(tmp_path: Path) -> None:
    run = read(tmp_path, "M5\nG1 X5. F100. M3\nX6.")
    assert [int(value) for value in run.spindle[-2:]] == [0, 1]
    assert [int(value) for value in read(tmp_path, "M5\nG1 X5. F100. M3\nX6.", "matsuura_mx330").spindle[-2:]] == [1, 1]


def test_a_whole_feed_counts_in_increments(tmp_path: Path) -> None:
    run = read(tmp_path, "G1 X5. F100\nX6.\nX7. F100.")
    assert [float(value) for value in run.feed[-3:]] == pytest.approx([0.1, 0.1, 100.0])


def test_five_digits_after_m98_are_one_program(tmp_path: Path) -> None:
    (tmp_path / "O40008.nc").write_text("%\nO40008\nG0 X7.\nM99\n%\n")
    (tmp_path / "part.nc").write_text(f"{HEAD}M98 P40008\nM30\n%\n")
    run = trunnion.read_program(tmp_path / "part.nc", machine="haas_umc750", subprograms=[tmp_path / "O40008.nc"])
    assert run.errors == ()
    assert len(run.files) == 2


def test_the_plane_of_the_rotary_position_is_that_of_the_work_offset(tmp_path: Path) -> None:
    run = read(tmp_path, "G0 B90. C90.\nG254\nX1. Y2.\nZ3.")
    # Along the tool, which lies along Y of the workpiece, and across it.
    assert run.tip[-1] == pytest.approx([-2.0, 3.0, -1.0], abs=1e-9)


def test_coolant_through_the_spindle_stops_it(tmp_path: Path) -> None:
    run = read(tmp_path, "M88\nG1 X5. F100.")
    assert run.errors == ()
    assert int(run.spindle[-1]) == 0


@pytest.mark.parametrize(
    ("lines", "places"),
    [
        # The example of the manual: down by 0.1 mm and across, five times.
        ("G90 G1 Z0. F500.\nM97 P1000 L5\nG0 Z1.\nM30\nN1000 G91 Z-0.1\nG90 X2.\nG91 Z-0.1\nG90 X0.\nM99",
         [(0, 0), *((x, -k / 10) for k in range(1, 11) for x in ((0, 2) if k % 2 else (2, 0))), (0, 1)]),
        ("M97 P1\nX5.\nM30\nN1 X1.\nM97 P2 L2\nX3.\nM99\nN2 X2.\nX2.5\nM99",
         [(1, 50), (2, 50), (2.5, 50), (2, 50), (2.5, 50), (3, 50), (5, 50)]),
        ("M97 P1 L0\nX5.\nM30\nN1 X1.\nM99", [(5, 50)]),
        ("M97 P1\nX5.\nM30\nN1 X1.\nM99 P9\nN9 X9.", [(1, 50), (9, 50)]),
        ("X7. M97 P1\nX5.\nM30\nN1 X1.\nM99", [(7, 50), (1, 50), (5, 50)]),
    ],
)  # fmt: skip
def test_a_local_subprogram_is_followed(lines: str, places: list[tuple[float, float]], tmp_path: Path) -> None:
    run = read(tmp_path, lines)
    assert run.errors == ()
    found = [(round(float(x), 9), round(float(z), 9)) for x, _, z in run.tip[1:]]
    moved = [place for k, place in enumerate(found) if k == 0 or place != found[k - 1]]
    wanted = [place for k, place in enumerate(places) if k == 0 or place != places[k - 1]]
    assert moved == wanted


def test_a_local_subprogram_that_calls_itself_ends(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match="deeper than 16 levels"):
        read(tmp_path, "M97 P1\nM30\nN1 X1.\nM97 P1\nM99")


def test_a_local_subprogram_is_that_of_the_program_that_calls_it(tmp_path: Path) -> None:
    sub = "%\nO00002\nM97 P1\nM99\nN1 X8.\nM99\n%\n"
    (tmp_path / "O00002.nc").write_text(sub)
    (tmp_path / "part.nc").write_text(f"{HEAD}M98 P2\nM97 P1\nM30\nN1 X1.\nM99\n%\n")
    run = trunnion.read_program(tmp_path / "part.nc", machine="haas_umc750", subprograms=[tmp_path / "O00002.nc"])
    assert run.errors == ()
    assert run.tip[1:, 0].tolist() == pytest.approx([8.0, 1.0])


def test_a_word_of_ones_own_may_call_local_subprograms(tmp_path: Path) -> None:
    machine = tmp_path / "ours.toml"
    words = 'M197 = "local subprogram"\nG903 = "look-ahead"\nM196 = "jump on an input"\n'
    machine.write_text(f'extends = "matsuura_mx330"\n[control.reading.words]\n{words}')
    run = read(tmp_path, "G903 P1\nM197 P1\nX5.\nM30\nN1 X1.\nM99", str(machine))
    assert run.errors == ()
    assert run.tip[1:, 0].tolist() == pytest.approx([1.0, 5.0])
    assert [each.text[:18] for each in read(tmp_path, "M196 P1", str(machine)).errors] == ["M196 jumps to N1 u"]


def test_a_local_subprogram_without_m99_ends_at_the_next_program(tmp_path: Path) -> None:
    run = read(tmp_path, "M97 P1\nX5.\nM30\nN1 X1.\nO00002\nX9.\nM99")
    assert any("runs into the next one" in error.text for error in run.errors)
    assert run.tip[1:, 0].tolist() == pytest.approx([1.0, 5.0])


@pytest.mark.parametrize(
    ("call", "x"),
    [("#100=2\nM98 P#100", -2.0), ("M98 P2.", -2.0), ("M98 P2", -2.0), ("#100=7\nM97 P#100", -7.0), ("M97 P7.", -7.0)],
)
@pytest.mark.parametrize("cycle", ["", "G98 G81 X0. Y0. Z-5. R2. F100.\n"])
def test_the_number_of_a_program_or_block_is_no_time(call: str, x: float, cycle: str, tmp_path: Path) -> None:
    # A thousand times 2 and 7 are there as well.
    parts = "".join(f"{name}\nG80 G53 G0 X{-k}.\nM99\n" for name, k in (("N7", 7), ("N7000", 40)))
    parts += "".join(f"O{k:05d}\nG80 G53 G0 X{-k / 100 if k > 9 else -k:.1f}\nM99\n" for k in (2, 2000))
    (tmp_path / "part.nc").write_text(f"{HEAD}{cycle}{call}\nM30\n{parts}%\n")
    run = trunnion.read_program(tmp_path / "part.nc", machine="haas_umc750")
    assert run.errors == ()
    assert float(run.joints[-1][run.machine.column("X")]) == pytest.approx(x)


def test_a_look_ahead_with_a_point_is_told_as_it_is_written(tmp_path: Path) -> None:
    assert any("look-ahead P1.5:" in error for error in errors(tmp_path, "G103 P1.5"))


LENGTH = replace(load_machine("haas_umc750"), workpiece_zero=(-380.0, -250.0, -500.0), tool_length=100.0)


def slides(folder: Path, lines: str) -> list[float]:
    """Where Z of the machine stands at the rows of a program, mm."""
    (folder / "part.nc").write_text(f"{HEAD}{lines}\nM30\n%\n")
    run = trunnion.read_program(folder / "part.nc", machine=LENGTH)
    return [float(value) for value in run.joints[:, LENGTH.column("Z")]]


def test_home_takes_the_tool_length_off(tmp_path: Path) -> None:
    assert slides(tmp_path, "G0 Z50.")[-1] == pytest.approx(-350.0)
    assert slides(tmp_path, "G28 G91 Z0.\nG90\nG0 X10. Y0.\nG0 Z50.")[-1] == pytest.approx(-450.0)
    assert slides(tmp_path, "G28 G91 Z0.\nG90\nG43 H5 G0 Z50.")[-1] == pytest.approx(-350.0)
    # The point on the way still counts with the length (the manual's example).
    assert slides(tmp_path, "G28 Z7.")[-2:] == pytest.approx([-393.0, 0.0])


@pytest.mark.parametrize("lines", ["G0 Z50.", "G1 Z-1. F100.", "G98 G81 X1. Z-5. R2. F100.", "G1 X1. F100.\nX2. Z3."])
def test_z_without_the_length_that_home_has_taken_off_is_an_error(lines: str, tmp_path: Path) -> None:
    (error,) = errors(tmp_path, f"G28 G91 Z0.\nG90 G0 X5.\n{lines}")
    assert error == "Z without the tool length, which G28 in line 8 has taken off: write G43 with it"
    for cure in ("G43 H5 G0 Z60.", "G234 H5 Z60.", "G49"):
        assert errors(tmp_path, f"G28 G91 Z0.\nG90 G0 X5.\n{cure}\n{lines}") == []
    assert errors(tmp_path, f"G49\nG28 G91 Z0.\nG90 G0 X5.\n{lines}") == [], "no length was there"


@pytest.mark.parametrize("block", ["H0", "X6. H0", "G28 G91 Z0. H0\nG90"])
def test_z_without_the_length_that_h0_has_taken_off_is_an_error(block: str, tmp_path: Path) -> None:
    """The number of a length holds until another one, and no register 0 has a length."""
    (error,) = errors(tmp_path, f"{block}\nG0 X5.\nG1 Z-1. F100.")
    assert error.startswith("Z without the tool length, which ")
    assert errors(tmp_path, f"{block}\nG0 X5.\nG43 H5 G0 Z60.\nG1 Z-1. F100.") == []
    assert errors(tmp_path, f"G49 {block}\nG0 X5.\nG1 Z-1. F100.") == [], "no length was there"
    assert slides(tmp_path, f"{block}\nG0 X5. Z50.")[-1] == pytest.approx(-450.0)


def test_home_under_tcp_is_an_error(tmp_path: Path) -> None:
    assert any("G28 with TCP on" in error for error in errors(tmp_path, "G234 H5 Z60.\nG28 G91 Z0."))


def test_home_without_axes_takes_all_of_them(tmp_path: Path) -> None:
    run = read(tmp_path, "G0 X5. B30. C40.\nG28")
    assert run.errors == ()
    home = [float(axis.home) for axis in run.machine.axes]
    assert run.joints[-1].tolist() == pytest.approx(home)
    fanuc = read(tmp_path, "G28", "matsuura_mx330")
    assert any("need the axes that go home" in error.text for error in fanuc.errors)


def test_what_a_haas_may_leave_on_names_no_parameter_of_a_fanuc(tmp_path: Path) -> None:
    (left,) = (each for each in read(tmp_path, "G1 X1. F10.\nG49\nG91").diagnostics if each.code == "NC351")
    assert "3402" not in left.text
    assert "depends on the settings of the control" in left.text


@pytest.mark.parametrize(("word", "reason"), [("M95 (00:10)", "sleep"), ("M109", "operator"), ("M78", "skip signal")])
def test_words_that_wait_are_told_as_waits(word: str, reason: str, tmp_path: Path) -> None:
    told = {each.code: each.text for each in read(tmp_path, word).diagnostics}
    assert list(told) == ["NC226"]
    assert reason in told["NC226"]
