"""Texts of a shop within the motion of operations: at the first cut, rewinds, the end, and for CL statements.

In:     a planned program, whose control may have templates for these places.
Out:    the program with raw text in these places, which is tried as that of INSERT is before anything is written.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from trunnion.controls.template import Value
from trunnion.controls.vocabulary import EVENT_PLACE
from trunnion.controls.words import WordRangeError
from trunnion.model.motion import Motion
from trunnion.model.toolpath import CycleOn, Event, Insert, Kind, Message, RewindMessage, ShopStatement, SpindleOn
from trunnion.output.program import Program
from trunnion.output.template_printing import TemplatePrinting
from trunnion.output.template_values import TemplateValues, plain_text
from trunnion.output.tool_calls import LoadedTool

_MOTION_PLACES: Final = ("first_cut", "rewind", "retract")


def with_place_texts(program: Program) -> Program:
    """Return a program with the texts of its control's templates for places within the motion of operations.

    Raises ``InputError`` if a template does what it cannot, or prints a number beyond the limits of its format, or
    there is nothing to call a tool by.
    """
    names = program.control.templates.keys()
    if not any(name in _MOTION_PLACES or name.startswith(EVENT_PLACE) for name in names):
        return program
    places = _Places(program)
    return replace(program, motions=[places.with_texts(k, motion) for k, motion in enumerate(program.motions)])


class _Places:
    """Goes through the motions of a program and expands the templates of places in them."""

    def __init__(self, program: Program) -> None:
        self._program, self._templates = program, program.control.templates
        self._escape = partial(plain_text, program)
        self._values = TemplateValues(program)
        self._printing = TemplatePrinting(program, self._values)
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
        events = [new for event in operation.events for new in self._instead(event, values, motion)]
        if not self._has_cut and "first_cut" in self._templates:
            events = self._with_first_cut(events, values, motion)
        if "retract" in self._templates and (k + 1 == len(motions) or motions[k + 1].starts_operation):
            rows = len(operation.moves)
            line = int(operation.moves.line[-1]) if rows else operation.line
            events += self._text("retract", rows, line, values, motion)
        return replace(motion, operation=replace(operation, events=tuple(events)))

    def _instead(self, event: Event, values: Mapping[str, Value], motion: Motion) -> list[Event]:
        """Return what stands in place of an event."""
        if isinstance(event, RewindMessage):
            return [*self._text("rewind", event.row, event.line, values, motion), event]
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
        own = {**values, "text": text, "number": numbers[0] if numbers else None}
        lists = {"words": words, "numbers": numbers}
        return self._text(name, event.row, event.line, own, motion, lists)

    def _with_first_cut(self, events: Sequence[Event], values: Mapping[str, Value], motion: Motion) -> list[Event]:
        """Events with the text before the first motion at feed or the first hole, behind what is switched there."""
        cycles = [event.row for event in events if isinstance(event, CycleOn)]
        cuts = np.flatnonzero(motion.operation.moves.kind != Kind.RAPID)
        row = min([*cycles[:1], *cuts[:1].tolist()], default=-1)
        if row < 0:
            return list(events)
        self._has_cut = True
        at = sum(event.row < row or (event.row == row and not isinstance(event, CycleOn)) for event in events)
        text = self._text("first_cut", row, int(motion.operation.moves.line[row]), values, motion)
        return [*events[:at], *text, *events[at:]]

    def _text(
        self,
        name: str,
        row: int,
        line: int,
        values: Mapping[str, Value],
        motion: Motion,
        lists: Mapping[str, object] | None = None,
    ) -> list[Event]:
        if name not in self._templates:
            return []
        try:
            lines = self._templates[name].expand(values, self._printing.of(motion, values, lists))
        except WordRangeError as error:
            raise error.at(self._program.file_of(motion.operation), line) from None
        return [Insert(row, line, "\n".join(lines), name)] if lines else []


def _word(event: Event) -> str:
    """Return the word of the CL statement that an event comes from, as names of templates have it; empty for other
    events.
    """
    if isinstance(event, Message):
        return "DISPLY" if event.display else "PPRINT"
    if isinstance(event, Insert):
        return "" if event.template else "INSERT"
    return event.word if isinstance(event, ShopStatement) else ""
