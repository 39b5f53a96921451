"""The headers and ends of a program's operations, read backwards by the control's templates.

In:     the program's text, its sections, and the definition of the control that it was written for.
Out:    the lines that were written from templates, and the values in them.
"""

import re
from collections.abc import Iterable, Sequence

import numpy as np

from trunnion.arrays import Ints
from trunnion.controls.definition import Control
from trunnion.controls.vocabulary import FORCED_NOTICE
from trunnion.conversion.notices import entry_lines, without_notices
from trunnion.conversion.program_events import ProgramEvent
from trunnion.conversion.program_text import ProgramText
from trunnion.conversion.sections import ProgramSection
from trunnion.conversion.settings import parse_number
from trunnion.conversion.template_matching import LinePattern, TemplatePatterns, match_lines
from trunnion.model.clamping_notices import head_comments, may_be_notice
from trunnion.model.run import NO_OFFSET, ProgrammedWord, Run
from trunnion.readers import reader_of

_MM_PER_INCH = 25.4

#: The beginnings of the names of the templates that make the header and the end of an operation.
_HEADER_TEMPLATES = ("operation_start", "first_tool", "tool_change", "approach_", "plane_on_")
_END_TEMPLATES = ("operation_end_",)


class HeaderReader:
    """Reads the headers and ends of one program's operations.

    template_lines   lines of the main file that were written from templates, as far as they have been read
    forced_line      line in which the head says that the program must not run as it is; 0 if it says nothing of it
    """

    def __init__(self, run: Run, control: Control, text: ProgramText) -> None:
        self.template_lines: set[int] = set()
        self.forced_line = 0
        self._run = run
        self._control = control
        self._text = text
        self._patterns = TemplatePatterns(control, run.machine)

    @property
    def offset_is_word(self) -> bool:
        """Whether a work offset is called by its G word alone."""
        return bool(re.fullmatch(r"G\d+", self._control.settings.get("work_offset", "")))

    def start_lines(self, events: Iterable[ProgramEvent]) -> set[int]:
        """Return the lines of events where an operation begins."""
        return self._matching_lines(events, self._patterns.first_lines("operation_start"))

    def end_lines(self, events: Iterable[ProgramEvent]) -> set[int]:
        """Return the lines of comments where the end of an operation begins."""
        comments = [event for event in events if event.kind == "comment"]
        return self._matching_lines(comments, self._patterns.first_lines(*_END_TEMPLATES))

    def read(self, sections: Sequence[ProgramSection], events: Sequence[ProgramEvent]) -> None:
        """Fill in the values of all sections; their events end where the templates of their end begin."""
        header = self._patterns.of(*_HEADER_TEMPLATES)
        end = self._patterns.of(*_END_TEMPLATES, "program_end")
        program_values: dict[str, str] = {}
        lines = [*(section.line for section in sections), self._text.line_count + 1]
        for section, next_line in zip(sections, lines[1:], strict=True):
            first, last = self._path_lines(section, next_line)
            if section is sections[0]:
                head = self._text.line_texts(1, section.line if section.line > 1 else first)
                # How the part is clamped goes into the head of what is made of it; its zero is that of this machine.
                of_part = {number for number, text in head_comments(head) if may_be_notice(text)}
                self.template_lines |= of_part | entry_lines(head, self._control.family)
                program_start = without_notices(head, self._control.family)
                self.forced_line = next((number for number, text in head if FORCED_NOTICE in text), 0)
                self.template_lines |= match_lines(program_start, self._patterns.of("program_start"), program_values)
            self.template_lines |= match_lines(self._text.line_texts(section.line, first), header, section.values)
            lines_behind = self._text.line_texts(last + 1, next_line)
            # From the back: an M5 of the operation is not the one with which its end closes.
            ended = match_lines(lines_behind[::-1], end[::-1], section.values)
            self.template_lines |= ended
            section.end_event = _first_event_at(_last_block(lines_behind, ended), section, events)
            section.values = {
                **program_values,
                **self._in_millimetres(section),
                **self._plane_setting(section.line, first),
                **self.offset_settings(section),
                **self._orientation_setting(section.rows),
            }

    def _in_millimetres(self, section: ProgramSection) -> dict[str, str]:
        """Return the values in a header, with those that are lengths in mm whatever the program counts in there."""
        row = section.first_row
        if not (row < len(self._run) and self._run.state.inches[row]):
            return section.values
        lengths = {*self._control.length_fields, *self._control.length_settings}
        return {name: _in_mm(text) if name in lengths else text for name, text in section.values.items()}

    def _matching_lines(self, events: Iterable[ProgramEvent], patterns: Sequence[LinePattern]) -> set[int]:
        """Return the lines of events in the main file that match one of the patterns."""
        lines = {event.line for event in events if event.file == 0}
        return {line for line in lines if _matches_any(self._text.line_text(line), patterns)}

    def _path_lines(self, section: ProgramSection, next_line: int) -> tuple[int, int]:
        """Return the lines of the first and the last row of a section; ``next_line`` for rows in a subprogram."""
        run = self._run
        first, last = (int(run.line[row]) if run.file[row] == 0 else next_line for row in section.rows[[0, -1]])
        return first, last

    def _plane_setting(self, first: int, end: int) -> dict[str, str]:
        """Return the command for tilted planes that the lines of a header use, on controls with several."""
        texts = [text for _, text in self._text.line_texts(first, end)]
        for command in self._control.family.PLANE_COMMANDS if "plane" in self._control.settings else ():
            patterns = [pattern for pattern in self._patterns.of(f"plane_on_{command}") if not pattern.value_only]
            if any(_matches_any(text, patterns) for text in texts):
                return {"plane": command}
        return {}

    def offset_settings(self, section: ProgramSection) -> dict[str, str]:
        """Return the work offset and the edge in force at the first row.

        On controls without edges the number is that of a tool length (H), which belongs to the tool.
        """
        row = section.rows[0]
        offset, edge = int(self._run.work_offset[row]), int(self._run.edge[row])
        has_offset = offset not in (0, NO_OFFSET) and "work_offset" in self._control.settings
        found = {"work_offset": reader_of(self._run.machine).work_offsets.setting(offset)} if has_offset else {}
        return found | ({"edge": str(edge)} if edge >= 0 and "edge" in self._control.settings else {})

    def _orientation_setting(self, rows: Ints) -> dict[str, str]:
        """How the program gives orientations under TCP, on controls with several ways, if it gives any."""
        if "orientation" not in self._control.settings:
            return {}
        words = int(np.bitwise_or.reduce(self._run.programmed[rows[self._run.tcp[rows]]], initial=0))
        if words & ProgrammedWord.VECTOR:
            return {"orientation": "vector"}
        return {"orientation": "angles"} if words & (ProgrammedWord.FIRST | ProgrammedWord.SECOND) else {}


def _matches_any(text: str, patterns: Iterable[LinePattern]) -> bool:
    return any(pattern.expression.fullmatch(text) for pattern in patterns)


def _last_block(lines: Sequence[tuple[int, str]], ended: set[int]) -> set[int]:
    """Return the last of the lines that ``ended`` without another between them: an M5 before a STOP does not end the
    path.
    """
    block: set[int] = set()
    for number, text in reversed(lines):
        if number in ended:
            block.add(number)
        elif block and text:
            break
    return block


def _first_event_at(lines: set[int], section: ProgramSection, events: Sequence[ProgramEvent]) -> int:
    """Index of the first event of a section on one of the lines, block skip apart; else the end of its events."""
    inside = range(section.first_event, section.end_event)
    found = (n for n in inside if events[n].file == 0 and events[n].line in lines and events[n].kind != "skip")
    return next(found, section.end_event)


def _in_mm(text: str) -> str:
    """Return a number in inches as one in mm, with as many digits as inches of seven decimals have; another text as it
    is.
    """
    value = parse_number(text)
    return text if value is None else f"{_MM_PER_INCH * value:.5f}".rstrip("0").rstrip(".")
