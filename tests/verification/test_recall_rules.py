"""Edits that change nothing at the machine are not put in as harmful; those beside them are."""

from collections.abc import Sequence

import pytest

from tests.support.recall_proof.edits import harmful
from tests.support.recall_proof.sound_edits import sound

HOME = ["N1 G90 G94 G21", "N2 G53 G0 Z0.", "N3 S500 M3", "N4 G0 X5. Y6.", "N5 G43 H1 Z40."]
HOLE = "N7 G98 G81 X5. Y6. Z-3. R2. F100."


def kinds(lines: Sequence[str], at: str, family: str = "Fanuc", tolerance: float = 0.0) -> set[str]:
    """Kinds of the edits of one line."""
    line = [*lines].index(at) + 1
    return {edit.kind for edit in harmful("\n".join(lines) + "\n", family, tolerance) if edit.line == line}


@pytest.mark.parametrize(
    ("behind", "without"),
    [
        (["N6 Z12.", "N7 G1 Z-1. F90."], {"a rapid left out", "Z: left out", "a rapid that may be skipped"}),
        (["N6 Z12.", HOLE, "N8 G80", "N9 G0 Z50."], {"a rapid left out", "Z: left out", "a rapid that may be skipped"}),
    ],
)
def test_a_rapid_along_z_is_not_left_out_where_the_next_goes_on(behind: list[str], without: set[str]) -> None:
    on_the_way = [*HOME, "N6 Z20.", *behind]
    assert not without & kinds(on_the_way, "N6 Z20.")
    assert "Z: a tenth more" not in kinds(on_the_way, "N5 G43 H1 Z40.")
    last = behind[0]
    if "G81" not in behind[1]:
        assert "a rapid left out" in kinds(on_the_way, last), "the cut begins there"


def test_a_rapid_is_left_out_where_the_next_turns_back_or_aside() -> None:
    assert "a rapid left out" in kinds([*HOME, "N6 Z20.", "N7 Z30."], "N6 Z20.")
    assert "a rapid left out" in kinds([*HOME, "N6 Z20.", "N7 X9. Z10."], "N6 Z20.")
    assert "Z: a sign" in kinds([*HOME, "N6 Z20.", "N7 Z10."], "N6 Z20.")
    assert "Z: a tenth more" in kinds([*HOME, "N6 Z20.", "N7 M8", "N8 X9."], "N6 Z20.")


def test_a_place_in_the_air_is_not_changed_where_the_next_rapid_says_it_again() -> None:
    first, again = "N6 G0 X9. Y6. Z40.", "N8 G0 X9."
    wrong = {"X: a tenth more", "X: a sign"}
    assert not wrong & kinds([*HOME, first, "N7 (cut)", again, "N9 Z10."], first)
    assert "Y: a tenth more" in kinds([*HOME, first, again, "N9 Z10."], first)
    for following in ("N8 G1 X9. F90.", "N8 G0 X8.", "N8 G0 X9. Z10."):
        assert wrong <= kinds([*HOME, first, following, "N9 Z10."], first), following


def test_a_height_between_holes_is_changed_where_there_are_two() -> None:
    one = [*HOME, HOLE, "N8 G80", "N9 G0 Z50."]
    two = [*HOME, HOLE, "N8 X9.", "N9 G80", "N10 G0 Z50."]
    assert "back to another height" not in kinds(one, HOLE)
    assert "back to another height" in kinds(two, HOLE)
    assert "back to another height" in kinds([*HOME, HOLE, "N8 G80", "N9 G0 X9."], HOLE)


def test_a_point_on_a_cut_that_only_begins_a_feed_is_not_left_out() -> None:
    lines = [*HOME, "N6 G1 Z-1. F90.", "N7 X9. F300.", "N8 X20.", "N9 Y9."]
    assert "X: left out" not in kinds(lines, "N7 X9. F300.")
    assert "X: left out" in kinds(lines, "N8 X20.")
    stays = [*HOME, "N6 G1 Z-1. F90.", "N7 X9. F300.", "N8 Z-1."]
    assert {"X: left out", "X: a tenth more"} <= kinds(stays, "N7 X9. F300.")


def test_a_speed_before_a_block_with_its_own_is_not_put_in() -> None:
    lines = [*HOME, "N6 G1 Z-1. S900 F90.", "N7 X9."]
    assert "another speed in the cut" not in kinds(lines, "N6 G1 Z-1. S900 F90.", "LinuxCNC")
    assert "another speed in the cut" in kinds(lines, "N7 X9.", "LinuxCNC")


def test_a_coordinate_that_counts_from_here_says_no_place() -> None:
    by_increments = [*HOME, "N6 G91 G1 Z-41. F90.", "N7 X4.", "N8 Y6."]
    assert "incremental from here" not in kinds(by_increments, "N7 X4.")
    assert {"a cut left out", "X: a sign", "X: a tenth more"} <= kinds(by_increments, "N7 X4.")
    assert not {edit.kind for edit in sound("\n".join(by_increments), "Fanuc")} & {"coordinates again", "a line in two"}
    absolute = [*HOME, "N6 G1 Z-1. F90.", "N7 X9.", "N8 Y12."]
    assert "incremental from here" in kinds(absolute, "N7 X9.")
    assert {"coordinates again", "a line in two"} <= {edit.kind for edit in sound("\n".join(absolute), "Fanuc")}


@pytest.mark.parametrize(
    ("begin", "tolerance", "is_put_in"),
    [
        ("N5 G43 H1 Z40.", 0.0, True),
        ("N5 G43 H1 Z40.", 0.01, True),
        ("N5 G43 H1 Z40.", 0.02, False),
        ("N5 G43.4 H1 Z40.", 0.02, True),
    ],
)
def test_a_point_within_the_tolerance_of_a_turn_without_tcp_is_not_left_out(
    begin: str, tolerance: float, is_put_in: bool
) -> None:
    lines = [
        *HOME[:4],
        begin,
        "N6 G0 A0. C0.",
        "N7 G1 Z-1. F90.",
        "N8 X9.03 Y6. A2. F91.",
        "N9 X13. A4. F92.",
        "N10 Y9.",
    ]
    assert ("a cut left out" in kinds(lines, "N8 X9.03 Y6. A2. F91.", tolerance=tolerance)) is is_put_in
