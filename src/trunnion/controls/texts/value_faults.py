"""What Python says of values that do not fit an expression, in the words of those who write templates."""

import re
from typing import Final

from trunnion.controls.texts.values import Fault

#: Types of values, as people call them.
_KINDS: Final = {
    "str": "a text",
    "int": "a number",
    "float": "a number",
    "Length": "a number",
    "bool": "a condition",
    "NoneType": "an absent value",
    "tuple": "a list",
    "list": "a list",
    "Record": "a tool or an operation",
}

_COMPARED: Final = re.compile(r"'([<>]=?)' not supported between instances of '(\w+)' and '(\w+)'")
_SEARCHED: Final = re.compile(r"argument of type '(\w+)' is not (?:iterable|a container)")


def value_fault(error: Exception) -> Fault:
    """Return what an expression did that its values do not allow."""
    if (found := _COMPARED.match(str(error))) is not None:
        what = f"compares {_kind(found[2])} with {_kind(found[3])} by {found[1]}"
        return Fault(what, "compare numbers: | number makes one of a text, | default(0) one of an absent value")
    if (found := _SEARCHED.match(str(error))) is not None:
        return Fault(f"looks by in for something within {_kind(found[1])}", "look within a list or a text")
    if isinstance(error, RecursionError):
        return Fault("has too much within each other", "write it in smaller parts, with {% set … %}")
    return Fault("does something that its values do not allow", "see whether they are numbers, texts or lists")


def _kind(name: str) -> str:
    return _KINDS.get(name, "another thing")
