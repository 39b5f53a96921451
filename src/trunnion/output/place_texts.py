"""Texts of a shop within the motion of operations: at cuts, cycles, coolants, rewinds, the end, and for CL statements.

In:     a planned program, whose control may have templates or functions for these places.
Out:    the program with raw text in these places, which is tried as that of INSERT is before anything is written, and
        with the words that functions have changed there.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from trunnion.controls.places import EVENT_PLACE, OUTPUT_PLACES
from trunnion.controls.template import Answer, Value
from trunnion.controls.words import WordRangeError
from trunnion.model.motion import Motion
from trunnion.model.toolpath import (
    Coolant,
    CycleOn,
    Event,
    Insert,
    Kind,
    Message,
    Phase,
    RewindMessage,
    ShopStatement,
    SpindleOn,
)
from trunnion.output.motion_texts import (
    MotionTexts,
    changed_coolant,
    changed_cycle,
    coolant_words,
    cycle_rows,
    cycle_words,
)
from trunnion.output.program import Program
from trunnion.output.template_printing import TemplatePrinting
from trunnion.output.template_values import TemplateValues, plain_text
from trunnion.output.tool_calls import LoadedTool
from trunnion.records import dataclass

_PLACES: Final = tuple(name for place in OUTPUT_PLACES if place.within for name in place.templates)


def with_place_texts(program: Program) -> Program:
    """Return a program with the texts of its control's templates for places within the motion of operations.

    Raises ``InputError`` if a template or a function does what it cannot, or prints a number beyond the limits of its
    format, or there is nothing to call a tool by.
    """
    names = program.control.templates.keys()
    if not any(name in _PLACES or name.startswith(EVENT_PLACE) for name in names):
        return program
    places = _Places(program)
    return replace(program, motions=[places.with_texts(k, motion) for k, motion in enumerate(program.motions)])


@dataclass(frozen=True, slots=True, eq=False)
class _Here:
    """A motion, and the values that templates may print there."""

    motion: Motion
    values: Mapping[str, Value]


class _Places:
    """Goes through the motions of a program and expands the templates of places in them."""

    def __init__(self, program: Program) -> None:
        self._program, self._templates = program, program.control.templates
        self._escape = partial(plain_text, program)
        self._values = TemplateValues(program)
        self._printing = TemplatePrinting(program, self._values)
        self._motion_texts = MotionTexts(program, self._printing)
        self._loaded, self._spindle = LoadedTool(), list[SpindleOn]()
        self._has_cut = False

    def with_texts(self, k: int, motion: Motion) -> Motion:
        """Return a motion with texts in place of its statements, and at its places."""
        operation, motions = motion.operation, self._program.motions
        starts = [event for event in operation.events if isinstance(event, SpindleOn)]
        spindle = [event for event in starts if event.row == 0][-1:] or self._spindle
        self._has_cut = self._has_cut and not motion.starts_operation
        values = self._values.values(motion, k, self._loaded, spindle[0] if spindle else None)
        if motion.starts_operation:
            register = self._values.tools.length_register(operation, self._loaded)
            self._loaded = LoadedTool(self._values.tools.call(operation, self._loaded), operation.tool.name, register)
        self._spindle = starts[-1:] or self._spindle
        here = _Here(motion, values)
        events = [new for event in operation.events for new in self._instead(event, here)]
        if "engage" in self._templates:
            for row in _engage_rows(motion):
                events = _with_text(events, row, self._text("engage", row, here))
        if not self._has_cut and "first_cut" in self._templates:
            events = self._with_first_cut(events, here)
        events = self._motion_texts.joined(events, k, values)
        if "retract" in self._templates and (k + 1 == len(motions) or motions[k + 1].starts_operation):
            events += self._text("retract", len(operation.moves), here)
        return replace(motion, operation=replace(operation, events=tuple(events)))

    def _instead(self, event: Event, here: _Here) -> list[Event]:
        """Return what stands in place of an event."""
        if isinstance(event, RewindMessage):
            return [*self._text("rewind", event.row, here), event]
        if isinstance(event, CycleOn) and "cycle" in self._templates:
            own = {"kind": event.mode[0] if event.mode else "", "mode": event.mode, "words": cycle_words(event)}
            answer = self._answer("cycle", event.row, here, own)
            return [*self._as_events("cycle", event.row, event.line, answer), changed_cycle(event, answer)]
        if isinstance(event, Coolant) and "coolant" in self._templates:
            own = {"kind": event.kind, "words": coolant_words(self._program, event)}
            answer = self._answer("coolant", event.row, here, own)
            new = changed_coolant(self._program, here.motion, event, answer)
            return [*self._as_events("coolant", event.row, event.line, answer), new]
        name = EVENT_PLACE + _word(event)
        if name not in self._templates:
            return [event]
        # Raw text is words of the program, and no part of a comment.
        text = getattr(event, "text", "")
        text = text if isinstance(event, Insert) else self._escape(text)
        words: tuple[str, ...] = ()
        numbers: tuple[float, ...] = ()
        if isinstance(event, ShopStatement):
            words, numbers = tuple(map(self._escape, event.words)), event.numbers
        values = {**here.values, "text": text, "number": numbers[0] if numbers else None}
        lists = {"words": words, "numbers": numbers}
        printing = self._printing.of(here.motion, values, lists)
        try:
            lines = self._templates[name].expand(values, printing)
        except WordRangeError as error:
            raise error.at(self._program.file_of(here.motion.operation), event.line) from None
        return self._as_events(name, event.row, event.line, Answer(lines))

    def _with_first_cut(self, events: Sequence[Event], here: _Here) -> list[Event]:
        """Events with the text before the first motion at feed or the first hole, behind what is switched there."""
        cycles = [event.row for event in events if isinstance(event, CycleOn)]
        cuts = np.flatnonzero(here.motion.operation.moves.kind != Kind.RAPID)
        row = min([*cycles[:1], *cuts[:1].tolist()], default=-1)
        if row < 0:
            return list(events)
        self._has_cut = True
        return _with_text(events, row, self._text("first_cut", row, here))

    def _text(self, name: str, row: int, here: _Here) -> list[Event]:
        """Return the text of a place before a row, or behind the last one."""
        if name not in self._templates:
            return []
        operation = here.motion.operation
        rows = len(operation.moves)
        line = int(operation.moves.line[min(row, rows - 1)]) if rows else operation.line
        return self._as_events(name, row, line, self._answer(name, row, here, {}))

    def _answer(self, name: str, row: int, here: _Here, own: Mapping[str, object]) -> Answer:
        operation = here.motion.operation
        rows = len(operation.moves)
        line = int(operation.moves.line[min(row, rows - 1)]) if rows else operation.line
        shown = {key: str(value) for key, value in own.items() if key == "kind"}
        values = {**here.values, **shown}
        try:
            printing = self._printing.of(here.motion, values, own={**own, "row": row, "line": line})
            return self._templates[name].answer(values, printing)
        except WordRangeError as error:
            raise error.at(self._program.file_of(operation), line) from None

    def _as_events(self, name: str, row: int, line: int, answer: Answer) -> list[Event]:
        return [Insert(row, line, "\n".join(answer.lines), name)] if answer.lines else []


def _with_text(events: Sequence[Event], row: int, text: Sequence[Event]) -> list[Event]:
    """Events with a text before a row, behind what is switched there, and before its cycle."""
    at = sum(event.row < row or (event.row == row and not isinstance(event, CycleOn)) for event in events)
    return [*events[:at], *text, *events[at:]]


def _engage_rows(motion: Motion) -> list[int]:
    """Rows at which the tool begins a way into the cut."""
    moves = motion.operation.moves
    engages = moves.phase == Phase.ENGAGE
    if not engages.any():
        engages = moves.kind != Kind.RAPID
    first = np.flatnonzero(engages & ~np.concatenate(([False], engages[:-1])))
    holes = cycle_rows(motion)
    return [row for row in first.tolist() if not holes[row]]


def _word(event: Event) -> str:
    """Return the word of the CL statement that an event comes from, as names of templates have it; empty for other
    events.
    """
    if isinstance(event, Message):
        return "DISPLY" if event.display else "PPRINT"
    if isinstance(event, Insert):
        return "" if event.template else "INSERT"
    return event.word if isinstance(event, ShopStatement) else ""
