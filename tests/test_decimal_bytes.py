"""Numbers are the doubles that Python reads from the same text."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from trunnion.decimal_bytes import EXACT_DIGITS, MAX_DIGITS, MAX_EXACT, POWERS_OF_TEN, parse_decimal

DIGITS = "0123456789"
digits = st.text(DIGITS, max_size=MAX_DIGITS)


def parsed(text: str, comma: bool = False) -> tuple[int, int, int, bool, int]:
    """What the kernel finds at the beginning of a line."""
    line = np.frombuffer(f"{text}\n".encode("latin-1"), np.uint8)
    return parse_decimal(line, np.uint64(0), comma)  # type: ignore[arg-type]


@given(whole=digits, part=st.none() | digits, after=st.sampled_from(["", " ", "X1.5", "-2", ",5", "/", ":", "\xff"]))
@example("9007199254740992", "", "")
@example("", "", "")
def test_a_number_is_parsed_to_its_end(whole: str, part: str | None, after: str) -> None:
    text = whole if part is None else f"{whole}.{part}"
    mantissa, count, decimals, point, end = parsed(text + after)
    assert (count, decimals, point, end) == (len(whole + (part or "")), len(part or ""), part is not None, len(text))
    if 0 < count <= MAX_DIGITS and mantissa <= MAX_EXACT:
        assert mantissa / POWERS_OF_TEN[decimals] == float(text)
    assert count > EXACT_DIGITS or mantissa < MAX_EXACT


@pytest.mark.parametrize(("comma", "found"), [(False, (1, 1, 0, False, 1)), (True, (125, 3, 2, True, 4))])
def test_a_comma_is_a_point_only_where_it_may_be(comma: bool, found: tuple[int, int, int, bool, int]) -> None:
    assert parsed("1,25.5", comma) == found


def test_a_number_has_one_point() -> None:
    assert parsed("1.2.3") == (12, 2, 1, True, 3)
