"""Text for every form of report: without characters that no file can hold.

Escaping is left to each form.
"""

from trunnion.wording import printable


def clean(text: str) -> str:
    """Return the text with U+FFFD for each character that is no part of it, or that UTF-8, HTML or JSON cannot hold.

    >>> clean("hub\\x00 \\udcff 轮毂")
    'hub\ufffd \ufffd 轮毂'
    """
    return printable(text.encode("utf-16", "surrogatepass").decode("utf-16", "replace"))
