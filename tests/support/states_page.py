"""The table of states in the page on conversion, made of the conversion's own; run as a module, this writes it."""

from typing import Final

from tests.support.locations import DOCS
from trunnion.conversion.states import TARGETS, table_rows

PAGE: Final = DOCS / "convert.md"

_BEGIN: Final = "<!-- states: made by tests/support/states_page.py -->\n"
_END: Final = "<!-- end of states -->\n"


def page() -> str:
    """The page as it must be."""
    before, begin, rest = PAGE.read_text(encoding="utf-8").partition(_BEGIN)
    _, end, after = rest.partition(_END)
    head = ("state", "words", *TARGETS)
    rows = "".join(f"| {' | '.join(row)} |\n" for row in (head, ["---"] * len(head), *table_rows()))
    return before + begin + rows + end + after


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
