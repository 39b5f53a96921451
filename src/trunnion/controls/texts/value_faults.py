"""What Python says of values that do not fit an expression, in the words of those who write templates."""

import re
from typing import Final

from trunnion.controls.texts.values import Fault
from trunnion.messages import Wording, phrase

#: Types of values, as people call them.
_KINDS: Final = {
    "str": "a_text",
    "int": "number",
    "float": "number",
    "Length": "number",
    "bool": "a_condition",
    "NoneType": "an_absent_value",
    "tuple": "a_list",
    "list": "a_list",
    "Record": "a_tool_or_an_operation",
}

_COMPARED: Final = re.compile(r"'([<>]=?)' not supported between instances of '(\w+)' and '(\w+)'")
_SEARCHED: Final = re.compile(r"argument of type '(\w+)' is not (?:iterable|a container)")


def value_fault(error: Exception) -> Fault:
    """Return what an expression did that its values do not allow."""
    if (found := _COMPARED.match(str(error))) is not None:
        return Fault("compares_other_kinds", left=_kind(found[2]), right=_kind(found[3]), operator=found[1])
    if (found := _SEARCHED.match(str(error))) is not None:
        return Fault("looks_within_other_kind", value=_kind(found[1]))
    if isinstance(error, RecursionError):
        return Fault("too_deep")
    return Fault("not_allowed_by_values")


def _kind(name: str) -> Wording:
    return phrase(_KINDS.get(name, "another_thing"))
