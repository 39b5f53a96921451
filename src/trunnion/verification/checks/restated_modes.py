"""What runs at a stop, and whether the program says it again before the next cut.

Whether a machine switches coolant off at a stop, and the spindle at an optional one, depends on its builder, on every
control. What is not said again may be off.
"""

from bisect import bisect_right
from dataclasses import field

import numpy as np

from trunnion.arrays import Ints
from trunnion.messages import Wording
from trunnion.model.run import EventValue, Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.verification.checks.coolant_checks import is_builder_coolant

#: Values with which something runs; those of the machine builder's words are numbers.
_ON = frozenset({"clockwise", "counter-clockwise", "flood", "mist", "through"})


@dataclass(slots=True, eq=False)
class _Words:
    """Words that switch one thing, in order: their places among the events, the rows they stand before, on or off."""

    places: list[int] = field(default_factory=list)
    rows: list[int] = field(default_factory=list)
    on: list[bool] = field(default_factory=list)

    def add(self, place: int, row: int, value: EventValue) -> None:
        self.places.append(place)
        self.rows.append(row)
        self.on.append(value in _ON or isinstance(value, float))

    def runs_at(self, place: int) -> bool:
        """Whether the thing runs at a place among the events."""
        k = bisect_right(self.places, place)
        return k > 0 and self.on[k - 1]

    def last_before(self, row: int) -> int:
        """Return the place of the word that makes the thing run at a row; -1 if it stands there."""
        k = bisect_right(self.rows, row)
        return self.places[k - 1] if k and self.on[k - 1] else -1


class RestatedModes:
    """The words for spindle and coolant in a run, and the rows that cut."""

    def __init__(self, run: Run) -> None:
        self._words = {"spindle": _Words(), "coolant": _Words(), "m": _Words()}
        for place, event in enumerate(run.events):
            if event.kind in self._words:
                self._words[event.kind].add(place, event.before_row, event.value)
        self._cuts: Ints = np.flatnonzero(run.kind != Kind.RAPID)

    def spindle_turns(self, place: int) -> bool:
        """Whether the spindle turns at a place among the events: what the last word for it said."""
        return self._words["spindle"].runs_at(place)

    def unsaid(self, place: int, row: int, wanted_coolant: str) -> Wording | None:
        """Return what is wrong if something runs in the first cut after a stop, and was switched on before it; None if
        all was said again.

        place, row      the stop's place among the events, and the row before which it stands
        wanted_coolant  the CL file's word for coolant in that cut
        """
        cut = int(np.searchsorted(self._cuts, row))
        if cut == len(self._cuts):
            return None
        first = int(self._cuts[cut])
        if 0 <= self._words["spindle"].last_before(first) < place:
            return Wording("stops", "spindle_unsaid")
        if wanted_coolant == "OFF":
            return None
        coolant = self._words["coolant"].last_before(first)
        if is_builder_coolant(wanted_coolant):
            coolant = max(coolant, self._words["m"].last_before(first))
        return Wording("stops", "coolant_unsaid") if 0 <= coolant < place else None
