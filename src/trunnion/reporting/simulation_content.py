"""What the report of a simulation shows, as values from which its page is made.

Units:  mm, mm², mm³, seconds.
"""

from collections.abc import Callable, Mapping

from trunnion.messages import Wording, Words
from trunnion.records import dataclass
from trunnion.simulation.setup_findings import NearMiss, SimulatedOperation, SimulationFinding
from trunnion.verification import Verdict


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


def no_remarks(_: Words) -> tuple[str, ...]:
    """Return that nothing was taken for granted, or that it is said elsewhere."""
    return ()


@dataclass(frozen=True, slots=True)
class SimulationContent:
    """A simulation.

    verdict  on what was judged
    facts    names and values of what it is about
    remarks  returns what was taken for granted or broken off, each thing once with its count, in words
    not_checked  what was not judged, and why
    grounds  what it stands on besides the programs
    data     all of it, as the command prints it as data
    """

    title: str
    verdict: Verdict
    facts: tuple[tuple[str, str], ...]
    findings: tuple[SimulationFinding, ...]
    near: tuple[NearMiss, ...]
    operations: tuple[SimulatedOperation, ...]
    states: tuple[StockState, ...]
    remarks: Callable[[Words], tuple[str, ...]]
    data: Mapping[str, object]
    not_checked: tuple[Wording, ...] = ()
    grounds: tuple[Wording, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether nothing was found that must not be."""
        return self.verdict is not Verdict.FAILED
