"""Which encoding the names in a CL file have: UTF-8, the Chinese GB18030 (with GBK in it), or Latin-1.

CL files do not say. Numbers and words are ASCII in all of them; only names and texts of people are not.
"""

import codecs
import re
from unicodedata import category

_RUN = re.compile(rb"([A-Za-z]?)([\x80-\xff]+)([\x40-\x7e]?)")
_LETTER = re.compile(rb"[A-Za-z]")

#: So many stretches of non-ASCII bytes are evidence enough.
_MAX_STRETCHES = 4096


class EncodingDetector:
    """Takes the file piece by piece and says in the end which encoding it is."""

    def __init__(self) -> None:
        self._utf8: codecs.IncrementalDecoder | None = codecs.getincrementaldecoder("utf-8")("strict")
        self._is_unlikely_utf8 = True
        self._seen = 0
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
        for run in _RUN.finditer(piece):
            if self._seen >= _MAX_STRETCHES:
                break
            self._seen += 1
            self._is_unlikely_utf8 = self._is_unlikely_utf8 and _unlikely_in_utf8(run[2])
            hanzi, others = _count_characters(*run.groups())
            self._hanzi += hanzi
            self._others += others

    def encoding(self) -> str:
        """Python's name of the encoding."""
        chinese = self._hanzi > self._others
        if self._utf8 is not None and self._utf8.getstate()[0] == b"" and not (chinese and self._is_unlikely_utf8):
            return "utf-8"
        return "gb18030" if chinese else "latin-1"


def _unlikely_in_utf8(high: bytes) -> bool:
    """Whether bytes are no UTF-8 that anybody writes in a name, though the rules may let them pass.

    A single Chinese character of GBK can look like a two-byte one of UTF-8: of a phonetic alphabet, or of none.
    """
    text = high.decode("utf-8", "replace")
    return all(
        "\u0250" <= letter < "\u0370" or "\u0530" <= letter < "\u0800" or category(letter) == "Cn" for letter in text
    )


def _count_characters(before: bytes, high: bytes, after: bytes) -> tuple[int, int]:
    """Count common Chinese characters, and other things, in a stretch of high bytes and its neighbours.

    The everyday characters (GB 2312 level 1) and the full-width signs have both bytes above 0xA0 and the first
    in a narrow range. A letter with an accent in a European word stands between ASCII letters, mostly alone;
    two of them that happen to make a Chinese character, as in ``GRÖßE``, are told by the letters on both sides.
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
