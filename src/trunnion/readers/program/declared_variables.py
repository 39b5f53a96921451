"""Values of variables that stand in a control before a program runs: ``[control.reading.variables]``."""

import re
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from trunnion.definitions import Table
from trunnion.errors import Severity
from trunnion.messages import Wording

#: The code under which a value that is taken is noted.
OF_VARIABLES: Final = "NC227"

#: A definition that declares none.
NO_VARIABLES: Final[Mapping[str, float]] = MappingProxyType({})


def read_variables(table: Table, names: re.Pattern[str], example: str) -> dict[str, float]:
    """Read the declared values; mistakes are added to the table's problems.

    table    ``[control.reading]``
    names    what variables of the family are called; zeros in front of a number do not count
    example  such a name, for messages
    """
    own = table.table("variables")
    values: dict[str, float] = {}
    for key in own.names():
        value = own.number(key)
        if names.fullmatch(key) is None:
            own.add_problem(key, Wording("NC190", "no_variable", example=example))
        else:
            values[key] = value
    own.report_unread_keys()
    return values


class DeclaredVariables:
    """The declared values of a running program, each of which is noted once, when it is first used.

    leave   takes name and value of a variable that keeps what the program sets when the program has ended
    """

    def __init__(
        self,
        values: Mapping[str, float],
        note: Callable[[Wording, Severity], None],
        leave: Callable[[str, float | None], None],
    ) -> None:
        self._values = values
        self._note = note
        self._leave = leave
        self._told: set[str] = set()

    def __contains__(self, name: str) -> bool:
        return name in self._values

    def get(self, name: str) -> float | None:
        """Return the value of a variable, None if nothing declares it."""
        value = self._values.get(name)
        if value is not None and name not in self._told:
            self._told.add(name)
            self._note(Wording(OF_VARIABLES, "declared_value", name=name, value=value), Severity.WARNING)
        return value

    def set(self, name: str, value: float | None, *, outlives: bool) -> None:
        """Take what the program sets a variable to.

        outlives   the control keeps it, as it does each that the definition declares
        """
        if outlives or name in self._values:
            self._leave(name, value)


#: For programs of controls of which nothing is declared.
NOTHING_DECLARED: Final = DeclaredVariables(NO_VARIABLES, lambda _wording, _severity: None, lambda _name, _value: None)
