"""What people read is short: no sentence of the pages has more than 35 words; words of code are not counted."""

import re
from collections.abc import Iterator

import pytest

from tests.support.locations import TESTS

ROOT = TESTS.parent
PAGES = sorted(
    page.relative_to(ROOT).as_posix()
    for page in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")]
)
MOST_WORDS = 35


def blocks(text: str) -> Iterator[str]:
    """Paragraphs, items of lists and cells of tables."""
    text = re.sub(r"```.*?```|<!--.*?-->", "", text, flags=re.DOTALL)
    text = re.sub(r"^(\||#|\s*(?:[-*]|\d+\.) )", r"\n\1", text, flags=re.MULTILINE)
    for paragraph in re.split(r"\n\s*\n", text):
        yield from re.split(r"(?<!\\)\|", paragraph)


def sentences(block: str) -> list[str]:
    """Its sentences without code, the targets of links, and marks of bold and italic."""
    block = re.sub(r"`[^`]*`|\]\([^)]*\)|[*_\[\]]", " ", block)
    return re.split(r"(?<=[.?!:;])\s+", " ".join(block.split()))


@pytest.mark.parametrize("page", PAGES)
def test_no_sentence_is_long(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    long = [
        sentence
        for block in blocks(text)
        for sentence in sentences(block)
        if len(re.findall(r"[^\W_][\w'’./-]*", sentence)) > MOST_WORDS
    ]
    assert not long, "\n".join(long)
