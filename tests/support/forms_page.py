"""The table of forms of programs in the page of readers, made of the readers' keys; run as a module, it is written."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from tests.support.locations import DOCS
from trunnion.readers.program.forms import FormKey, form_keys

FILE: Final[Path] = DOCS / "reader.md"

_BEGIN: Final = "<!-- forms: made by tests/support/forms_page.py -->\n"
_END: Final = "<!-- end of forms -->\n"
_HEAD: Final = "| key | may be | families | meaning |\n| --- | --- | --- | --- |\n"

_NAMES: Final = {
    "fanuc": "Fanuc, Haas", "linuxcnc": "LinuxCNC", "fidia": "Fidia", "sinumerik": "Sinumerik",
    "heidenhain": "Klartext",
}  # fmt: skip


def page() -> str:
    """The page as it must be."""
    before, begin, rest = FILE.read_text(encoding="utf-8").partition(_BEGIN)
    _, end, after = rest.partition(_END)
    return before + begin + _HEAD + "".join(_rows()) + end + after


def _rows() -> Iterator[str]:
    for key in form_keys():
        families = ", ".join(_NAMES[family] for family in key.families)
        yield f"| `{key.name}` | {_words(key)} | {families} | {key.meaning} |\n"


def _words(key: FormKey) -> str:
    words = ", ".join(f'`"{word}"`' for word in key.words)
    return f"a list of {words}" if key.several else words


if __name__ == "__main__":
    FILE.write_text(page(), encoding="utf-8", newline="\n")
