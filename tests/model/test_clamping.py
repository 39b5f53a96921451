"""Notices on the clamping of a part: what is written is read again, and nothing that has been changed."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.arrays import Floats
from trunnion.controls import load_control
from trunnion.machines import load_machine
from trunnion.model.clamping import Clamping
from trunnion.model.clamping_notices import HeadNotices, clamped_notices, head_comments, read_place, zero_notices

TILTED = "PART TILTED 20 DEG FIRST, ABOUT ITS X, RIGHT-HANDED, ITS +Y SIDE UP"
TURNED = "PART TURNED 30 DEG ABOUT Z, COUNTER-CLOCKWISE SEEN FROM ABOVE, FROM +Z"
DRAWN = "PART CLAMPED AS DRAWN, NOT TURNED"
ZERO = "WORKPIECE ZERO X10.000 Y-5.000 Z-60.000 MM ON THE MACHINE, AXES AT 0"
LENGTH = "ZERO FOR TOOL LENGTH 120 MM, FROM GAUGE POINT TO TIP"

#: One machine of each family of controls.
FAMILIES = ("yl569", "dmu65", "matsuura_mx330", "hs664rt", "xyzac_trt")

angles = st.integers(-360_000, 360_000).map(lambda value: value / 1000.0)
lengths = st.integers(-9_999_999, 9_999_999).map(lambda value: value / 1000.0)


def stated(*texts: str) -> HeadNotices:
    return read_place(list(enumerate(texts, 1)))


@settings(max_examples=examples(60), deadline=None)
@given(
    machine=st.sampled_from(FAMILIES), turn=angles, tilt=angles, zero=st.tuples(lengths, lengths, lengths),
    length=st.none() | lengths.map(abs),
)  # fmt: skip
def test_what_each_control_writes_is_read_again(
    machine: str, turn: float, tilt: float, zero: tuple[float, float, float], length: float | None
) -> None:
    family = load_control(load_machine(machine).control).family
    notices = [*clamped_notices(Clamping(turn, tilt)), *zero_notices(zero, length)]
    lines = ["%", "O0001", *(line for text in notices for line in family.comment(text)), "N10 G1 X1", f"({DRAWN})"]
    found = read_place(list(head_comments(enumerate(lines, 1))))
    assert found.faults == ()
    assert found.clamping is not None
    assert found.clamping.tilt == tilt
    assert math.isclose(found.clamping.turn, turn % 360.0, abs_tol=1e-9)
    assert found.zero == zero
    assert found.tool_length == length


def test_a_sound_head_is_believed() -> None:
    assert stated(TILTED, TURNED, ZERO, LENGTH) == HeadNotices(Clamping(30.0, 20.0), (10.0, -5.0, -60.0), 120.0)
    assert stated(TURNED, TURNED.lower()) == HeadNotices(Clamping(30.0))
    assert stated(DRAWN) == HeadNotices(Clamping())
    assert stated("TURNED PART", "OPERATION PART TURNED 30 DEG") == HeadNotices()


@pytest.mark.parametrize(
    ("texts", "line", "why"),
    [
        ((TILTED, TURNED.replace("COUNTER-CLOCKWISE", "CLOCKWISE")), 2, "is not as it was written"),
        ((TILTED.replace("UP", "DOWN"), TURNED), 1, "the side for another sign"),
        ((TILTED.replace("20", "-20"), TURNED), 1, "the side for another sign"),
        ((TURNED.replace("ABOUT Z", "ABOUT X"),), 1, "is not as it was written"),
        ((TURNED.replace("30", "30,0"),), 1, "is not as it was written"),
        ((TURNED.replace("30", "361"),), 1, "more than 360"),
        ((TURNED, TURNED.replace("30", "31")), 2, "contradicts line 1"),
        ((TILTED,), 1, "none its turn"),
        ((DRAWN, TURNED), 1, "another that it is not"),
        ((DRAWN.replace("NOT TURNED", "TURNED"),), 1, "is not as it was written"),
    ],
)
def test_a_damaged_notice_is_told_and_not_believed(texts: tuple[str, ...], line: int, why: str) -> None:
    found = stated(*texts)
    assert found.clamping is None
    (fault,) = found.faults
    assert fault[0] == line
    assert why in fault[1].what


def test_a_damaged_zero_leaves_the_clamping() -> None:
    found = stated(TURNED, ZERO.replace("MM", "INCH"), LENGTH, LENGTH.replace("120", "130"))
    assert (found.clamping, found.zero, found.tool_length) == (Clamping(30.0), None, None)
    assert [line for line, _ in found.faults] == [2, 4]


@settings(max_examples=examples(100))
@given(
    text=st.sampled_from([TILTED, TURNED, DRAWN, ZERO, LENGTH]), place=st.integers(14, 60),
    letter=st.sampled_from("ABQWZ,.+#"),
)  # fmt: skip
def test_no_letter_of_a_notice_may_be_another_one(text: str, place: int, letter: str) -> None:
    place %= len(text)
    if place < 14 or text[place] == letter or text[place].isdigit() or text[place] in " .-":
        return
    found = stated(text[:place] + letter + text[place + 1 :])
    assert len(found.faults) == 1
    assert (found.clamping, found.zero, found.tool_length) == (None, None, None)


@settings(max_examples=examples(60))
@given(first=st.tuples(angles, angles), turn=angles, tilt=angles)
def test_one_clamping_behind_another_is_the_product_of_both(
    first: tuple[float, float], turn: float, tilt: float
) -> None:
    def matrix(turn: float, tilt: float) -> Floats:
        (c, s), (a, b) = ((math.cos(math.radians(each)), math.sin(math.radians(each))) for each in (turn, tilt))
        return np.asarray(np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, a, -b], [0, b, a]]))

    for start, more in ((first, (turn, 0.0)), ((0.0, first[1]), (turn, tilt)), ((360.0, first[1]), (turn, tilt))):
        found = Clamping(*start).then(*more)
        assert found is not None
        np.testing.assert_allclose(matrix(found.turn, found.tilt), matrix(*more) @ matrix(*start), atol=1e-9)
    assert Clamping(30.0, 0.0).then(10.0, 5.0) is None


def test_a_head_ends_before_its_first_block() -> None:
    lines = ["0 BEGIN PGM A MM", "1 ; ONE", "/N2 (TWO )", "", "N3 G21", "(THREE)", "N5 G17 ; FOUR"]
    assert list(head_comments(enumerate(lines, 1))) == [(2, "ONE"), (3, "TWO")]
