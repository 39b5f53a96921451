"""One CL statement taken apart: ``MAJOR/minor,minor`` into words and numbers, or into its text."""

import re
from collections.abc import Iterable
from math import isfinite
from typing import NamedTuple

from trunnion.cl.diagnostics import StatementError
from trunnion.messages import Wording

_TEXT_STATEMENT = re.compile(
    rb"(?:(TOOL[ \t]*PATH|PPRINT|INSERT|DISPLA?Y|PARTNO|TPRINT|REMARK)|(STOP|OPSTOP)(?=[ \t]*(?:/|\Z)))[ \t]*(/?)(.*)",
    re.IGNORECASE | re.DOTALL,
)
_TEXT_FIRST_BYTES = frozenset(b"TPIDSORtpidsor")
_CONTINUATION = re.compile(r"\$[ \t\r]*(?:\$\$[^\n]*)?\n")
#: Where a text goes on in the next line: the scan puts lines together only in dialects that have that.
_TEXT_CONTINUED = re.compile(rb"\$[ \t]*\r?\n")
_CONTROL_CHARACTER = re.compile(rb"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")
_NUMBER_FIRST = frozenset("+-.0123456789")
_NUMBER_LAST = frozenset(".0123456789")

#: No length, feed or angle of a machine tool is larger; a larger number is a mistake in the file.
_MAX_NUMBER = 1e12

#: No tool, register or colour has a higher number.
_MAX_WHOLE_NUMBER = 99_999_999


class Statement(NamedTuple):
    """A statement of a CL file.

    major   the word before the slash, in capitals without blanks
    values  words in capitals, and numbers; none if the statement carries text
    text    the text of a statement that carries one (PPRINT, INSERT, ...)
    source  the statement as it stands in an APT file
    """

    major: str
    values: tuple[str | float, ...]
    text: str
    source: str

    def numbers(self, *counts: int) -> tuple[float, ...]:
        """Return the values; refuse words, and any number of values that is not in ``counts``."""
        return numbers(self.major, self.values, *counts)

    def plain_numbers(self) -> tuple[float, ...]:
        """Return the numbers among the values."""
        return tuple(value for value in self.values if not isinstance(value, str))

    def listed(self) -> str:
        """Return the values as they are written, between commas."""
        return ",".join(value if isinstance(value, str) else f"{value:g}" for value in self.values)

    def words(self) -> list[str]:
        """Return the words among the values."""
        return [value for value in self.values if isinstance(value, str)]

    def refuse_contradictions(self, *choices: Iterable[str]) -> None:
        """Refuse two different words of one of the ``choices``: which of them is meant is unknown.

        Raises ``StatementError`` if there are two.
        """
        given = dict.fromkeys(self.words())
        for choice in map(frozenset, choices):
            both = [word for word in given if word in choice]
            if len(both) > 1:
                raise StatementError(
                    Wording("CL320", "contradict_each_other", major=self.major, both=both[0], other=both[1])
                )


def numbers(major: str, values: tuple[str | float, ...], *counts: int) -> tuple[float, ...]:
    """Return ``values`` if all are finite numbers and, with ``counts``, as many as one of these.

    Raises ``StatementError`` if they are not.
    """
    for value in values:
        if isinstance(value, str):
            raise StatementError(Wording("CL310", "where_number_belongs", major=major, value=repr(value or "nothing")))
        if value > _MAX_NUMBER or value < -_MAX_NUMBER:
            raise StatementError(Wording("CL360", "number", major=major, value=value))
    if counts and len(values) not in counts:
        raise StatementError(
            Wording("CL310", "number_expected", major=major, count=len(values), counts=tuple(map(str, counts)))
        )
    return values  # type: ignore[return-value]


def whole_number(major: str, values: tuple[str | float, ...]) -> int:
    """Return the only one of ``values``, which must be 0, 1, 2, ...

    Raises ``StatementError`` if it is not.
    """
    (number,) = numbers(major, values, 1)
    if not is_whole(number, 0) or number > _MAX_WHOLE_NUMBER:
        raise StatementError(Wording("CL310", "where_whole_number", major=major, number=number))
    return int(number)


def is_whole(value: float, least: int) -> bool:
    """Whether a number is whole and at least ``least``."""
    return isfinite(value) and value == int(value) and value >= least


def parse(raw: bytes, encoding: str) -> Statement:
    """Take the bytes of a statement apart, continuation lines included.

    Raises ``StatementError`` if it is not text, or a sign stands where it means nothing.
    """
    raw = raw.rstrip(b" \t\r\n\x1a")
    if control := _CONTROL_CHARACTER.search(raw):
        raise StatementError(Wording("CL150", "unknown_encoding_byte", group=control.group()[0]))
    if raw[:1] and raw[0] in _TEXT_FIRST_BYTES and (text := _TEXT_STATEMENT.match(raw)):
        return _text_statement(text, raw, encoding)
    source = raw.decode(encoding, "replace")
    if "$$" in source:
        source = _without_comment(source)
    plain = joined_lines(source) if "$" in source else source
    if "\r" in plain:
        raise StatementError(Wording("CL150", "carriage_return_without"))
    major, slash, rest = plain.partition("/")
    name = "".join(major.split()).upper()
    if "$" in name or "$" in rest:
        raise StatementError(Wording("CL160", "dollar_sign_within", name=name))
    return Statement(name, _values(rest) if slash else (), "", source)


def joined_lines(source: str) -> str:
    """Return a statement on one line, without continuation signs and the comments behind them."""
    return _CONTINUATION.sub("", source)


def comments_of(source: str) -> list[str]:
    """Return the comments of a statement that carries no text, one behind each line that has one."""
    return [line.partition("$$")[2] for line in source.split("\n") if "$$" in line]


def _without_comment(source: str) -> str:
    """Return a statement without the comment behind its last line; those of other lines stand behind a continuation
    sign.
    """
    before, newline, last = source.rpartition("\n")
    return before + newline + last.partition("$$")[0].rstrip()


def _text_statement(match: re.Match[bytes], raw: bytes, encoding: str) -> Statement:
    content = _TEXT_CONTINUED.sub(b"", match[4])
    if b"\r" in content:
        raise StatementError(Wording("CL150", "carriage_return_without"))
    major = "".join((match[1] or match[2]).decode("ascii").split()).upper()
    text = content.decode(encoding, "replace")
    # Only INSERT goes into the program letter by letter.
    return Statement(major, (), text if major == "INSERT" else text.strip(), raw.decode(encoding, "replace"))


def _values(rest: str) -> tuple[str | float, ...]:
    """Return the values between the commas."""
    fields = rest.split(",")
    if "_" not in rest and rest.isascii():
        try:
            plain = tuple(map(float, fields))
        except ValueError:
            pass
        else:
            # Python reads the words INF and NAN as numbers; in a CL file they are words.
            if isfinite(sum(plain)):
                return plain
    return tuple(map(_value, fields)) if rest.strip() else ()


def _value(field: str) -> str | float:
    """Return a number if the field is one, else the word in capitals without blanks."""
    field = field.strip()
    if field[:1] in _NUMBER_FIRST and field[-1] in _NUMBER_LAST and "_" not in field and field.isascii():
        try:
            return float(field.upper().replace("D", "E", 1))  # FORTRAN writes 1.5D3
        except ValueError:
            return field.upper()
    return "".join(field.split()).upper()
