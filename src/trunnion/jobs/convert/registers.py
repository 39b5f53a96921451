"""What registers of a program are on the other control, checked before any work."""

import re
from collections.abc import Mapping
from typing import Final

from trunnion.conversion import TOOL
from trunnion.errors import InputError, argument_problem
from trunnion.messages import Wording

_REGISTER: Final = re.compile(r"[DH][1-9][0-9]{0,4}")


def checked_registers(registers: object) -> Mapping[str, str]:
    """Return what is stated of registers, in capitals.

    Raises ``InputError`` of the argument.
    """
    if registers is None:
        return {}
    if not isinstance(registers, Mapping):
        raise InputError(argument_problem("registers", Wording("ARG140", "no_mapping", type=type(registers).__name__)))
    found = {str(name).upper(): str(value) for name, value in registers.items()}
    for name, value in found.items():
        is_number = _REGISTER.fullmatch(value.upper()) is not None and value[:1].upper() == name[:1]
        if not _REGISTER.fullmatch(name) or not (value == TOOL or is_number):
            raise InputError(argument_problem("registers", Wording("CNV112", "no_register", value=f"{name}={value}")))
    return found
