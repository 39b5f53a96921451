"""What a curve does at its ends."""

import math
from typing import Final, TypeAlias

from trunnion.errors import InputError, argument_problem
from trunnion.messages import Wording
from trunnion.records import dataclass

Vector: TypeAlias = tuple[float, float, float]


#: Shorter vectors have no direction, and longer ones no curve.
_LEAST: Final = 1e-12


@dataclass(frozen=True, slots=True)
class Natural:
    """No curvature at the end."""


@dataclass(frozen=True, slots=True)
class Tangent:
    """A given direction in the sense of the path.

    vector     mm
    is_derivative  it is the derivative with respect to the parameter; else a direction, and the derivative is as long
                   as the chords are together, the speed at which the whole curve is run through
    """

    vector: Vector
    is_derivative: bool = False

    def derivative(self, chords: float) -> Vector:
        """Return the derivative with respect to the parameter of a curve whose chords are ``chords`` mm long
        together.
        """
        if self.is_derivative:
            return self.vector
        scale = chords / math.hypot(*self.vector)
        x, y, z = self.vector
        return x * scale, y * scale, z * scale


End: TypeAlias = Natural | Tangent


@dataclass(frozen=True, slots=True)
class Ends:
    """Both ends of a curve."""

    start: End = Natural()
    end: End = Natural()

    @property
    def is_natural(self) -> bool:
        """Whether no end has a direction."""
        return isinstance(self.start, Natural) and isinstance(self.end, Natural)


def parse_end(argument: str, text: object) -> End:
    """Return an end from ``natural``, ``tangent:X,Y,Z`` or ``derivative:X,Y,Z``.

    Raises ``InputError`` for another text; ``argument`` names it.
    """
    if isinstance(text, Natural | Tangent):
        return text
    kind, _, numbers = str(text).partition(":")
    if kind == "natural" and not numbers:
        return Natural()
    try:
        x, y, z = (float(number) for number in numbers.split(","))
    except ValueError:
        raise InputError(argument_problem(argument, Wording("IMP131", "is", text=repr(text)))) from None
    length = math.hypot(x, y, z)
    if kind not in ("tangent", "derivative") or not _LEAST < length < 1.0 / _LEAST:
        raise InputError(argument_problem(argument, Wording("IMP131", "is", text=repr(text))))
    return Tangent((x, y, z), is_derivative=kind == "derivative")
