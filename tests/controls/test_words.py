"""Numbers are printed as exact arithmetic would print them."""

from decimal import ROUND_HALF_EVEN, Decimal

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from trunnion.controls.words import ABSENT, NumberFormat, Word, round_to_counts

numbers = st.floats(-99999.0, 99999.0, allow_nan=False)


@given(numbers, st.integers(0, 7))
@example(0.5, 0)
@example(2.5, 0)
@example(-0.125, 2)
@example(1.000005, 5)
@example(44.200585, 5)
@example(-0.000004, 5)
def test_a_number_is_rounded_as_if_it_were_written_out_in_full(value: float, decimals: int) -> None:
    exact = Decimal(value).quantize(Decimal(1).scaleb(-decimals), rounding=ROUND_HALF_EVEN)
    assert round_to_counts(np.array([value]), decimals)[0] == int(exact.scaleb(decimals))


@given(st.lists(st.integers(-(10**11), 10**11), min_size=1), st.integers(1, 6))
def test_half_way_cases_of_a_cl_file_round_like_printf(halves: list[int], decimals: int) -> None:
    values = np.array([n / 10**decimals / 2 for n in halves])
    printed = [f"{value:.{decimals}f}" for value in values]
    assert round_to_counts(values, decimals).tolist() == [round(Decimal(text).scaleb(decimals)) for text in printed]


def test_a_missing_number_is_an_absent_word() -> None:
    assert round_to_counts(np.array([np.nan, 1.0]), 3).tolist() == [ABSENT, 1000]


def test_a_number_with_more_digits_than_a_double_holds_is_refused() -> None:
    with pytest.raises(OverflowError, match="1e\\+15 with 5 decimals"):
        round_to_counts(np.array([1e15, np.nan]), 5)


@pytest.mark.parametrize(
    ("value", "text"),
    [(-0.31289, "-.31289"), (-20.0, "-20."), (0.0, "0.0"), (250.0, "250."), (-0.000001, "0.0"), (11.04, "11.04")],
)
def test_the_numbers_of_the_yl569_look_as_on_its_control(value: float, text: str) -> None:
    assert NumberFormat(5, zero="0.0").text(value) == text


@pytest.mark.parametrize(
    ("form", "value", "text"),
    [
        (NumberFormat(0), 2500.0, "2500"),
        (NumberFormat(0), 0.0, "0"),
        (NumberFormat(3, plus=True, leading_zero=True, trailing_zeros=True), 0.5, "+0.500"),
        (NumberFormat(3, leading_zero=True), 0.5, "0.5"),
        (NumberFormat(3, point=False), 20.0, "20"),
        (NumberFormat(3, point=False), 20.25, "20.25"),
        (NumberFormat(3), 0.0, "0."),
        (NumberFormat(6, leading_zero=True, trailing_zeros=True), 10.0, "10.000000"),
    ],
)
def test_each_rule_of_a_format_does_what_it_says(form: NumberFormat, value: float, text: str) -> None:
    assert form.text(value) == text


def test_a_word_is_its_letter_and_its_number() -> None:
    assert Word("C", "C", NumberFormat(5)).text(322.31094) == "C322.31094"
