"""The language of a page: which it is, and what the page says in it.

In:     the language that somebody has stated, the request of a browser, the catalogue of a page.
Out:    ``Words``, and the texts of a page by their keys, as its modules take them (``web/texts.js``).
"""

import re
from collections.abc import Callable
from typing import Any, Final

from trunnion.messages import ENGLISH, LANGUAGES, Words, catalogue, library_words, said_in
from trunnion.records import dataclass

#: What HTML calls a language where that is not its key.
_TAGS: Final = {"zh": "zh-Hans"}

#: A language that a browser asks for, and how much it wants it.
_WISH: Final = re.compile(r"([a-zA-Z]{2,3})(?:-[a-zA-Z0-9-]*)? *(?:; *q *= *([01](?:\.[0-9]{0,3})?))?", re.ASCII)

#: So much of what a browser asks for is read.
_MOST_LETTERS: Final = 500


@dataclass(frozen=True, slots=True)
class Speech:
    """Which language a served page speaks.

    words   of who serves it, for a language
    stated  the language that somebody has stated; empty: that of each browser
    """

    words: Callable[[str], Words] = library_words
    stated: str = ""

    def to(self, request: Any) -> Words:
        """Return the words for who makes a Starlette request: ``?lang=`` in the page's address goes first."""
        asked = request.query_params.get("lang", "")[:2]
        chosen = asked if asked in LANGUAGES else self.stated or _accepted(request.headers.get("accept-language", ""))
        return self.words(chosen)

    def known(self, language: object) -> Words:
        """Return the words of the language that a page says it has; of one that there is not, those that are stated."""
        chosen = language if isinstance(language, str) and language in LANGUAGES else self.stated or ENGLISH
        return self.words(chosen)


#: The language that each browser asks for, in the words of the library.
OF_BROWSERS: Final = Speech()


def language_tag(language: str) -> str:
    """Return what HTML calls a language."""
    return _TAGS.get(language, language)


def page_texts(page: str, language: str) -> dict[str, str]:
    """Return the texts of a page's catalogue by their keys; what the language lacks is English."""
    return {
        key: said_in(language, page, key) for key, text in catalogue(ENGLISH, page).items() if isinstance(text, str)
    }


def _accepted(header: str) -> str:
    """Return the language of ours that a browser wants most; English if it wants none."""
    wishes = [found for part in header[:_MOST_LETTERS].split(",") if (found := _WISH.fullmatch(part.strip()))]
    ranked = sorted(wishes, key=lambda wish: -float(wish[2] or 1.0))
    languages = [wish[1].lower() for wish in ranked if float(wish[2] or 1.0) > 0.0]
    return next((each for each in languages if each in LANGUAGES), ENGLISH)
