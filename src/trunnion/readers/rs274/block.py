"""Blocks of languages of the RS274 kind: letters with numbers, in any order, blanks ignored."""

import re
from collections.abc import Callable, Collection
from dataclasses import field
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.rs274.expressions import MAX_VALUE, Arithmetic, BlockError, ExpressionReader, Parameters, Value
from trunnion.records import dataclass

#: Longer lines are no blocks.
MAX_LENGTH: Final = 8192

#: No control has larger codes.
_MAX_CODE: Final = 100_000

#: A block of nothing but letters with numbers, and one of these.
_PLAIN = re.compile(r"(?:[A-Z][-+]?(?:[0-9]++(?:\.[0-9]*+)?+|\.[0-9]+))+")
_PLAIN_WORD = re.compile(r"([A-Z])([-+]?[0-9.]+)")

#: What divides a line into code and comments.
_COMMENT = re.compile(r"[(;]")

_NUMBERED = re.compile(r"N([0-9]{1,15})(?:\.[0-9]*)?")


@dataclass(frozen=True, slots=True)
class Number:
    """The value of a word; ``whole`` if it is a number without a point, ``point`` if one with a point."""

    value: float
    whole: bool = False
    point: bool = False


@dataclass(slots=True)
class Block:
    """The words of a block.

    words        by letter, other than N, G and M
    g            G codes in the order of the block, in tenths: G54.1 is 541
    m            M codes
    assignments  new values of parameters, which hold from the next block on
    used         letters of the words that have been used
    """

    words: dict[str, Number] = field(default_factory=dict)
    g: list[int] = field(default_factory=list)
    m: list[int] = field(default_factory=list)
    assignments: list[tuple[int | str, Value]] = field(default_factory=list)
    used: set[str] = field(default_factory=set)

    def take(self, letter: str) -> float | None:
        """Return the value of a word and mark it as used; None if there is no such word."""
        number = self.words.get(letter)
        if number is None:
            return None
        self.used.add(letter)
        return number.value

    def unused(self) -> list[str]:
        """Return the letters of words that have not been used."""
        return [letter for letter in self.words if letter not in self.used]


@dataclass(frozen=True, slots=True)
class Line:
    """A line without its comments and block number, in capitals and without blanks.

    number      N number, -1 for none
    skip_level  the line begins with a slash, and the digit after it, or 1; -1: it does not
    comments    without their parentheses
    """

    text: str
    number: int = -1
    skip_level: int = -1
    comments: tuple[str, ...] = ()


def split_line(raw: str, *, semicolon: bool) -> Line:
    """Split a line into its parts; BlockError if a comment does not end.

    semicolon   a semicolon begins a comment; else it ends the block
    """
    parts: list[str] = []
    comments: list[str] = []
    at = 0
    while at < len(raw):
        begin = _COMMENT.search(raw, at)
        if begin is None:
            parts.append(raw[at:])
            break
        parts.append(raw[at : begin.start()])
        if begin.group() == ";":
            rest = raw[begin.end() :]
            if semicolon:
                comments.append(rest)
            elif rest.strip():
                raise BlockError(Wording("NC210", "something_stands_behind_end_block"))
            break
        end = raw.find(")", begin.end())
        if end < 0:
            raise BlockError(Wording("NC210", "comment_does_not_end"))
        comments.append(raw[begin.end() : end])
        at = end + 1
    outside = "".join(parts)
    if not outside.isascii():  # a blank or a letter that only looks like one, and that no control takes
        strange = next(character for character in outside if not character.isascii())
        raise BlockError(Wording("NC210", "not_ascii", found=repr(strange)))
    text = "".join(outside.split()).upper()
    skip_level = -1
    if text.startswith("/"):
        has_level = text[1:2].isdigit()
        skip_level = int(text[1]) if has_level else 1
        text = text[2:] if has_level else text[1:]
    number = -1
    match = _NUMBERED.match(text)
    if match is not None:
        number = int(match.group(1))
        text = text[match.end() :]
    return Line(text, number, skip_level, tuple(comments))


def read_block(
    reader: ExpressionReader,
    on_repeated_word: Callable[[str], None],
    corners: Collection[str] = (),
    signs: Collection[str] = (),
) -> Block:
    """Read the rest of a block; ``on_repeated_word`` is called with the letter of a word that is written twice.

    corners  letters that may stand behind a comma: such a word is another one than that of the letter
    signs    that stand for a letter of a word
    """
    block = Block()
    if (plain := _PLAIN.fullmatch(reader.text, reader.at)) is not None:
        for letter, written in _PLAIN_WORD.findall(plain[0]):
            has_point = "." in written
            _add_word(block, letter, Number(_checked(float(written)), not has_point, has_point), on_repeated_word)
        reader.at = plain.end()
    while not reader.ended:
        letter = reader.letter()
        if letter == "#":
            key = reader.parameter_key()
            block.assignments.append((key, reader.assigned_value()))
            continue
        if letter == "," and reader.rest[:1] in corners:
            letter += reader.letter()
        elif not ("A" <= letter <= "Z" or letter in signs):
            raise BlockError(Wording("NC210", "not_a_word", found=repr(letter)))
        begin = reader.at
        value, whole = reader.signed_value()
        if value is None:
            # A word whose value is an unset parameter counts as not written.
            continue
        written = reader.text[begin : reader.at]
        number = Number(value, whole, "." in written and not {"#", "["} & set(written))
        _add_word(block, letter, number, on_repeated_word)
    return block


def _add_word(block: Block, letter: str, number: Number, on_repeated_word: Callable[[str], None]) -> None:
    if letter == "G":
        block.g.append(_code(number.value, letter, 10))
    elif letter == "M":
        block.m.append(_code(number.value, letter, 1))
    else:
        if letter in block.words:
            on_repeated_word(letter)
        block.words[letter] = number


def block_reader(text: str, arithmetic: Arithmetic, parameters: Parameters) -> ExpressionReader:
    """Return a reader at the start of a block, whose comments are left out.

    BlockError if it is too long, or the end of a comment stands alone, as behind one with parentheses of its own.
    """
    if len(text) > MAX_LENGTH:
        raise BlockError(Wording("NC214", "long_block", most=MAX_LENGTH))
    if ")" in text:
        raise BlockError(Wording("NC210", "closes_no_comment"))
    return ExpressionReader(text, arithmetic, parameters)


def _checked(value: float) -> float:
    """Return a number that is not too large; BlockError if it is."""
    if abs(value) > MAX_VALUE:
        raise BlockError(Wording("NC215", "number_too_large"))
    return value


def _code(value: float, letter: str, parts: int) -> int:
    code = round(value * parts)
    if abs(value * parts - code) > 1e-3 or not 0 <= code < _MAX_CODE:
        raise BlockError(Wording("NC210", "number_with_tenth" if parts > 1 else "whole_number", word=letter))
    return code


def g_code_text(code: int) -> str:
    """Return the word of a G code: 541 is G54.1."""
    whole, tenth = divmod(code, 10)
    return f"G{whole}.{tenth}" if tenth else f"G{whole}"
