"""What the report of a simulation shows, as values from which its page is made.

Units:  mm, mm², mm³, seconds. Text from outside has been cleaned of characters that no file can hold.
"""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class FindingRow:
    """A finding, or a near miss: what, where in the programs, when (s), where (mm), how deep or how far apart (mm)."""

    what: str
    between: str
    place_in_program: str
    cl_place: str
    seconds: float
    place: tuple[float, float, float]
    size: float


@dataclass(frozen=True, slots=True)
class OperationRow:
    """What consecutive blocks with one tool did."""

    where: str
    tool: str
    removed: float
    gouged: float
    seconds: float
    air: float
    findings: int


@dataclass(frozen=True, slots=True)
class DeviationBin:
    """So much of the surface, mm², deviates from ``low`` to ``high`` mm."""

    low: float
    high: float
    area: float


@dataclass(frozen=True, slots=True)
class StockState:
    """The stock after a set-up.

    name       of the set-up; empty where there is only one
    left       the most that it has beyond the design, mm, and its volume; None without a design
    gouge      the most that is missing of the design, and its volume
    deviation  of its surface from the design, in bins from missing to left
    pictures   from where it is seen, and the picture as PNG
    """

    name: str
    removed: float
    left: tuple[float, float] | None
    gouge: tuple[float, float] | None
    deviation: tuple[DeviationBin, ...]
    pictures: tuple[tuple[str, bytes], ...]


@dataclass(frozen=True, slots=True)
class SimulationContent:
    """A simulation.

    facts    names and values of what it is about
    remarks  what was taken for granted or broken off
    data     all of it, as the command prints it as data
    """

    title: str
    passed: bool
    facts: tuple[tuple[str, str], ...]
    findings: tuple[FindingRow, ...]
    near: tuple[FindingRow, ...]
    operations: tuple[OperationRow, ...]
    states: tuple[StockState, ...]
    remarks: tuple[str, ...]
    data: Mapping[str, object]
