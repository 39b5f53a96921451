"""Names and texts in the characters that a control has: transliterated where its encoding lacks one, never lost.

In:     text of any script and origin.
Out:    text that an encoding can hold, on one line, without characters that act on what shows it.
"""

import re
from functools import lru_cache
from typing import Final
from unicodedata import normalize

#: What breaks a line, or acts on a terminal, and stands for a blank. Tabs stay.
_BREAKS: Final = re.compile("[\x00-\x08\x0a-\x1f\x7f-\x9f\u2028\u2029]+")

#: What has no width, or turns the order of a line round.
_MARKS: Final = re.compile("[\u00ad\u061c\u200b-\u200f\u202a-\u202e\u2060-\u206f\ufeff\ud800-\udfff\ufff9-\uffff]")

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
    plain = normalize("NFC", _MARKS.sub("", _BREAKS.sub(" ", text)))
    if _has(plain, encoding):
        return plain
    letters = [letter if _has(letter, encoding) else _ascii(letter) for letter in plain]
    for k, letter in enumerate(plain):
        beside = plain[max(k - 1, 0) : k] + plain[k + 1 : k + 2]
        if letters[k] != letter and letter in _GERMAN and beside.isupper():
            letters[k] = letters[k].upper()
    return "".join(letters)


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
