"""The sections of a program that become operations: where they begin and end, and which events belong to them."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import field, replace

import numpy as np

from trunnion.arrays import Ints
from trunnion.conversion.program_events import ProgramEvent
from trunnion.conversion.unsupported import Warnings
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.records import dataclass


@dataclass(slots=True)
class ProgramSection:
    """The part of a program that becomes one operation.

    line         line where it begins
    first_event  index of its first event
    end_event    index after its last event, where its path has ended; -1: not yet known
    first_row    row of the run where it begins
    end_row      row after its last one
    stretches    rows that move the tool at the workpiece, (n,) each: one stretch, or several where it leaves in between
    values       values found in its header and its end: name in the templates -> text
    part         which of several operations that a section became, from 1
    """

    line: int
    first_event: int
    first_row: int
    end_event: int = -1
    end_row: int = 0
    stretches: list[Ints] = field(default_factory=list)
    values: dict[str, str] = field(default_factory=dict)
    part: int = 1

    @property
    def rows(self) -> Ints:
        """The rows (n,) of all stretches."""
        return np.concatenate([np.zeros(0, np.int64), *self.stretches])


def split_program(
    events: Sequence[ProgramEvent], row_count: int, starts: Collection[int], ends: Collection[int]
) -> list[ProgramSection]:
    """Split a program where operations begin: at the lines ``starts``, or at tool changes if there are none.

    ends   lines of comments with which the end of an operation begins
    """
    sections = [ProgramSection(1, 0, 0)]
    current_start = 0
    for k, event in enumerate(events):
        last = sections[-1]
        line = event.line if event.file == 0 else 0
        if line != current_start:
            current_start = 0
        if starts:
            begins = line in starts and line != current_start and event.kind != "skip"
        else:
            begins = event.kind == "tool_change"
        if begins:
            last.end_row, current_start = event.row, line
            last.end_event = k if last.end_event < 0 else last.end_event
            sections.append(ProgramSection(event.line, k, event.row))
        elif event.kind == "comment" and line in ends and last.end_event < 0:
            last.end_event = k
    last = sections[-1]
    last.end_row = row_count
    last.end_event = len(events) if last.end_event < 0 else last.end_event
    return sections


def divide_sections(
    events: Sequence[ProgramEvent], sections: Sequence[ProgramSection], run: Run, warn: Warnings
) -> list[ProgramSection]:
    """Sections of one stretch each.

    Between two stretches the new program goes home. Radius compensation that stays on there is refused.
    """
    divided: list[ProgramSection] = []
    for section in sections:
        first_event = section.first_event
        for k, rows in enumerate(section.stretches):
            later = (n for n in range(first_event, section.end_event) if _comes_after(events[n], int(rows[-1]), run))
            is_last = k + 1 == len(section.stretches)
            end_event = section.end_event if is_last else next(later, section.end_event)
            line = section.line if k == 0 else int(run.line[rows[0]])
            part = replace(section, line=line, first_event=first_event, end_event=end_event, part=k + 1)
            part.stretches, part.values = [rows], dict(section.values)
            divided.append(part)
            sides = [event for event in events[section.first_event : end_event] if event.kind == "comp"]
            if not is_last and sides and not _is_off(sides[-1]):
                warn.refuse(sides[-1].line, Wording("CNV172", "radius_compensation_stays"), sides[-1].file)
            first_event = end_event
    return divided


def _comes_after(event: ProgramEvent, row: int, run: Run) -> bool:
    """Whether an event comes when the tool has left the workpiece after a row: not before the block that leaves."""
    if event.row != row + 1 or event.row >= len(run) or event.file != run.file[event.row]:
        return event.row > row
    return event.line >= int(run.line[event.row])


def _is_off(event: ProgramEvent) -> bool:
    return isinstance(event.value, tuple) and event.value[0] == "OFF"


def assign_events(
    events: Sequence[ProgramEvent],
    sections: Sequence[ProgramSection],
    coolants: Mapping[int, str],
    template_lines: Collection[int],
    smoothing: Collection[str],
) -> list[list[ProgramEvent]]:
    """Return the events of each section.

    An event outside of all sections belongs to the next one, or to the last if none follows. Every operation of a
    toolpath switches its coolant on itself, so a section in which coolant keeps running gets the event that did it; as
    does a part of a divided section in which blocks are skipped.

    coolants         M number -> CL word
    template_lines   lines of the program that were written from templates
    smoothing        kinds of events that set the control's smoothing
    """
    assigned: list[list[ProgramEvent]] = []
    begin = 0
    for k, section in enumerate(sections):
        end = section.end_event if k + 1 < len(sections) else len(events)
        inside = range(section.first_event, section.end_event)
        others = (n for n in range(begin, end) if n not in inside)
        after = {n for n in others if _concerns_others(events[n], template_lines, smoothing)}
        own = _with_own_skips(events, range(begin, end), inside, after)
        row = int(section.rows[0])
        running = _coolant_running(events[: section.first_event], coolants)
        if running and not any(event.row <= row and _is_coolant(event, coolants) for event in own):
            own.insert(0, running._replace(row=row))
        skipped = next((event for event in reversed(events[: section.first_event]) if event.kind == "skip"), None)
        begun = bool(own) and own[0].kind == "skip" and bool(own[0].value)
        if section.part > 1 and skipped is not None and skipped.value and not begun:
            own.insert(0, skipped._replace(row=row))
        assigned.append(own)
        begin = end
    return assigned


def _with_own_skips(
    events: Sequence[ProgramEvent], all_of_them: range, inside: range, after: Collection[int]
) -> list[ProgramEvent]:
    """Return the events of a section: those ``inside``, and those ``after`` another section that belong to it.

    Of the skip signs between two sections those count that stand right before such an event, or lead into the section:
    each sign that begins has the one that ends it.
    """
    own, said, latest = list[ProgramEvent](), False, None
    for n in all_of_them:
        event = events[n]
        if event.kind == "skip" and n not in inside:
            latest = event
            continue
        if latest is not None and latest.value != said and (n in inside or n in after):
            own.append(latest)
            said, latest = bool(latest.value), None
        if n in inside or n in after:
            own.append(event)
            said = bool(event.value) if event.kind == "skip" else said
    if latest is not None and said and not latest.value:
        own.append(latest)
    return own


def _coolant_running(events: Sequence[ProgramEvent], coolants: Mapping[int, str]) -> ProgramEvent | None:
    """Return the event that switched on the coolant still running after ``events``."""
    last = next((event for event in reversed(events) if _is_coolant(event, coolants)), None)
    return None if last is None or last.value == "off" else last


def _is_coolant(event: ProgramEvent, coolants: Mapping[int, str]) -> bool:
    return event.kind == "coolant" or (event.kind == "m" and event.value in coolants)


def _concerns_others(event: ProgramEvent, template_lines: Collection[int], smoothing: Collection[str]) -> bool:
    """Whether an event after the path of one operation has a meaning for the next one."""
    if event.file == 0 and event.line in template_lines:
        return False
    switches_off = event.value == "off" if event.kind == "coolant" else event.kind in smoothing and not event.value
    return not switches_off and event.kind != "end"
