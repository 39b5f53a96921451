"""Text and numbers for every form of report: without characters that no file can hold, and without NaN.

Escaping is left to each form.
"""

import math

from trunnion.wording import printable


def clean(text: str) -> str:
    """Return the text with U+FFFD for each character that is no part of it, or that UTF-8, HTML or JSON cannot hold.

    >>> clean("hub\\x00 \\udcff 轮毂")
    'hub\ufffd \ufffd 轮毂'
    """
    return printable(text.encode("utf-16", "surrogatepass").decode("utf-16", "replace"))


def finite_or_none(value: float | None) -> float | None:
    """Return the value, or None for infinities and NaN."""
    return value if value is not None and math.isfinite(value) else None
