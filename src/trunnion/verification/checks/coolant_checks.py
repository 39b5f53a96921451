"""The coolant of a program against COOLNT in the CL files, as far as its words belong to the control."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.model.run import Run, RunEvent
from trunnion.verification.context import ComparedContext, check_from_places
from trunnion.verification.expected.states import all_coolants, coolant_states
from trunnion.verification.results import Check, Place

#: Coolant words of the CL file as they show in a run; the others are M words of the machine builder, whose meaning is
#: not known.
_COOLANT: Final = {"OFF": "off", "ON": "flood", "FLOOD": "flood", "TAP": "flood", "MIST": "mist", "THRU": "through"}

#: Coolant for which most controls have no word of their own.
_OF_BUILDER: Final = ("mist", "through")


def is_builder_coolant(word: str) -> bool:
    """Whether only the machine builder may have a word for coolant that a CL file asks for."""
    return _COOLANT.get(word) in (None, *_OF_BUILDER)


@dataclass(frozen=True, slots=True, eq=False)
class _CoolantWords:
    """Coolant words of a program, and rows before which words of the machine builder stand.

    rows     (k,) int64, the rows before which ``changes`` stand
    changes  row, state and event of each
    builder  (m,) int64
    stays_off  (m,) int64, the rows before which a word switches off, and no word of the builder stands behind it there
    """

    rows: Ints
    changes: list[tuple[int, str, RunEvent]]
    builder: Ints
    stays_off: Ints

    @staticmethod
    def of(run: Run) -> "_CoolantWords":
        changes = [(event.before_row, str(event.value), event) for event in run.events if event.kind == "coolant"]
        builder = np.array([event.before_row for event in run.events if event.kind == "m"], np.int64)
        last = {event.before_row: event for event in run.events if event.kind in ("coolant", "m")}
        stays_off = np.array([row for row, event in last.items() if event.value == "off"], np.int64)
        return _CoolantWords(np.array([row for row, _, _ in changes], np.int64), changes, builder, stays_off)

    def has_builder_word(self, after: int, row: int) -> bool:
        """Whether the machine builder has a word between the row ``after`` and another."""
        return bool(((self.builder > after) & (self.builder <= row)).any())

    def has_own_word(self, after: int, row: int) -> bool:
        """Whether the control has a coolant word between the row ``after`` and another."""
        return bool(((self.rows > after) & (self.rows <= row)).any())

    def at(self, row: int) -> str:
        """Return the state at a row."""
        k = int(np.searchsorted(self.rows, row, "right"))
        return self.changes[k - 1][1] if k else "off"

    def between(self, row: int, last: int) -> Iterator[tuple[int, str]]:
        """Rows and states of the changes after a row, up to the row ``last``."""
        first, end = np.searchsorted(self.rows, [row, last], "right").tolist()
        return ((at, state) for at, state, _ in self.changes[first:end])

    def is_off_before(self, row: int) -> bool:
        """Whether coolant is off right before a row, or was at any time between the row before it and it."""
        first, end = int(np.searchsorted(self.rows, row)), int(np.searchsorted(self.rows, row, "right"))
        before = ["off"] if first == 0 else []
        return "off" in [*before, *(state for _, state, _ in self.changes[max(first - 1, 0) : end])]


def check_coolant(context: ComparedContext) -> Check:
    """Coolant at every CL point."""
    run, matching, words = context.run, context.matching, _CoolantWords.of(context.run)
    places: list[Place] = []
    asked: set[str] = set()
    unread: set[str] = set()
    before = ""
    for state in coolant_states(context.expected):
        first, end = matching.pair_range(state.first, state.end)
        if first == end:
            continue
        wanted = _COOLANT.get(state.value)
        row, last = matching.nc[first], matching.nc[end - 1]
        after = matching.nc[first - 1] if first else -1
        by_builder = words.has_builder_word(after, row)
        unknown = by_builder or bool(unread) or wanted == "through"
        if wanted is None or (wanted in _OF_BUILDER and words.at(row) != wanted and unknown):
            unread.add(state.value)
            if not by_builder and (state.value != before or words.has_own_word(after, row)):
                text = (
                    f"the CL file wants coolant {state.value} from here on,"
                    " and no word of the machine builder stands here"
                )
                places.append(context.place_with_cl(row, 0.0, text, matching.cl[first]))
            off = words.stays_off[(words.stays_off > row) & (words.stays_off <= last)]
            if len(off):
                text = f"coolant is switched off; the CL file wants {state.value}"
                places.append(context.place(int(off[0]), 0.0, text))
        else:
            asked.add(wanted)
            fault = _fault(words, wanted, row, last, readable=not unread)
            if fault is not None and fault.at_point:
                places.append(context.place_with_cl(fault.row, 0.0, fault.text, matching.cl[first]))
            elif fault is not None:
                places.append(context.place(min(fault.row, len(run) - 1), 0.0, fault.text))
        before = state.value
    anywhere = {_COOLANT.get(word) for word in all_coolants(context.expected)}
    for _, name, event in words.changes:
        if not unread and None not in anywhere and name not in asked | anywhere | {"off"}:
            places.append(context.place_of_event(event, 0.0, f"coolant {name}, which the CL file never asks for"))
    good = ", ".join(sorted(asked | {word.lower() + " (not read)" for word in unread}))
    places.sort(key=lambda place: place.nc_line)
    return check_from_places("coolant", "coolant as the CL file says", places, good)


@dataclass(frozen=True, slots=True, eq=False)
class _Fault:
    """A row with wrong coolant; ``at_point``: it belongs to the CL point from which on the state is expected."""

    row: int
    text: str
    at_point: bool = True


def _fault(words: _CoolantWords, wanted: str, row: int, last: int, *, readable: bool) -> _Fault | None:
    """Return what is wrong from row ``row`` to row ``last``, where coolant should be ``wanted``.

    ``readable``: all coolant words so far were the control's own; else any of them counts as on.
    """

    def differs(state: str) -> bool:
        return state != wanted and (readable or state == "off" or wanted == "off")

    if wanted == "off":
        row += 1  # M9 acts after the motion of its block
        if row > last:
            still_on = not words.is_off_before(row)
            return _Fault(last, "coolant is still on; the CL file wants it off") if still_on else None
    now = words.at(row)
    if differs(now):
        return _Fault(row, f"coolant is {now}; the CL file wants {wanted}")
    for changed, state in words.between(row, last):
        if differs(state):
            return _Fault(changed, f"coolant changes; the CL file wants {wanted}", at_point=False)
    return None
