"""The tables of words in the pages of RS-274 readers, made of the readers' own; run as a module, this writes them."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from tests.support.locations import DOCS
from trunnion.readers.families.fanuc import words as fanuc
from trunnion.readers.families.fidia import words as fidia
from trunnion.readers.families.linuxcnc import words as linuxcnc
from trunnion.readers.rs274.word_table import Effect, Word, WordTable

#: The table of each page, and the letters of words that its control takes one of a group in a block.
TABLES: Final = {"fanuc": (fanuc.TABLE, "G"), "linuxcnc": (linuxcnc.TABLE, "GM"), "fidia": (fidia.TABLE, "G")}

_BEGIN: Final = "<!-- words: made by tests/support/words_page.py -->\n"
_END: Final = "<!-- end of words -->\n"
_HEAD: Final = "| word | letters | what it does |\n| --- | --- | --- |\n"
_EFFECTS: Final = {Effect.WARNING: "warning: ", Effect.ERROR: "error: "}


def file_of(name: str) -> Path:
    """The page of a family."""
    return DOCS / f"reader-{name}.md"


def page(name: str) -> str:
    """The page of a family as it must be."""
    before, begin, rest = file_of(name).read_text(encoding="utf-8").partition(_BEGIN)
    _, end, after = rest.partition(_END)
    table, letters = TABLES[name]
    return before + begin + _HEAD + "".join(_rows(table)) + f"\n{_groups(table, letters)}\n" + end + after


def _rows(table: WordTable) -> Iterator[str]:
    """The rows, each for the words of one record, in the order of the codes; words without a code are the last."""
    rows: dict[tuple[object, ...], list[Word]] = {}
    for word in table:
        rows.setdefault((word.row, word.does, word.effect, word.letters), []).append(word)
    for words in sorted(rows.values(), key=lambda words: (words[0].code < 0, words[0].row[0], words[0].code)):
        yield f"| {_names(words)} | {_letters(words[0])} | {_meaning(words[0])} |\n"


def _names(words: list[Word]) -> str:
    if words[0].code < 0:
        return f'"{words[0].text}"'
    if ".." in words[0].row:
        return f"`{words[0].text}` to `{words[-1].text}`"
    return " ".join(f"`{word.text}`" for word in words)


def _letters(word: Word) -> str:
    """The letters of a word with the values that they may have."""
    plain = " ".join(f"`{letter}`" for letter in dict.fromkeys(word.letters + word.needs) if letter not in word.values)
    return ", ".join(filter(None, (plain, *(f"`{letter}`: {values}" for letter, values in word.values.items()))))


def _meaning(word: Word) -> str:
    if word.effect is Effect.NONE:
        return word.does or "no effect on the path"
    return _EFFECTS.get(word.effect, "") + word.does


def _groups(table: WordTable, letters: str) -> str:
    groups = (
        [word.text for word in table.words(letter, sorted(group))]
        for letter in letters
        for group in table.groups[letter]
    )
    return "Groups: " + "; ".join(" ".join(f"`{text}`" for text in group) for group in groups if len(group) > 1) + "."


if __name__ == "__main__":
    for each in TABLES:
        file_of(each).write_text(page(each), encoding="utf-8", newline="\n")
