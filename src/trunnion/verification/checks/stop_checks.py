"""Where a program waits or stops, against the DELAY, STOP and OPSTOP of the CL files."""

from collections import defaultdict
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import Final

from trunnion.model.run import Happening, Run
from trunnion.model.toolpath import Dwell, Stop
from trunnion.verification.context import NAMED, Case, judged
from trunnion.verification.matching.hole_matching import made_in
from trunnion.verification.results import Check, Place

_KINDS: Final = ("dwell", "stop", "optional_stop")

#: Half of the last digit of dwells, seconds.
_SECONDS: Final = 5.1e-4


@dataclass(frozen=True, slots=True)
class _Asked:
    """A DELAY, STOP or OPSTOP before CL row ``row``; ``amount`` in seconds, or spindle turns if negative."""

    row: int
    kind: str
    amount: float
    file: str
    line: int

    def __str__(self) -> str:
        return _words(self.kind, self.amount)


def stops(case: Case) -> Check:
    """Each dwell and stop between the two points between which it stands, and no others within an operation.

    Between operations, where tools are changed, a program may have stops of its own. Dwells at the bottom of holes are
    the business of the holes.
    """
    wanted, pairs, run = case.wanted, case.pairs, case.run
    assert wanted is not None
    assert pairs is not None
    asked: defaultdict[int, list[_Asked]] = defaultdict(list)
    for part in wanted.parts:
        for event in part.operation.events:
            if isinstance(event, Dwell | Stop):
                row = part.first + event.row
                asked[pairs.cl.before(row)].append(_asked(event, row, part.file))
    said: defaultdict[int, list[Happening]] = defaultdict(list)
    for happening in _outside_holes(case):
        said[pairs.nc.before(happening.before_row)].append(happening)
    places: list[Place] = []
    for k in sorted(asked.keys() | said.keys()):
        here = said[k] if _within(case, k) else [event for event in said[k] if _is_asked(run, event, asked[k])]
        for want, has in zip_longest(asked[k], here):
            if want is None:
                if not _inserted(case, k):
                    text = f"{_words(has.kind, _amount(has))}, which the CL file does not ask for"
                    places.append(case.at(has, 0.0, text))
            elif has is None:
                place = case.missing(min(want.row, len(wanted) - 1), f"the CL file wants {want} before this")
                places.append(replace(place, cl_file=want.file, cl_line=want.line))
            elif not _same(run, has, want):
                place = case.at(has, 0.0, f"{_words(has.kind, _amount(has))}; the CL file wants {want}")
                places.append(replace(place, cl_file=want.file, cl_line=want.line))
    count = {kind: sum(one.kind == kind for each in asked.values() for one in each) for kind in _KINDS}
    names = {"dwell": "dwells", "stop": "stops", "optional_stop": "optional stops"}
    good = ", ".join(f"{count[kind]} {names[kind]}" for kind in _KINDS if count[kind]) or "the CL file has none"
    return judged("stops", "stops and dwells as the CL file says", places[:NAMED], good, len(places) or None)


def _asked(event: Dwell | Stop, row: int, file: str) -> _Asked:
    if isinstance(event, Dwell):
        return _Asked(row, "dwell", -event.amount if event.revolutions else event.amount, file, event.line)
    return _Asked(row, "optional_stop" if event.optional else "stop", 0.0, file, event.line)


def _outside_holes(case: Case) -> list[Happening]:
    """What the program itself says of dwells and stops, without what is done in a hole."""
    events = [event for event in case.run.events if event.kind in _KINDS]
    if not events:
        return []
    made = made_in(case.run, case.wanted)
    return [event for event in events if not any(hole.first < event.before_row < hole.end for hole in made)]


def _within(case: Case, k: int) -> bool:
    """Whether pair ``k`` and the one before it belong to one operation."""
    assert case.wanted is not None
    assert case.pairs is not None
    if not 0 < k < len(case.pairs.cl):
        return False
    return case.wanted.part_of(case.pairs.cl[k - 1]) is case.wanted.part_of(case.pairs.cl[k])


def _inserted(case: Case, k: int) -> bool:
    """Whether the CL file puts a text of its own (INSERT) before the point of pair ``k``."""
    assert case.wanted is not None
    assert case.pairs is not None
    first = case.pairs.cl[k - 1] + 1 if k else 0
    return any(row in case.wanted.inserts for row in range(first, case.pairs.cl[k] + 1))


def _is_asked(run: Run, event: Happening, asked: list[_Asked]) -> bool:
    return any(_same(run, event, want) for want in asked)


def _amount(event: Happening) -> float:
    return event.value if isinstance(event.value, float) else 0.0


def _same(run: Run, event: Happening, want: _Asked) -> bool:
    if event.kind != want.kind:
        return False
    rpm = float(run.state.rpm[min(event.before_row, len(run) - 1)]) if len(run) else 0.0
    return abs(_seconds(_amount(event), rpm) - _seconds(want.amount, rpm)) <= _SECONDS


def _seconds(amount: float, rpm: float) -> float:
    return amount if amount >= 0.0 else -60.0 * amount / max(rpm, 1e-9)


def _words(kind: str, amount: float) -> str:
    if kind == "dwell":
        return f"a dwell of {amount:g} s" if amount >= 0.0 else f"a dwell of {-amount:g} turns"
    return "a stop" if kind == "stop" else "an optional stop"
