"""What a CAD kernel is asked for, and what it answers."""

from trunnion.arrays import Floats
from trunnion.impeller.definition import StockSize
from trunnion.impeller.solid.shapes import Body
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Order:
    """A body, the stock that it is cut out of, the angle about Z at which the stock's seam is, and the part's name."""

    body: Body
    stock: StockSize
    seam: float
    name: str


@dataclass(frozen=True, slots=True, eq=False)
class Made:
    """A valid, closed solid.

    step     the bytes of its STEP file
    volume   mm³
    faces    their number
    points   (k, 3) on its faces and edges, mm
    """

    step: bytes
    volume: float
    faces: int
    points: Floats


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why there is no such solid, as the rest of a sentence."""

    why: str
