"""The values of a cycle: as its definition has them and as they are when it is called, and what no cycle takes."""

import math
import re
from collections.abc import Mapping
from dataclasses import field
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.control.hole_motion import CycleExecutionError
from trunnion.readers.families.heidenhain.parameters import KlartextError, Parameters, canonical
from trunnion.readers.families.heidenhain.words import CYCLE_PARAMETERS
from trunnion.records import dataclass

#: Q parameters that have no sign: the second clearance and dwells.
_UNSIGNED: Final = (204, 210, 211)

#: The line of an older cycle: its name in the language of the control, and its value.
_LINE: Final = re.compile(r"[^0-9]*?([+-]?)[ \t]*(?:(Q[LR]?[0-9]{1,4})|([0-9]+[.,]?[0-9]*|[.,][0-9]+))[ \t]*$")

#: Words that only blocks have.
_OF_BLOCKS: Final = re.compile(
    r"(?<![A-Z0-9])(?:[MFSTR][ \t]*[0-9]+|I?[XYZABC][ \t]*[-+]?[ \t]*Q?[0-9][0-9.,]*|FMAX|R[LR]|Q[0-9]+)(?![A-Z0-9])"
)


@dataclass(slots=True)
class Cycle:
    """A cycle that blocks can call: its number, and its values by name, or by Q number in the 200 series."""

    number: int
    values: dict[str, float] = field(default_factory=dict)
    q_values: dict[int, float] = field(default_factory=dict)

    def take_values(self, parameters: Parameters) -> None:
        """Take the values that the Q parameters of the definition have when the cycle is called."""
        for number, defined in self.q_values.items():
            # A rapid feed is no value of a parameter.
            if parameters.get(f"Q{number}") is not None or defined != math.inf:
                self.q_values[number] = parameters[f"Q{number}"]


def check_given(number: int, values: Mapping[int, float]) -> None:
    """Refuse a definition without one of the Q parameters that its cycle must have."""
    if missing := [parameter for parameter in CYCLE_PARAMETERS[number] if parameter not in values]:
        names = tuple(f"Q{parameter}" for parameter in missing)
        raise CycleExecutionError(Wording("NC380", "has_no_parameter", missing=names))


def check_signs(values: Mapping[int, float], above: tuple[int, ...] = ()) -> None:
    """Refuse values below 0 that have no sign, and values not above 0 of Q parameters that must be."""
    for parameter in above:
        if not values[parameter] > 0.0:
            raise CycleExecutionError(Wording("NC380", "not_above_zero", word=f"Q{parameter}"))
    for parameter in _UNSIGNED:
        if values.get(parameter, 0.0) < 0.0:
            raise CycleExecutionError(Wording("NC380", "below_zero", word=f"Q{parameter}", value=values[parameter]))


def check_title(number: int, title: str) -> None:
    """Refuse words of blocks in the title of a cycle: it is a text of the control, which nothing executes."""
    if (found := _OF_BLOCKS.search(title)) is not None:
        raise KlartextError(Wording("NC210", "word_in_title", word=found[0].strip(), number=number))


def last_value(text: str, parameters: Parameters) -> float:
    """Return the value of the line of an older cycle."""
    match = _LINE.fullmatch(text)
    if match is None:
        raise KlartextError(Wording("NC210", "number_missing"))
    value = parameters[canonical(match[2])] if match[2] else float(match[3].replace(",", "."))
    return -value if match[1] == "-" else value
