"""Declared words without effect that stand among the other words of a block: each takes only itself out of the block.

In:     a block, and the words that may stand in it.
Out:    what is left of the block, whether the words have all of it, or letters of which nobody knows who takes them.
"""

import re
from collections.abc import Callable, Sequence
from typing import Final

from trunnion.records import dataclass

#: Letters of positions: they are never arguments of a word without effect.
_POSITION: Final = re.compile(r"(?<![A-Z_])(?:[XYZABCUVWIJK]|R(?![0-9]*[ \t]*=))(?![A-Z_])")

#: Arguments that a word may have where its block has no other code.
_ARGUMENTS: Final = re.compile(r"(?:[ELPQ][ \t]*=?[ \t]*[-+]?(?:#?[0-9]++(?:\.[0-9]*+)?+|\.[0-9]+)[ \t]*)*")
_CODE: Final = re.compile(r"(?<![A-Z_])([GM])[ \t]*0*([0-9]+(?:\.[0-9])?)|(?<![A-Z_])[A-Z_][A-Z_][A-Z0-9_]*")
_G_CODE: Final = re.compile(r"(?<![A-Z_<])G[ \t]*[0-9]", re.IGNORECASE)
_VALUES: Final = re.compile(r"\[[^\]]*\]|<[^>]*>|\"[^\"]*\"")
_COMMENT: Final = re.compile(r"\([^)]*\)|;.*")
#: What stands before a name: that of a label or of a program, of which a Klartext block may have M functions behind it.
_NAMES: Final = re.compile(
    r"(?<![A-Z_])(?:(?:GOTO[BFCS]?|PROC|EXTERN|CALL(?:[ \t]+(?:PGM|LBL))?)[ \t]+$"
    r"|REPEATB?[ \t]+(?:[A-Z0-9_]+[ \t]+)?$|DEF(?![A-Z_]))",
    re.IGNORECASE,
)
_KLARTEXT: Final = re.compile(r"(?<![A-Z0-9_])(?:M[0-9]|I?[XYZABCUVW][-+0-9Q])")
_BEGIN: Final = re.compile(r"[ \t]*/?[0-9]?[ \t]*(?:N[ \t]*[0-9]+(?:\.[0-9]*)?)?[ \t]*/?[ \t]*")


@dataclass(frozen=True, slots=True)
class Beside:
    """A block with words that are taken out of it.

    rest      what is left; empty: the words have all of it
    letters   letters of positions that no code of the rest takes; then the block is not executed
    """

    rest: str
    letters: tuple[str, ...] = ()


def without_words(text: str, found: Sequence[re.Match[str]], takes: Callable[[Sequence[str]], bool]) -> Beside:
    """Take words out of a block.

    takes   whether one of some codes takes positions, so that they are not those of a word that is taken out
    """
    rest = text
    for match in found:
        rest = f"{rest[: match.start()]}{' ' * len(match[0])}{rest[match.end() :]}"
    bare = _bare(rest)
    if _ARGUMENTS.fullmatch(bare):
        return Beside("")
    plain = _VALUES.sub("", bare)
    codes, letters = codes_of(plain), tuple(dict.fromkeys(_POSITION.findall(plain)))
    if letters and not codes and any(_G_CODE.match(match[0]) and takes(codes_of(match[0].upper())) for match in found):
        return Beside("")  # a code of the control, declared with a value of its own
    return Beside(rest, () if not letters or takes(codes) else letters)


def codes_of(text: str) -> list[str]:
    """Return the G and M codes of a block without leading zeros, and its words of several letters."""
    return [f"{match[1]}{match[2]}" if match[1] else match[0] for match in _CODE.finditer(text)]


def has_other_codes(text: str, *, of_klartext: bool) -> bool:
    """Whether a block has a G code outside its comments and texts; in Klartext, an M function or a position."""
    code = _KLARTEXT if of_klartext else _G_CODE
    return code.search(_VALUES.sub("", _bare(text))) is not None


def is_other(text: str, begin: int, end: int) -> bool:
    """Whether letters of a line are another thing than a word: of a comment or a text, a label, or the name of one."""
    before = text[:begin]
    is_quoted = ";" in before or before.count("(") > before.count(")") or before.count('"') % 2 > 0
    return is_quoted or text[end:].lstrip()[:1] == ":" or _NAMES.search(before) is not None


def _bare(text: str) -> str:
    """Return a block in capitals without comments, number and skip sign."""
    upper = _COMMENT.sub("", text.upper())
    begin = _BEGIN.match(upper)
    return upper[begin.end() if begin else 0 :].strip()
