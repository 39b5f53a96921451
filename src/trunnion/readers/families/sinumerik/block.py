"""The words of a block of a Sinumerik program."""

from collections.abc import Set
from dataclasses import field
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.readers.control.axis_word import AxisWord
from trunnion.readers.families.sinumerik.expressions import Value
from trunnion.records import dataclass

#: Fields of a block that hold one value, by their words.
_HELD: Final = {
    "F": "feed",
    "S": "speed",
    "T": "tool",
    "D": "edge",
    "OTOL": "orientation_tolerance",
    "FGREF": "feed_radius",
}


@dataclass(slots=True, eq=False)
class Call:
    """A call of a cycle, message or subprogram: the values of its arguments, and their texts."""

    name: str
    arguments: list[Value | None] = field(default_factory=list)
    argument_texts: list[str] = field(default_factory=list)
    repeats: int = 1


@dataclass(slots=True, eq=False)
class Block:
    """The words of a block.

    axes     X, Y, Z and rotary axes by name
    vector   A3, B3, C3 by letter
    params   I, J, K, I1, J1, K1, CR, AR, TURN, ANG, RPL
    words    words without a value
    polynomials  the end and the coefficients of each axis with PO[]; the empty name is the denominator
    interval     of their parameter, PL
    tolerances  within which the control may round off the path
    deltas   what the program adds to length and radius of the tool
    said     words that no path shows, with what is written behind them
    waits    words with which it waits for another channel
    feed_radius  at which F counts for rotary axes
    orientation_tolerance  OTOL, degrees
    traori   the arguments of TRAORI
    corner   RND, RNDM, CHF, CHR, FRC, FRCM
    """

    axes: dict[str, AxisWord] = field(default_factory=dict)
    vector: dict[str, float] = field(default_factory=dict)
    params: dict[str, AxisWord] = field(default_factory=dict)
    g: list[int] = field(default_factory=list)
    words: list[str] = field(default_factory=list)
    polynomials: dict[str, list[float]] = field(default_factory=dict)
    interval: float | None = None
    m: list[int] = field(default_factory=list)
    h: list[float] = field(default_factory=list)
    calls: list[Call] = field(default_factory=list)
    feed: float | None = None
    speed: float | None = None
    tool: str | None = None
    edge: int | None = None
    traori: list[Value | None] = field(default_factory=list)
    deltas: dict[str, float] = field(default_factory=dict)
    said: list[tuple[str, str]] = field(default_factory=list)
    waits: list[str] = field(default_factory=list)
    tolerances: list[float] = field(default_factory=list)
    feed_radius: float | None = None
    orientation_tolerance: float | None = None
    corner: dict[str, float] = field(default_factory=dict)

    def beside(self, these: Set[str]) -> list[str]:
        """Return what a block holds besides ``these`` fields, as a reader may look for it there."""
        found: list[str] = [*self.axes, *(f"{letter}3" for letter in self.vector), *self.params, *self.words]
        found += [f"M{code}" for code in self.m] + [f"H{value:g}" for value in self.h]
        found += [call.name for call in self.calls] + [name for name, _ in self.said] + [*self.deltas, *self.corner]
        found += [f"PO[{axis}]" for axis in self.polynomials]
        found += [word for word, name in _HELD.items() if name not in these and getattr(self, name) is not None]
        found += ["CTOL"] * len(self.tolerances)
        return found if "g" in these else [*(f"G{code}" for code in self.g), *found]

    @property
    def tool_axis(self) -> Floats | None:
        """The vector, (3,); components that are not written are 0."""
        return np.array([self.vector.get(letter, 0.0) for letter in "ABC"]) if self.vector else None
