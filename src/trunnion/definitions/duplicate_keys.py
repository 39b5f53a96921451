"""Keys of a table that are written differently and say the same: only one of them could count."""

from collections.abc import Callable, Hashable

from trunnion.definitions.table import Table
from trunnion.messages import Wording


def report_duplicates(table: Table, form: Callable[[str], Hashable]) -> None:
    """Note each key that says the same as an earlier one; ``form`` is equal for such keys."""
    seen: dict[Hashable, str] = {}
    for key in list(table.keys()):
        first = seen.setdefault(form(key), key)
        if first != key:
            table.add_problem(key, Wording("DEF340", "says_same_only", first=repr(first)))


def statement_form(key: str) -> Hashable:
    """Return a CL statement without what does not matter in it: case, blanks, and the order of what is behind the
    slash.
    """
    major, _, words = "".join(key.upper().split()).partition("/")
    return major, frozenset(_word(word) for word in words.split(",") if word)


def _word(word: str) -> str | float:
    try:
        return float(word)
    except ValueError:
        return word
