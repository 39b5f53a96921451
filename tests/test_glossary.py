"""The glossary names code that exists, and every term once."""

import re
from importlib import import_module

from tests.support.locations import TESTS

PAGE = TESTS.parent / "docs" / "glossary.md"

#: Rows of its table: term, meaning, and where it stands in the code.
ROWS = re.findall(r"^\| (.+?) \| (.+?) \| (.*?) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)[2:]


def resolve(name: str) -> object:
    """The module, class, function or attribute with a dotted name that begins inside the package."""
    parts = ["trunnion", *name.removeprefix("trunnion.").split(".")]
    for count in range(len(parts), 0, -1):
        try:
            found: object = import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        for attribute in parts[count:]:
            fields = getattr(found, "__dataclass_fields__", {})
            found = getattr(found, attribute) if hasattr(found, attribute) else fields[attribute]
        return found
    raise LookupError(name)


def test_there_are_terms() -> None:
    assert len(ROWS) > 50


def test_every_term_stands_once_and_in_order() -> None:
    terms = [term.strip("`").lower() for term, _, _ in ROWS]
    assert len(set(terms)) == len(terms)
    assert terms == sorted(terms)


def is_there(name: str) -> bool:
    """Whether a dotted name is one of the package."""
    try:
        resolve(name)
    except (LookupError, AttributeError):
        return False
    return True


def test_the_code_that_the_glossary_names_is_there() -> None:
    names = {name for _, _, where in ROWS for name in re.findall(r"`([\w.]+)`", where)}
    assert len(names) > 150
    assert sorted(name for name in names if not is_there(name)) == []
