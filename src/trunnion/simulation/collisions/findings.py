"""What a collision check finds."""

from dataclasses import dataclass

Place = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Collision:
    """Two bodies that touch, or come nearer to each other than was asked, in an unbroken stretch of rows.

    between         names of both bodies
    row, fraction   where the stretch begins: a row of the run, and the part of it that is done, 0 to 1
    last_row        where it ends
    worst_row, worst_fraction   where it is worst
    depth_mm        how deep they are in each other there, at least; 0 where they only come near
    distance_mm     how far apart they are there; 0 where they touch
    place           where that is, mm in workpiece coordinates
    """

    between: tuple[str, str]
    row: int
    fraction: float
    last_row: int
    worst_row: int
    worst_fraction: float
    depth_mm: float
    distance_mm: float
    place: Place

    @property
    def is_near(self) -> bool:
        """Whether the bodies only come near each other."""
        return self.distance_mm > 0.0
