"""From what a control did with a program back to the ``Toolpath`` that asks for it.

In:     a ``Run`` (what the reader found out), the program's text, and the definition of the control that it was written
        for: its templates say what the lines of a head mean, its ``phases`` what the comments between motions mean.
Out:    operations in the workpiece frame, mm, and the settings that a toolpath has no place for.

What belongs to the machine and not to the part is left out: moves to machine positions, and the placing of the rotary
axes before an operation's first position.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.controls.definition import Control
from trunnion.controls.template import Template
from trunnion.conversion.event_builder import EventBuilder
from trunnion.conversion.moves import build_arcs, build_moves
from trunnion.conversion.program_events import ProgramEvent, collect_events
from trunnion.conversion.program_text import ProgramText
from trunnion.conversion.settings import parse_number, settings_from_headers
from trunnion.conversion.template_matching import family_value_expressions, line_patterns, match_lines
from trunnion.conversion.unsupported import (
    Warnings,
    warn_of_interpolation,
    warn_of_machine_words,
    warn_of_normals,
    warn_of_park_positions,
    warn_of_poses,
    warn_of_register_changes,
)
from trunnion.errors import Problem
from trunnion.model.run import ProgrammedWord, Run, offset_name
from trunnion.model.toolpath import Frame, Kind, LoadTool, Operation, Phase, Tool, Toolpath
from trunnion.readers import reader_of
from trunnion.verification import restore_rapids

_PHASE_BY_NAME = {
    "rapid": Phase.RAPID,
    "approach": Phase.APPROACH,
    "engage": Phase.ENGAGE,
    "cut": Phase.CUT,
    "stepover": Phase.STEPOVER,
    "retract": Phase.RETRACT,
    "departure": Phase.DEPARTURE,
    "traverse": Phase.TRAVERSE,
}
#: How the templates of an operation's head and of its end are called; those of kinds of operations by what follows.
_START_TEMPLATES = ("operation_start", "first_tool", "tool_change", "approach_", "plane_on_")
_END_TEMPLATES = ("operation_end_",)


@dataclass(frozen=True, slots=True, eq=False)
class Conversion:
    """A program as a toolpath.

    settings  what the program says and a toolpath has no place for, as ``--set`` takes it; only what is not the default
    warnings  what could not be converted
    """

    toolpath: Toolpath
    settings: dict[str, str]
    warnings: tuple[Problem, ...]


def convert(run: Run, control: Control) -> Conversion:
    """Turn a program that was read without errors into a toolpath.

    Parameters
    ----------
    run
        Of the reader. Its files are looked into once more for what the columns do not hold.
    control
        Of the machine that the program was written for. Where its rapids are lines at a feed (``rapid_feed``), lines at
        that feed are rapids.
    """
    usual = control.settings.get("rapid_feed", "")
    converted = _ToolpathBuilder(restore_rapids(run, parse_number(usual)), control).convert()
    rapid_feed = converted.settings.get("rapid_feed", usual)
    if rapid_feed == usual:
        return converted
    return _ToolpathBuilder(restore_rapids(run, parse_number(rapid_feed)), control).convert()


@dataclass(slots=True)
class _ProgramSection:
    """The part of a program that becomes an operation.

    line         where it begins
    first_event  index of the first program event in it
    first_row    row of the run where it begins
    end_event    index behind its last program event; there the path has ended
    end_row      row behind it
    rows         (n,) rows that move the tool at the workpiece
    values       values of its header
    """

    line: int
    first_event: int
    first_row: int
    end_event: int = -1
    end_row: int = 0
    rows: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    values: dict[str, str] = field(default_factory=dict)


class _ToolpathBuilder:
    """Converts one program."""

    def __init__(self, run: Run, control: Control) -> None:
        self._run = run
        self._control = control
        self._reader = reader_of(run.machine)
        letter, comments = control.block_numbers.letter, self._reader.comments
        self._sources = [ProgramText(file, letter, comments) for file in run.files]
        self._source = self._sources[0]
        self._warn = Warnings(run.files)
        axes = run.machine.axes
        primary, secondary = axes[run.machine.primary].name, axes[run.machine.secondary].name
        self._values = {"primary": primary, "secondary": secondary, "machine": run.machine.name}
        self._family_values = family_value_expressions(control)
        self._template_lines: set[int] = set()
        # M number -> CL word; of words with one number OFF, ON and then the first
        self._coolants: dict[int, str] = {}
        for word in ("OFF", "ON", *control.coolant):
            if word in control.coolant:
                self._coolants.setdefault(control.coolant[word], word)

    def convert(self) -> Conversion:
        """The whole program."""
        run, control = self._run, self._control
        events = collect_events(run, self._source, self._warn)
        starts = self._opening_lines(events, [control.templates["operation_start"]])
        sections = self._split(events, starts)
        self._match_templates(sections, events)
        phases = self._phases()
        phases_marked = bool(starts) and bool(phases)
        rapids_unmarked = phases_marked and not control.phases.get("rapid")
        event_builder = EventBuilder(
            phases, self._coolants, self._template_lines, phases_marked, rapids_unmarked, self._warn
        )
        owned = self._assign_events(events, sections)
        operations = tuple(
            self._operation(section, own, event_builder) for section, own in zip(sections, owned, strict=True)
        )
        settings = settings_from_headers(control, [(section.line, section.values) for section in sections], self._warn)
        rows = [section.rows for section in sections]
        warn_of_park_positions(run, self._warn)
        warn_of_normals(run, self._warn)
        offset = "G" if self._offset_is_word else "work offset "
        warn_of_register_changes(run, rows, offset, self._warn)
        warn_of_interpolation(run, rows, settings.get("orientation") == "vector", self._warn)
        warn_of_poses(run, zip(rows, (operation.moves for operation in operations), strict=True), self._warn)
        warn_of_machine_words(self._sources, self._reader.words_without_path, self._template_lines, self._warn)
        return Conversion(Toolpath(run.files[0], operations, settings.get("part", "")), settings, self._warn.problems)

    def _phases(self) -> dict[str, Phase]:
        """Comment -> phase; of phases with one comment the first."""
        found: dict[str, Phase] = {}
        for name, phase in _PHASE_BY_NAME.items():
            if spoken := self._control.phases.get(name, "").strip("; *()"):
                found.setdefault(spoken, phase)
        return found

    # Parts

    def _templates_named(self, names: tuple[str, ...]) -> list[Template]:
        """The templates whose names begin so, in the order of ``names``."""
        templates = self._control.templates
        return [templates[key] for name in names for key in templates if key.startswith(name)]

    def _opening_lines(self, events: Iterable[ProgramEvent], templates: Iterable[Template]) -> set[int]:
        """The lines of ``events`` that are the first line of one of the templates, if that is more than a value."""
        settings = self._control.settings
        firsts = [line_patterns([template], self._values, settings, self._family_values)[:1] for template in templates]
        first = [line.expression for lines in firsts for line in lines if not line.value_only]
        lines = sorted({event.line for event in events if event.file == 0})
        return {line for line in lines if any(each.fullmatch(self._source.line_text(line)) for each in first)}

    def _split(self, events: Sequence[ProgramEvent], starts: set[int]) -> list[_ProgramSection]:
        """Cut the program where operations begin: at the lines ``starts``, or without any at tool changes."""
        spoken = [event for event in events if event.kind == "comment"]
        ends = self._opening_lines(spoken, self._templates_named(_END_TEMPLATES)) if starts else set[int]()
        sections = [_ProgramSection(1, 0, 0)]
        begun = 0
        for k, event in enumerate(events):
            last = sections[-1]
            here = event.line if event.file == 0 else 0
            begun = begun if here == begun else 0
            if (here in starts and here != begun and event.kind != "skip") if starts else (event.kind == "tool_change"):
                last.end_row, begun = event.row, here
                last.end_event = k if last.end_event < 0 else last.end_event
                sections.append(_ProgramSection(event.line, k, event.row))
            elif event.kind == "comment" and here in ends and last.end_event < 0:
                last.end_event = k
        sections[-1].end_row = len(self._run)
        sections[-1].end_event = len(events) if sections[-1].end_event < 0 else sections[-1].end_event
        for section in sections:
            section.rows = self._rows(section)
        return [section for section in sections if len(section.rows)]

    def _rows(self, section: _ProgramSection) -> Ints:
        """The rows that move the tool at the workpiece."""
        run = self._run
        rows = np.arange(section.first_row, section.end_row)
        moved = ~run.machine_frame[rows]
        level_approach = self._level_approaches(rows)
        placed = (
            moved
            & ~level_approach
            & ((run.programmed[rows] & (ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)) != 0)
        )
        if not placed.any():
            return rows[:0]
        begin = int(np.argmax(placed))
        moved &= ~self._rotary_positioning(rows) & ~level_approach
        last = int(np.flatnonzero(moved)[-1])
        gone = begin + np.flatnonzero(~(moved | level_approach)[begin:last])
        if len(gone):
            row = int(rows[gone[0]])
            what = "moves to machine positions within an operation are left out"
            self._warn(int(run.line[row]), what, file=int(run.file[row]))
        kept = begin + np.flatnonzero(moved[begin:])
        if run.kind[rows[begin]] == Kind.ARC and rows[begin] > 0:
            return np.concatenate(([rows[begin] - 1], rows[kept]))  # an arc needs the place where it begins
        return rows[kept]

    def _rotary_positioning(self, rows: Ints) -> Flags:
        """(n,) bool: the rotary axes alone are placed, without TCP: away from the part, or after its last position."""
        run = self._run
        programmed = run.programmed[rows]
        places = (programmed & (ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z | ProgrammedWord.VECTOR)) != 0
        alone = ~places & (programmed != 0) & ~run.tcp[rows] & (run.kind[rows] == Kind.RAPID)
        order = np.arange(len(rows))
        machine = np.maximum.accumulate(np.where(run.machine_frame[rows], order, -1))
        works = ~alone & ~run.machine_frame[rows]
        worked = np.maximum.accumulate(np.where(works, order, -1))
        after = order > (int(np.flatnonzero(works)[-1]) if works.any() else -1)
        return np.asarray(alone & ((machine > worked) | after))

    def _level_approaches(self, rows: Ints) -> Flags:
        """(n,) bool: the first leg of an approach, on controls that go from home to X and Y first, then down in Z."""
        found = np.zeros(len(rows), np.bool_)
        if not self._control.level_approach:
            return found
        run = self._run
        words = run.programmed[rows] & (ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z | ProgrammedWord.VECTOR)
        works = ~run.machine_frame[rows] & (words != 0)
        order = np.arange(len(rows))
        home = np.maximum.accumulate(np.where(run.machine_frame[rows], order, -1))
        worked = np.maximum.accumulate(np.where(works, order, -1))
        before = np.concatenate(([-1], worked[:-1]))
        rapid = (run.kind[rows] == Kind.RAPID) & ~run.tcp[rows]
        first = (
            works
            & rapid
            & ((words & ~np.uint8(ProgrammedWord.X | ProgrammedWord.Y)) == 0)
            & (home >= before)
            & (before < order)
        )
        found[:-1] = first[:-1] & rapid[1:] & (words[1:] == ProgrammedWord.Z)
        return found

    def _match_templates(self, sections: Sequence[_ProgramSection], events: Sequence[ProgramEvent]) -> None:
        """Find the lines of templates, and what they say. Where an operation's end begins, its path has ended."""
        templates, run, settings = self._control.templates, self._run, self._control.settings
        start = line_patterns([templates["program_start"]], self._values, settings, self._family_values)
        head = line_patterns(self._templates_named(_START_TEMPLATES), self._values, settings, self._family_values)
        tail = line_patterns(
            [*self._templates_named(_END_TEMPLATES), templates["program_end"]],
            self._values,
            settings,
            self._family_values,
        )
        common: dict[str, str] = {}
        for k, section in enumerate(sections):
            after = sections[k + 1].line if k + 1 < len(sections) else self._source.line_count + 1
            first, last = (
                int(run.line[section.rows[end]]) if run.file[section.rows[end]] == 0 else after for end in (0, -1)
            )
            if k == 0:
                self._template_lines |= match_lines(
                    self._source.line_texts(1, section.line if section.line > 1 else first), start, common
                )
            self._template_lines |= match_lines(self._source.line_texts(section.line, first), head, section.values)
            ended = match_lines(self._source.line_texts(last + 1, after), tail, section.values)
            self._template_lines |= ended
            there = (
                n
                for n in range(section.first_event, section.end_event)
                if events[n].file == 0 and events[n].line in ended
            )
            section.end_event = next((n for n in there if events[n].kind != "skip"), section.end_event)
            section.values = {
                **common,
                **section.values,
                **self._plane_setting(section.line, first),
                **self._register_settings(section),
            }

    def _plane_setting(self, first: int, last: int) -> dict[str, str]:
        """The way in which a head from line to line says its tilted plane, where the control has several."""
        lines, control = self._source.line_texts(first, last), self._control
        for way in control.family.PLANE_COMMANDS if "plane" in control.settings else ():
            wanted = line_patterns(
                self._templates_named((f"plane_on_{way}",)), self._values, control.settings, self._family_values
            )
            if any(not each.value_only and each.expression.fullmatch(text) for _, text in lines for each in wanted):
                return {"plane": way}
        return {}

    def _register_settings(self, section: _ProgramSection) -> dict[str, str]:
        """Work offset and edge in force at the first row; an offset that is no G word was found in the head.

        Where the source calls no edges, the number is that of a length (H), which goes with the tool.
        """
        offset, edge = int(self._run.work_offset[section.rows[0]]), int(self._run.edge[section.rows[0]])
        named = {"work_offset": offset_name(offset)} if offset and self._offset_is_word else {}
        named |= {"edge": str(edge)} if edge >= 0 and "edge" in self._control.settings else {}
        return named | ({"orientation": how} if (how := self._orientation_setting(section.rows)) else {})

    def _orientation_setting(self, rows: Ints) -> str:
        """How a program says orientations under TCP; empty where it says none, or the control has but one way."""
        if "orientation" not in self._control.settings:
            return ""
        words = int(np.bitwise_or.reduce(self._run.programmed[rows[self._run.tcp[rows]]], initial=0))
        return (
            "vector"
            if words & ProgrammedWord.VECTOR
            else "angles"
            if words & (ProgrammedWord.FIRST | ProgrammedWord.SECOND)
            else ""
        )

    @property
    def _offset_is_word(self) -> bool:
        """Whether a work offset is called by its G word alone."""
        return bool(re.fullmatch(r"G\d+", self._control.settings.get("work_offset", "")))

    def _assign_events(
        self, events: Sequence[ProgramEvent], sections: Sequence[_ProgramSection]
    ) -> list[list[ProgramEvent]]:
        """What is said in each operation; what stands outside of all belongs to the next, or else to the last."""
        owned: list[list[ProgramEvent]] = []
        at = 0
        for k, section in enumerate(sections):
            stop = section.end_event if k + 1 < len(sections) else len(events)
            inside = range(section.first_event, section.end_event)
            own = [events[n] for n in range(at, stop) if n in inside or self._is_relevant(events[n])]
            row = int(section.rows[0])
            running = self._coolant_before(events[: section.first_event])
            if running and not any(event.row <= row and self._is_coolant(event) for event in own):
                own.insert(0, running._replace(row=row))
            owned.append(own)
            at = stop
        return owned

    def _coolant_before(self, events: Sequence[ProgramEvent]) -> ProgramEvent | None:
        """What turned the coolant on that runs after all this; every operation of a toolpath asks for its own."""
        last = next((event for event in reversed(events) if self._is_coolant(event)), None)
        return None if last is None or last.value == "off" else last

    def _is_coolant(self, event: ProgramEvent) -> bool:
        return event.kind == "coolant" or (event.kind == "m" and event.value in self._coolants)

    def _is_relevant(self, event: ProgramEvent) -> bool:
        """Whether an item outside an operation's path has anything to say to another operation."""
        if event.file == 0 and event.line in self._template_lines:
            return False
        return not (event.kind == "coolant" and event.value == "off") and event.kind not in ("end", "cycle832")

    # Operations

    def _operation(
        self, section: _ProgramSection, events: Sequence[ProgramEvent], event_builder: EventBuilder
    ) -> Operation:
        run, values = self._run, section.values
        phase, happened = event_builder.build(events, run, section.rows, section.line)
        lengths = run.edge[section.rows][run.edge[section.rows] > 0]
        if len(lengths) and self._reader.uses_length_numbers:
            register = int(lengths[0])
            happened = tuple(
                replace(one, adjust=register) if isinstance(one, LoadTool) and one.number != register else one
                for one in happened
            )
        named = f"TOOL_{event_builder.tool}" if event_builder.tool else Path(run.files[0]).stem
        return Operation(
            name=values.get("operation", "") or named,
            tool=self._tool(values, event_builder.tool),
            frame=Frame(),
            moves=build_moves(run, section.rows, phase, self._warn),
            arcs=build_arcs(run, section.rows),
            events=happened,
            line=section.line,
            intol=parse_number(values.get("intol")),
            outtol=parse_number(values.get("outtol")),
        )

    def _tool(self, values: dict[str, str], called: str) -> Tool:
        """The cutter; ``values`` gets the settings that call it as the program does, by ``called``."""
        kinds = {text: kind for kind, text in self._control.tool_types.items()}
        kind = kinds.get(values.get("tool_type", ""), "UNKNOWN")
        diameter = parse_number(values.get("tool_diameter"))
        if kind == "BALL" or (kind == "UNKNOWN" and diameter):
            kind = "MILL"
        by_name = bool(called) and (not called.isdigit() or values.get("tool", "").startswith('"'))
        values.pop("tool", None)
        name = values.get("tool_name", "") or (called if by_name else "")
        if called:
            values["tool_call"] = "name" if by_name and name == called else "number"
        if by_name and name != called:
            values["tool"] = f'"{called}"'
        return Tool(
            kind=kind,
            name=name,
            diameter=diameter or 0.0,
            corner_radius=parse_number(values.get("tool_corner_radius")) or 0.0,
            length=parse_number(values.get("tool_length")) or 0.0,
        )
