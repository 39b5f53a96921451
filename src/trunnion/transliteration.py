"""Names and texts in the characters that a control has: transliterated where its encoding lacks one, never lost.

In:     text of any script and origin.
Out:    text that an encoding can hold, on one line, without characters that act on what shows it.
"""

import re
from functools import lru_cache
from typing import Final
from unicodedata import normalize

#: What breaks a line, acts on a terminal, or is a letter that shows nothing, and stands for a blank. Tabs stay.
_BREAKS: Final = re.compile("[\x00-\x08\x0a-\x1f\x7f-\x9f\u2028\u2029\u115f\u1160\u2800\u3164\uffa0]+")

#: What has no width, turns the order of a line round, or is no character: joiners, selectors of variants, tags.
_MARKS: Final = re.compile(
    "[\u00ad\u034f\u061c\u17b4\u17b5\u180b-\u180f\u200b-\u200f\u202a-\u202e\u2060-\u206f\ufdd0-\ufdef\ufe00-\ufe0f\ufeff"
    "\ufff0-\ufffb\ufffe\uffff\ud800-\udfff\U000e0000-\U000e0fff"
    + "".join(f"{chr(plane + 0xFFFE)}{chr(plane + 0xFFFF)}" for plane in range(0x10000, 0x110000, 0x10000))
    + "]"
)

#: What shows something else in each font, if anything.
_PRIVATE: Final = re.compile("[\ue000-\uf8ff\U000f0000-\U0010ffff]")

#: German has two letters for one with an umlaut, which no table of single characters knows.
_GERMAN: Final = {"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss", "ẞ": "SS", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue"}

#: Stands for a character that has no transliteration.
_NO_LETTER: Final = "_"


def spelled(text: str, encoding: str) -> str:
    """Return a text on one line in the characters of an encoding, of which ASCII is a part.

    >>> spelled("GRÖSSE der Öffnung", "ascii"), spelled("轮毂 ä", "latin-1"), spelled("轮毂", "gbk")
    ('GROESSE der Oeffnung', 'LunGu ä', '轮毂')
    """
    if text.isascii() and text.isprintable():
        return text
    plain = normalize("NFC", _PRIVATE.sub(_NO_LETTER, _MARKS.sub("", _BREAKS.sub(" ", text))))
    if _has(plain, encoding):
        return plain
    letters = [letter if _has(letter, encoding) else _ascii(letter) for letter in plain]
    for k, letter in enumerate(plain):
        beside = plain[max(k - 1, 0) : k] + plain[k + 1 : k + 2]
        if letters[k] != letter and letter in _GERMAN and beside.isupper():
            letters[k] = letters[k].upper()
    return "".join(letters)


def is_seen(text: str) -> bool:
    """Whether every character of a text shows something, or is a blank: none is hidden, or acts on what shows it."""
    return not any(pattern.search(text) for pattern in (_BREAKS, _MARKS, _PRIVATE)) and "\t" not in text


def lacking(text: str, encoding: str) -> str:
    """Return the first character of a text that an encoding lacks; empty if it has all."""
    return "" if _has(text, encoding) else next(letter for letter in text if not _has(letter, encoding))


def _has(text: str, encoding: str) -> bool:
    if text.isascii():
        return True
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


@lru_cache(maxsize=4096)
def _ascii(letter: str) -> str:
    from anyascii import anyascii  # its tables are read for the few texts that need them

    return _GERMAN.get(letter) or anyascii(letter) or _NO_LETTER
