"""Splits a line of Klartext into its parts, and a statement into its words."""

import re
from typing import Final, NamedTuple

from trunnion.encoding import capitals
from trunnion.messages import Wording
from trunnion.readers.families.heidenhain.parameters import KlartextError

#: Longer statements are not executed.
MAX_LENGTH: Final = 4096

#: Numbers with more digits are mistakes of the program.
MOST_DIGITS: Final = 40

_HEAD = re.compile(r"[ \t]*(/?)[ \t]*([0-9]{1,15}(?![0-9.,]))?[ \t]*(/?)[ \t]*")
_COMMENT = re.compile(r'(?:[^;"]|"[^"]*"?)*')
_WORD = re.compile(
    r"""[ \t]*(?:
    "(?P<text>[^"]*)"
  | (?P<name>P[123][XYZ]|DR2|HSC-MODE|[A-Z]+?):?(?:[ \t]*(?P<sign>[+-])[ \t]*|[ \t]*)
    (?:(?P<parameter>Q[LR]?[0-9]{1,4})|(?P<number>[0-9]+[.,]?[0-9]*|[.,][0-9]+))
  | (?P<flag>[A-Z]+[+-]?)
  )""",
    re.VERBOSE | re.ASCII,
)

#: Incremental words.
_INCREMENTAL: Final = frozenset({"IX", "IY", "IZ", "IA", "IB", "IC", "IU", "IV", "IW", "IPR", "IPA", "IROT"})


class Line(NamedTuple):
    """The parts of a line.

    number      number of the block, -1 for none
    block_skip  the line begins with a slash
    statement   in capitals except for texts
    comment     without its semicolon, None for none
    continues   a ``~`` at the end continues the block in the next line
    """

    number: int
    block_skip: bool
    statement: str
    comment: str | None
    continues: bool


class Operand(NamedTuple):
    """A number, or a parameter whose value is looked up when the block is executed; and its sign."""

    sign: float
    number: float
    parameter: str


class Word(NamedTuple):
    """A word: its name, without the I of incremental words, and its operand; flags (FMAX, DR+) and texts have none."""

    name: str
    operand: Operand | None = None
    incremental: bool = False
    text: str | None = None


def split_line(raw: str) -> Line:
    """Split a line into its parts."""
    head = _HEAD.match(raw)
    assert head is not None
    number = int(head.group(2)) if head.group(2) else -1
    rest = raw[head.end() :]
    continues = rest.rstrip().endswith("~")
    if continues:
        rest = rest.rstrip()[:-1].rstrip()
    comment = None
    if rest.startswith("*"):
        return Line(number, bool(head.group(1) or head.group(3)), "", rest[1:].strip("\r"), continues)
    if ";" in rest:
        words = _COMMENT.match(rest)
        assert words is not None
        if words.end() < len(rest):
            comment, rest = rest[words.end() + 1 :].strip("\r"), rest[: words.end()]
    statement = rest.strip()
    if '"' not in statement:
        statement = capitals(statement)
    else:
        statement = '"'.join(part if k % 2 else capitals(part) for k, part in enumerate(statement.split('"')))
    return Line(number, bool(head.group(1) or head.group(3)), statement, comment, continues)


def words(statement: str, at: int = 0) -> list[Word]:
    """Split a statement, from a position on, into words.

    Raises ``KlartextError`` if there is something that is not a word.
    """
    found: list[Word] = []
    end = len(statement.rstrip())
    while at < end:
        match = _WORD.match(statement, at)
        if match is None:
            raise KlartextError(Wording("NC210", "not_a_word", found=statement[at : at + 20].strip()))
        found.append(_word(match))
        at = match.end()
    return found


def _word(match: re.Match[str]) -> Word:
    text, name, number = match["text"], match["name"], match["number"]
    if text is not None:
        return Word("", text=text)
    if name is None:
        return Word(match["flag"])
    sign = -1.0 if match["sign"] == "-" else 1.0
    incremental = name in _INCREMENTAL
    operand = Operand(sign, 0.0 if number is None else number_of(number), match["parameter"] or "")
    return Word(name[1:] if incremental else name, operand, incremental)


def number_of(text: str) -> float:
    """Return a number written with a point or a comma."""
    if len(text) > MOST_DIGITS:
        raise KlartextError(Wording("NC210", "too_many_digits", text=text[:20], most=MOST_DIGITS))
    return float(text.replace(",", "."))
