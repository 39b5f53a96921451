"""Whether the programs of a simulation keep the axes within their travel.

In:     the runs of a set-up.
Out:    what the check ``travel`` says of each, as ``trunnion verify`` makes it; and its lines.
"""

from collections.abc import Iterable, Iterator

from trunnion.compensation.stretches import RegisterValue
from trunnion.messages import LIBRARY, Words
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.verification import Check, ExpectedValues, place_line, verify


@dataclass(frozen=True, slots=True)
class ProgramTravel:
    """What the check ``travel`` says of a program."""

    program: str
    check: Check

    def lines(self, words: Words = LIBRARY) -> Iterator[str]:
        """Yield the answer, and where axes go beyond their travel."""
        yield f"{self.program}: {self.check.line(words)}"
        if not self.check.passed:
            yield from (place_line(self.program, place, words) for place in self.check.places)


def judged_travel(runs: Iterable[Run], holds: RegisterValue) -> Iterator[ProgramTravel]:
    """Yield what is said of each program that moves; ``holds``: what radius compensation works with."""
    for run in runs:
        if len(run):
            checks = verify(run, settings=ExpectedValues(register_holds=holds), columns=False).checks
            yield ProgramTravel(run.files[0], next(check for check in checks if check.key == "travel"))


def travel_data(found: Iterable[ProgramTravel]) -> list[dict[str, str]]:
    """Return what data says of travel: of each program its state, and what was found or is missing."""
    return [{"program": each.program, "state": str(each.check.state), "summary": each.check.told} for each in found]
