"""One CL statement taken apart: ``MAJOR/minor,minor`` into words and numbers, or text left as it stands."""

import re
from math import isfinite
from typing import NamedTuple

from trunnion.cl.diagnostics import StatementError

_TEXT_STATEMENT = re.compile(
    rb"(?:(TOOL[ \t]*PATH|PPRINT|INSERT|DISPLA?Y|PARTNO|TPRINT)|(STOP|OPSTOP)(?=[ \t]*(?:/|\Z)))[ \t]*(/?)(.*)",
    re.IGNORECASE | re.DOTALL,
)
_TEXT_FIRST_BYTES = frozenset(b"TPIDSOtpidso")
_CONTINUED = re.compile(r"\$[ \t\r]*(?:\$\$[^\n]*)?\n")
_CONTROL = re.compile(rb"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")
_NUMBER_FIRST = frozenset("+-.0123456789")
_NUMBER_LAST = frozenset(".0123456789")

#: No length, feed or angle of a machine tool is larger; what is, is a slip of the file.
_MAX_NUMBER = 1e12


class Statement(NamedTuple):
    """A statement: upper-case major; words upper-case and numbers as floats, or for text majors the text."""

    major: str
    values: tuple[str | float, ...]
    text: str
    source: str

    def numbers(self, *counts: int) -> tuple[float, ...]:
        """Return the values if they are numbers, and as many as one of ``counts``."""
        return numbers(self.major, self.values, *counts)

    def words(self) -> list[str]:
        """Return the words among the values."""
        return [value for value in self.values if isinstance(value, str)]


def numbers(major: str, values: tuple[str | float, ...], *counts: int) -> tuple[float, ...]:
    """Return ``values`` if they are finite numbers, and as many as one of ``counts`` (if any is given)."""
    for value in values:
        if isinstance(value, str):
            raise StatementError(f"{major} has {value or 'nothing'!r} where a number belongs", "write a decimal number")
        if value > _MAX_NUMBER or value < -_MAX_NUMBER:
            raise StatementError(
                f"{major} has the number {value}", "write finite numbers of a size that a machine can have"
            )
    if counts and len(values) not in counts:
        wanted = " or ".join(map(str, counts))
        raise StatementError(
            f"{major} has {len(values)} numbers, expected {wanted}", "look for a missing or an extra comma"
        )
    return values  # type: ignore[return-value]


def parse(raw: bytes, encoding: str) -> Statement:
    """Take the bytes of a statement apart; continuation lines are still in it."""
    raw = raw.rstrip(b" \t\r\n\x1a")
    if control := _CONTROL.search(raw):
        raise StatementError(
            f"unknown encoding: byte 0x{control.group()[0]:02x} in a statement",
            "save the file as plain text (ASCII, UTF-8, GBK or Latin-1)",
        )
    if raw[:1] and raw[0] in _TEXT_FIRST_BYTES and (text := _TEXT_STATEMENT.match(raw)):
        return _text_statement(text, raw, encoding)
    source = plain = raw.decode(encoding, "replace")
    if "$" in plain:
        plain = _CONTINUED.sub("", plain).partition("$$")[0]
    if "\r" in plain:
        raise StatementError("a carriage return without a line feed", "save the file with LF or CRLF line ends")
    major, slash, rest = plain.partition("/")
    name = "".join(major.split()).upper()
    if "$" in name or "$" in rest:
        raise StatementError(
            f"{name} has a dollar sign within the line", "a dollar sign continues a line only at its end"
        )
    return Statement(name, _values(rest) if slash else (), "", source)


def _text_statement(match: re.Match[bytes], raw: bytes, encoding: str) -> Statement:
    if b"\r" in raw:
        raise StatementError("a carriage return without a line feed", "save the file with LF or CRLF line ends")
    major = "".join((match[1] or match[2]).decode("ascii").split()).upper()
    text = match[4].decode(encoding, "replace")
    # Only INSERT goes into the program letter by letter.
    return Statement(major, (), text if major == "INSERT" else text.strip(), raw.decode(encoding, "replace"))


def _values(rest: str) -> tuple[str | float, ...]:
    """Return what stands between the commas."""
    fields = rest.split(",")
    if "_" not in rest and rest.isascii():
        try:
            plain = tuple(map(float, fields))
        except ValueError:
            pass
        else:
            # The words INF and NAN are numbers to Python, but not in a CL file.
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


def is_whole(value: float, least: int) -> bool:
    """Whether a number is whole and at least ``least``."""
    return isfinite(value) and value == int(value) and value >= least
