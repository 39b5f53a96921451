"""The encoding of the names in a CL file or NC program: UTF-8, the Chinese GB18030 (which contains GBK), or Latin-1.

Neither declares it; a control's definition may. Numbers and words are ASCII in all of them; only names and texts are
not.
"""

import codecs
import re
from typing import Final, NamedTuple
from unicodedata import category

_NON_ASCII = re.compile(rb"([A-Za-z]?)([\x80-\xff]+)([\x40-\x7e]?)")
_LETTER = re.compile(rb"[A-Za-z]")

#: What programs may be written in, by Python's names.
ENCODINGS: Final = ("utf-8", "ascii", "latin-1", "gbk")

#: So many stretches of non-ASCII bytes are evidence enough.
_MAX_STRETCHES = 4096


#: Capitals of the ASCII letters alone: ``upper`` would make an S of the long s as well.
_CAPITALS = {ord(letter): letter.upper() for letter in "abcdefghijklmnopqrstuvwxyz"}


def capitals(text: str) -> str:
    """Return a text with its ASCII letters in capitals; other characters are no words, and stay as they are."""
    return text.translate(_CAPITALS)


class TextForm(NamedTuple):
    """How the characters of a program become bytes: Python's name of the encoding, and what ends a line."""

    encoding: str = "utf-8"
    line_end: bytes = b"\n"


def decode(data: bytes, stated: str = "") -> str:
    """Return bytes as text: in the stated encoding, or where there is none or they are not, in the likeliest one."""
    for encoding in filter(None, (stated, "utf-8")):
        try:
            return data.decode(encoding)
        except UnicodeDecodeError:
            pass
    detector = EncodingDetector()
    detector.add(data)
    try:
        return data.decode(detector.encoding())
    except UnicodeDecodeError:
        return data.decode("latin-1")


class EncodingDetector:
    """Takes a file piece by piece, and names its encoding at the end."""

    def __init__(self) -> None:
        self._utf8: codecs.IncrementalDecoder | None = codecs.getincrementaldecoder("utf-8")("strict")
        self._unlikely_utf8 = True
        self._stretches = 0
        self._hanzi = 0
        self._others = 0

    def add(self, piece: bytes) -> None:
        """Look at the next piece of the file."""
        pending = self._utf8 is not None and self._utf8.getstate()[0] != b""
        if piece.isascii() and not pending:
            return
        if self._utf8 is not None:
            try:
                self._utf8.decode(piece)
            except UnicodeDecodeError:
                self._utf8 = None
        for stretch in _NON_ASCII.finditer(piece):
            if self._stretches >= _MAX_STRETCHES:
                break
            self._stretches += 1
            self._unlikely_utf8 = self._unlikely_utf8 and _is_unlikely_utf8(stretch[2])
            hanzi, others = _count_characters(*stretch.groups())
            self._hanzi += hanzi
            self._others += others

    def encoding(self) -> str:
        """Python's name of the encoding."""
        chinese = self._hanzi > self._others
        if self._utf8 is not None and self._utf8.getstate()[0] == b"" and not (chinese and self._unlikely_utf8):
            return "utf-8"
        return "gb18030" if chinese else "latin-1"


def _is_unlikely_utf8(high: bytes) -> bool:
    """Whether bytes that may be valid UTF-8 stand for letters that no name has.

    A single Chinese character in GBK can look like a two-byte character of UTF-8: a phonetic sign, a letter of a rare
    alphabet, or one that is not assigned.
    """
    text = high.decode("utf-8", "replace")
    return all(
        "\u0250" <= letter < "\u0370" or "\u0530" <= letter < "\u0800" or category(letter) == "Cn" for letter in text
    )


def _count_characters(before: bytes, high: bytes, after: bytes) -> tuple[int, int]:
    """Count common Chinese characters, and other things, in a stretch of high bytes between its neighbours.

    The everyday characters (GB 2312 level 1) and the full-width signs have both bytes above 0xA0, and the first one in
    a narrow range. An accented letter of a European word stands between ASCII letters, mostly alone; two of them that
    happen to make a Chinese character, as in ``GRÖßE``, are recognized by the letters on both sides.
    """
    hanzi = others = 0
    for first, second in zip(high[::2], high[1::2], strict=False):
        common = (0xB0 <= first <= 0xD7 or 0xA1 <= first <= 0xA3) and second >= 0xA1
        hanzi += common
        others += not common
    others += len(high) % 2
    if len(high) == 2 and before and _LETTER.match(after):
        return 0, hanzi + others
    return hanzi, others
