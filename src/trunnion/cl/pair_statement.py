"""A pair of lines taken apart: the code of a record, and the values in the line below."""

import re
from typing import Final

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.statement import Statement
from trunnion.messages import Wording

_CODE: Final = re.compile(r"0|[1-9]\d{0,5}", re.ASCII)
_NUMBER: Final = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d{1,3})?", re.ASCII)
_CONTROL_CHARACTER: Final = re.compile(rb"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")

#: Major words of parameters by the first digit of their codes, and the codes of name and lengths of a tool.
PARAMETERS: Final = {"1": "10000", "2": "20000"}
TOOL_NAME: Final = "20001"
TOOL_LENGTHS: Final = "20007"
_PARAMETER_DIGITS: Final = 5

#: Letters of a line that a message shows.
_SHOWN: Final = 24


def parse_pair(raw: bytes, encoding: str) -> Statement:
    """Take a record apart: its code is the major word, its values are numbers where they are, and its text is the line.

    Parameters of operations and of tools have a code for each, from 10000 and 20000 on, and one major word.

    Raises ``StatementError`` if the first line is no code, or the pair is no text.
    """
    raw = raw.rstrip(b" \t\r\n\x1a")
    if control := _CONTROL_CHARACTER.search(raw):
        raise StatementError(Wording("CL150", "unknown_encoding_byte", group=control.group()[0]))
    code, _, text = (part.strip(" \t\r") for part in raw.decode(encoding, "replace").partition("\n"))
    if not _CODE.fullmatch(code):
        raise StatementError(Wording("CL165", "no_code", found=repr(code[:_SHOWN])))
    if "\r" in text:
        raise StatementError(Wording("CL150", "carriage_return_without"))
    fields = text.split()
    is_own = len(code) < _PARAMETER_DIGITS or code in (TOOL_NAME, TOOL_LENGTHS)
    major = code if is_own else PARAMETERS.get(code[:-4], code)
    return Statement(major, tuple(map(_value, fields)), text, f"{code}/{','.join(fields)}")


def code_of(statement: Statement) -> str:
    """Return the code of a record as it stands in the file."""
    return statement.source.partition("/")[0]


def _value(field: str) -> str | float:
    return float(field) if _NUMBER.fullmatch(field) else field
