"""Splits a line of a program into tokens: names, single letters, numbers, texts and signs."""

import math
import re
from collections.abc import Mapping
from enum import IntEnum
from functools import lru_cache
from typing import Final, NamedTuple

#: Longer statements are not executed; the control itself allows 512 characters.
MAX_LENGTH: Final = 4096

#: Tokens of longer statements are not cached: they would fill the memory.
_REMEMBERED: Final = 128

#: Numbers with more digits are mistakes of the program.
_MOST_DIGITS: Final = 40


class TokenKind(IntEnum):
    """The kind of a token."""

    NAME = 0
    LETTER = 1
    NUMBER = 2
    TEXT = 3
    SIGN = 4
    BAD = 5


class Token(NamedTuple):
    """A token: its text (names and letters in capitals), its number, and its position in the line."""

    kind: TokenKind
    text: str
    value: float
    start: int
    end: int


#: Tokens whose text says all.
_SORTS: Final[Mapping[str | None, TokenKind]] = {
    "name": TokenKind.NAME, "letter": TokenKind.LETTER, "sign": TokenKind.SIGN,
}  # fmt: skip

_TOKEN = re.compile(
    r"""
    (?P<blank>[ \t\r\f\v]+)
  | (?P<number>(?:\d+\.?\d*|\.\d+)(?:EX[+-]?\d+)?)
  | (?P<name>\$?[A-Z_][A-Z_][A-Z0-9_]*)
  | (?P<letter>[A-Z])
  | (?P<text>"[^"]*")
  | (?P<radix>'[HBD][0-9A-F]{1,13}')
  | (?P<sign><=|>=|<>|==|<<|[-+*/()\[\],=:<>])
    """,
    re.VERBOSE | re.IGNORECASE | re.ASCII,
)


def split_comment(line: str) -> tuple[str, str | None]:
    """Return a line without its comment, and the comment without its semicolon, None for none."""
    if ";" not in line:
        return line, None
    if '"' not in line:
        statement, _, comment = line.partition(";")
        return statement, comment
    quoted = False
    for at, char in enumerate(line):
        if char == '"':
            quoted = not quoted
        elif char == ";" and not quoted:
            return line[:at], line[at + 1 :]
    return line, None


def tokenize(statement: str) -> tuple[Token, ...]:
    """Split a statement into tokens; something that is no token gives one of kind BAD, which is the last."""
    return _remembered(statement) if len(statement) <= _REMEMBERED else _tokens(statement)


def _tokens(statement: str) -> tuple[Token, ...]:
    tokens: list[Token] = []
    at = 0
    for match in _TOKEN.finditer(statement):
        start, end = match.span()
        if start > at:  # what lies between is no token
            break
        at = end
        kind = match.lastgroup
        if kind in _SORTS:
            tokens.append(Token(_SORTS[kind], match[0].upper(), 0.0, start, end))
        elif kind != "blank":
            tokens.append(_token(str(kind), match[0], start, end))
    if at < len(statement):
        tokens.append(Token(TokenKind.BAD, statement[at : at + 20], 0.0, at, len(statement)))
    return tuple(tokens)


_remembered = lru_cache(maxsize=4096)(_tokens)


def _token(kind: str, text: str, start: int, end: int) -> Token:
    if kind == "number":
        value = _number(text)
        return Token(TokenKind.NUMBER if math.isfinite(value) else TokenKind.BAD, text, value, start, end)
    if kind == "radix":
        base = {"H": 16, "B": 2, "D": 10}[text[1].upper()]
        try:
            return Token(TokenKind.NUMBER, text, float(int(text[2:-1], base)), start, end)
        except ValueError:
            return Token(TokenKind.BAD, text, 0.0, start, end)
    return Token(TokenKind.TEXT, text[1:-1], 0.0, start, end)


def _number(text: str) -> float:
    if len(text) > _MOST_DIGITS:
        return math.inf
    return float(text.upper().replace("EX", "E"))
