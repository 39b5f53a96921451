"""The tables of places in the pages on templates and hooks, made of their declarations; run as a module, this writes
them.
"""

from dataclasses import fields
from pathlib import Path
from typing import Final

from tests.support.locations import DOCS
from trunnion.controls.places import OUTPUT_PLACES, OutputPlace
from trunnion.hooks.places import PLACE_RECORDS, Place

TEMPLATES: Final = DOCS / "templates.md"
HOOKS: Final = DOCS / "hooks.md"

_BEGIN: Final = "<!-- places: made by tests/support/places_page.py -->\n"
_END: Final = "<!-- end of places -->\n"


def _names(place: OutputPlace) -> str:
    return ", ".join(f"`{name}…`" if name.endswith("_") else f"`{name}`" for name in place.templates)


def _of_template(place: OutputPlace) -> tuple[str, ...]:
    return _names(place), f"`{place.function}`" if place.function else "[`on_event`](hooks.md)", place.meaning


def _of_function(place: OutputPlace) -> tuple[str, ...]:
    record = PLACE_RECORDS.get(place.name, Place)
    more = [each.name for each in fields(record) if each.name not in {base.name for base in fields(Place)}]
    return f"`{place.function}`", f"`{record.__name__}`", ", ".join(f"`{name}`" for name in more), place.words


def _with_table(page: Path, rows: list[tuple[str, ...]]) -> str:
    """A page with the rows in place of its table."""
    before, begin, rest = page.read_text(encoding="utf-8").partition(_BEGIN)
    _, end, after = rest.partition(_END)
    head, *others = rows
    lines = (head, tuple("---" for _ in head), *others)
    return before + begin + "".join(f"| {' | '.join(row)} |\n" for row in lines) + end + after


def pages() -> dict[Path, str]:
    """The pages as they must be."""
    functions = [_of_function(place) for place in OUTPUT_PLACES if place.function and place.name in PLACE_RECORDS]
    return {
        TEMPLATES: _with_table(TEMPLATES, [("template", "function", "where"), *map(_of_template, OUTPUT_PLACES)]),
        HOOKS: _with_table(HOOKS, [("function", "record", "it has besides", "words it can change"), *functions]),
    }


if __name__ == "__main__":
    for path, text in pages().items():
        path.write_text(text, encoding="utf-8", newline="\n")
