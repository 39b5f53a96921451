"""What a simulation and a check of collisions find: one record for both."""

import math
from enum import StrEnum

from trunnion.records import dataclass


class What(StrEnum):
    """What is wrong."""

    RAPID = "rapid through stock"
    GOUGE = "gouge"
    STANDING = "cuts with the spindle off"
    SHANK = "shank into stock"
    HOLDER = "holder into stock"
    BODY = "collision"
    NEAR = "near"


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong, or comes near, in consecutive rows of a run.

    between   names of the two bodies
    rows      first and last row of the run
    worst     the row in which it is worst
    depth     how deep it is there, mm; of bodies that only come near each other, how far apart they are
    place     where that is, mm in workpiece coordinates
    fraction  part of the worst row that is done then; NaN: as the tool first covers the place
    begin     part of the first row that is done where it begins
    """

    what: What
    between: tuple[str, str]
    rows: tuple[int, int]
    worst: int
    depth: float
    place: tuple[float, float, float]
    fraction: float = math.nan
    begin: float = 0.0

    @property
    def is_near(self) -> bool:
        """Whether bodies only come near each other."""
        return self.what is What.NEAR
