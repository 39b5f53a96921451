"""The coolant of a program against COOLNT in the CL files, as far as the control or its definition knows the words."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.messages import Wording, phrase
from trunnion.model.run import EventValue, Run, RunEvent
from trunnion.records import dataclass
from trunnion.verification.block_names import block_name
from trunnion.verification.context import ComparedContext, check_from_places
from trunnion.verification.event_words import event_word
from trunnion.verification.expected.states import all_coolants, coolant_states
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.results import Check, Place

#: Coolant words of the CL file as they show in a run; the others are M words of the machine builder, whose meaning only
#: a definition knows.
_COOLANT: Final = {"OFF": "off", "ON": "flood", "FLOOD": "flood", "TAP": "flood", "MIST": "mist", "THRU": "through"}

#: Coolant for which every control has a word of its own.
_OWN: Final = ("off", "flood")


def is_builder_coolant(word: str) -> bool:
    """Whether only the machine builder may have a word for coolant that a CL file asks for."""
    return _COOLANT.get(word) not in _OWN


@dataclass(frozen=True, slots=True, eq=False)
class _CoolantWords:
    """Coolant words of a program, and rows before which words of the machine builder stand.

    names    of the kinds of coolant that the CL file asks for
    rows     (k,) int64, the rows before which ``changes`` stand
    changes  row, state and event of each
    builder  (m,) int64
    stops    rows before which the program stops for the operator
    stays_off  (m,) int64, the rows before which a word switches off, and no word of the builder stands behind it there
    carried  tool changes over which coolant is left on, each with the row before which the next word of coolant stands
    """

    names: Mapping[str, str]
    rows: Ints
    changes: list[tuple[int, str, RunEvent]]
    builder: Ints
    stays_off: Ints
    stops: frozenset[int]
    carried: list[tuple[RunEvent, int]]

    @staticmethod
    def of(run: Run, defined: Mapping[str, int]) -> "_CoolantWords":
        """Return the words of a run; ``defined`` has the M number that the control's definition states for a kind."""
        named = {number: _COOLANT.get(kind, kind.lower()) for kind, number in reversed([*defined.items()])}
        names = {**_COOLANT, **{kind: named[number] for kind, number in defined.items()}}
        changes, builder, last = list[tuple[int, str, RunEvent]](), list[int](), dict[int, str]()
        carried, change, flows = list[tuple[RunEvent, int]](), None, False
        for event in run.events:
            if event.kind == "tool_change" and flows:
                change, flows = event, False
            if event.kind not in ("coolant", "m"):
                continue
            name = str(event.value) if event.kind == "coolant" else _name_of(event.value, named)
            last[event.before_row] = name
            if name:
                changes.append((event.before_row, name, event))
                carried += [(change, event.before_row)] if change is not None else []
                change, flows = None, name != "off"
            else:
                builder.append(event.before_row)
        carried += [(change, len(run))] if change is not None else []
        stays_off = np.array([row for row, name in last.items() if name == "off"], np.int64)
        rows = np.array([row for row, _, _ in changes], np.int64)
        stops = frozenset(event.before_row for event in run.events if event.kind in ("stop", "optional_stop"))
        return _CoolantWords(names, rows, changes, np.array(builder, np.int64), stays_off, stops, carried)

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
        """Rows and states of the changes after a row, up to the row ``last``; at a stop the one that it ends with."""
        first, end = np.searchsorted(self.rows, [row, last], "right").tolist()
        for k in range(first, end):
            at, state, _ = self.changes[k]
            if at not in self.stops or k + 1 == len(self.changes) or self.changes[k + 1][0] != at:
                yield at, state

    def carried_into(self, row: int, last: int) -> RunEvent | None:
        """Return the tool change over which the coolant of rows was left on; None: the program says it behind one."""
        return next((event for event, end in self.carried if event.before_row <= last and row < end), None)

    def is_off_before(self, row: int) -> bool:
        """Whether coolant is off right before a row, or was at any time between the row before it and it."""
        first, end = int(np.searchsorted(self.rows, row)), int(np.searchsorted(self.rows, row, "right"))
        before = ["off"] if first == 0 else []
        return "off" in [*before, *(state for _, state, _ in self.changes[max(first - 1, 0) : end])]


def _name_of(number: EventValue, named: Mapping[int, str]) -> str:
    """Return the coolant that an M word of the builder switches, as the definition states it; empty: it states none."""
    return named.get(int(number), "") if isinstance(number, float) else ""


def check_coolant(context: ComparedContext) -> Check:
    """Coolant at every CL point."""
    run, matching, defined = context.run, context.matching, context.settings.coolant
    words = _CoolantWords.of(run, defined)
    places: list[Place] = []
    asked: set[str] = set()
    carried: list[RunEvent] = []
    unread: set[str] = set()
    before = ""
    for state in coolant_states(context.expected):
        first, end = matching.pair_range(state.first, state.end)
        if first == end:
            continue
        wanted = words.names.get(state.value)
        row, last = matching.nc[first], matching.nc[end - 1]
        after = matching.nc[first - 1] if first else -1
        by_builder = words.has_builder_word(after, row)
        unknown = by_builder or bool(unread) or (wanted == "through" and state.value not in defined)
        of_builder = wanted not in _OWN and words.at(row) != wanted
        if wanted is None or (of_builder and unknown):
            unread.add(state.value)
            if not by_builder and (state.value != before or words.has_own_word(after, row)):
                said = Wording("coolant", "no_word", wanted=state.value)
                places.append(context.place_with_cl(row, 0.0, said, matching.cl[first]))
            off = words.stays_off[(words.stays_off > row) & (words.stays_off <= last)]
            if len(off):
                said = Wording("coolant", "switched_off", wanted=state.value)
                places.append(context.place(int(off[0]), 0.0, said))
        else:
            asked.add(wanted)
            change = words.carried_into(row, last) if wanted != "off" else None
            carried += [change] if change is not None and change not in carried else []
            fault = _fault(words, wanted, row, last, readable=not unread)
            if fault is not None and fault.at_point:
                places.append(context.place_with_cl(fault.row, 0.0, fault.said, matching.cl[first]))
            elif fault is not None:
                places.append(context.place(min(fault.row, len(run) - 1), 0.0, fault.said))
        before = state.value
    anywhere = {words.names.get(word) for word in all_coolants(context.expected)}
    for _, name, event in words.changes:
        if not unread and None not in anywhere and name not in asked | anywhere | {"off"}:
            places.append(context.place_of_event(event, 0.0, Wording("coolant", "never_asked", kind=event_word(name))))
    told = {place.nc_line for place in places}
    places += (place for place in _changes_in_holes(context, words) if place.nc_line not in told)
    places.sort(key=lambda place: place.nc_line)
    good = Wording("coolant", "good", kinds=tuple(map(event_word, sorted(asked)))) if asked else None
    found = check_from_places("coolant", places, good)
    missing = () if places else tuple(phrase("coolant_unread", kind=kind) for kind in sorted(unread))
    if not places:
        missing += tuple(phrase("coolant_carried", block=block_name(-1, event.line)) for event in carried)
    return replace(found, missing=missing)


def _changes_in_holes(context: ComparedContext, words: _CoolantWords) -> Iterator[Place]:
    """Yield the first word in each hole that takes away its coolant before the tool has left it.

    No CL point lies between the depth and the way out, where chips need the coolant most.
    """
    for hole in match_holes(context.run, context.expected) if words.changes else ():
        first, last = hole.first + 1, hole.end - 1
        on = words.at(first)
        changed = [(row, state) for row, state in words.between(first, last) if state != on]
        if on != "off" and changed:
            said = Wording("coolant", "changes_in_hole", has=event_word(on))
            yield context.place(changed[0][0], 0.0, said)


@dataclass(frozen=True, slots=True, eq=False)
class _Fault:
    """A row with wrong coolant; ``at_point``: it belongs to the CL point from which on the state is expected."""

    row: int
    said: Wording
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
            return _Fault(last, Wording("coolant", "still_on")) if still_on else None
    now = words.at(row)
    if differs(now):
        return _Fault(row, Wording("coolant", "other", has=event_word(now), wanted=event_word(wanted)))
    for changed, state in words.between(row, last):
        if differs(state):
            return _Fault(changed, Wording("coolant", "changes", wanted=event_word(wanted)), at_point=False)
    return None
