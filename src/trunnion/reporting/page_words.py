"""The language of a page while it is made.

In:     the words of who asks.
Out:    texts of the catalogue ``report`` and of wordings, as plain text.

What a page says is made at once, within ``in_language``, and nothing of it later: no other page has its language.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Final

from trunnion.messages import LIBRARY, Wording, Words, word_said
from trunnion.verification.standing import Verdict

_WORDS: Final[ContextVar[Words]] = ContextVar("page_words", default=LIBRARY)

#: What ``lang`` of a page says, and languages say of their letters.
_TAGS: Final = {"zh": "zh-CN"}


@contextmanager
def in_language(words: Words) -> Iterator[None]:
    """Say what is made within in a language."""
    before = _WORDS.set(words)
    try:
        yield
    finally:
        _WORDS.reset(before)


def page_words() -> Words:
    """Return the words of the page that is made."""
    return _WORDS.get()


def language_tag() -> str:
    """Return what ``lang`` of the page says."""
    return _TAGS.get(page_words().language, page_words().language)


def label(variant: str, /, **parameters: object) -> str:
    """Return a text of the catalogue ``report``."""
    return told(Wording("report", variant, **parameters))


def on_sheet(variant: str, /, **parameters: object) -> str:
    """Return a text of the catalogue ``sheet``: of setup sheets."""
    return told(Wording("sheet", variant, **parameters))


def on_survey(variant: str, /, **parameters: object) -> str:
    """Return a text of the catalogue ``survey``."""
    return told(Wording("survey", variant, **parameters))


def told(wording: Wording) -> str:
    """Return what a wording says."""
    return wording.text("what", page_words())


def word(text: str) -> str:
    """Return a word of the library, such as an outcome."""
    return told(word_said(text))


def said_on_page(text: str | Wording) -> str:
    """Return a wording, or a word of the library."""
    return word(text) if isinstance(text, str) else told(text)


def verdict_word(verdict: Verdict) -> str:
    """Return a verdict as it is read."""
    return told(Wording("", verdict.value))
