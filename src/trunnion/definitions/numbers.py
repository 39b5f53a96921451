"""Numbers of TOML values: which are numbers here, within which bounds, and what to write in place of others."""

import math

from trunnion.definitions.expected import GREATEST


def finite(value: object) -> float | None:
    """Return the number that a TOML value is, or None if it is too large or none; true and false are no
    numbers here.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if abs(number) <= GREATEST else None


def is_too_large(value: object) -> bool:
    """Whether a value is, or has in it, a number beyond the bounds of all numbers."""
    numbers = [item for item in (value if isinstance(value, list) else [value]) if isinstance(item, int | float)]
    return any(GREATEST < abs(number) < math.inf for number in numbers)


def has_decimal_commas(value: object, n: int) -> bool:
    """Whether an array seems to have decimal commas, which make more than n numbers of it."""
    return isinstance(value, list) and len(value) > n and all(isinstance(each, int) for each in value[1:])


def finite_numbers(value: object) -> tuple[float, ...] | None:
    """Return the finite numbers in a TOML array; None if it holds anything else, or is no array."""
    numbers = [finite(item) for item in value] if isinstance(value, list) else [None]
    found = tuple(number for number in numbers if number is not None)
    return found if len(found) == len(numbers) else None


def within(number: float, above: float | None, at_least: float | None, at_most: float | None) -> bool:
    return (
        (above is None or number > above)
        and (at_least is None or number >= at_least)
        and (at_most is None or number <= at_most)
    )
