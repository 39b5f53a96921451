"""An NC program as a toolpath: the operations that would make its tool do the same.

In:     a ``Run`` (what the reader found), the program's text, and the definition of its control. The templates tell
        what the lines of a header mean, ``phases`` what the comments between motions mean.
Out:    operations in the workpiece frame, mm, and the settings that do not fit into a toolpath.

What belongs to the machine and not to the part is left out: moves to machine positions, and positioning of the rotary
axes before an operation's first position. Where they stand between two cuts, the operation is divided there.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from trunnion.controls.definition import Control
from trunnion.conversion.event_builder import EventBuilder
from trunnion.conversion.headers import HeaderReader
from trunnion.conversion.known_positions import known_positions
from trunnion.conversion.moves import build_arcs, build_moves, without_pieces_of_arcs
from trunnion.conversion.phases import PhaseComments
from trunnion.conversion.program_events import ProgramEvent, collect_events
from trunnion.conversion.program_text import ProgramText
from trunnion.conversion.sections import ProgramSection, assign_events, divide_sections, split_program
from trunnion.conversion.settings import parse_number, settings_from_headers
from trunnion.conversion.spindle_holes import read_spindle_holes
from trunnion.conversion.unsaid import (
    cut_without_offset,
    warn_of_missing_words,
    warn_of_other_meanings,
    warn_of_skipped_words,
)
from trunnion.conversion.unsupported import (
    Warnings,
    refuse_unsimulated_motions,
    warn_of_acting_words,
    warn_of_cycles,
    warn_of_interpolation,
    warn_of_machine_words,
    warn_of_normals,
    warn_of_park_angles,
    warn_of_park_positions,
    warn_of_poses,
    warn_of_register_changes,
    warn_of_splines,
)
from trunnion.conversion.workpiece_rows import without_turns_in_place, workpiece_stretches
from trunnion.errors import Problem, Severity
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import Event, Frame, LoadTool, Operation, Tool, Toolpath
from trunnion.readers import reader_of
from trunnion.records import dataclass
from trunnion.verification import restore_rapids


@dataclass(frozen=True, slots=True, eq=False)
class Conversion:
    """A program as a toolpath.

    settings        what does not fit into a toolpath, as ``--set`` takes it; without defaults
    warnings        what could not be converted
    errors          what must not be left out: such a program is refused unless it is forced
    without_offset  file and line of the first cut while no work offset is selected; None: there is none
    """

    toolpath: Toolpath
    settings: dict[str, str]
    warnings: tuple[Problem, ...]
    errors: tuple[Problem, ...] = ()
    without_offset: tuple[str, int] | None = None


def convert(run: Run, control: Control, target: Control | None = None) -> Conversion:
    """Convert a program that was read without errors into a toolpath.

    run      the result of ``trunnion.readers.run_program``. Its files are read once more for what the columns do not
             hold
    control  the control of the machine that the program was written for. If it makes rapids lines at a feed
             (``rapid_feed``), lines at that feed are rapids
    target   the control that the settings are for; None: the same
    """
    default = control.settings.get("rapid_feed", "")
    conversion = _ToolpathBuilder(_with_rapids(run, parse_number(default)), control, target or control).build()
    rapid_feed = conversion.settings.get("rapid_feed", default)
    if rapid_feed == default:
        return conversion
    return _ToolpathBuilder(_with_rapids(run, parse_number(rapid_feed)), control, target or control).build()


def _with_rapids(run: Run, feed: float | None) -> Run:
    """Return a run, in each of its meanings, with lines at the feed of rapids as rapids."""
    skipped = tuple(replace(each, run=restore_rapids(each.run, feed)) for each in run.skipped)
    return replace(restore_rapids(run, feed), skipped=skipped)


class _ToolpathBuilder:
    """Converts one program."""

    def __init__(self, run: Run, control: Control, target: Control) -> None:
        self._run = run
        self._control, self._target = control, target
        self._reader = reader_of(run.machine)
        letter, comments = control.block_numbers.letter, self._reader.comments
        self._texts = [ProgramText(file, letter, comments, run.encoding) for file in run.files]
        self._headers = HeaderReader(run, control, self._texts[0])
        self._coolants = _coolant_words(control)
        self._warn = Warnings(run.files)
        self._rigid_tap = control.settings.get("rigid_tap", "")
        self._called_as: dict[str, str] = {}  # tool -> number or quoted name, as its call has it

    def build(self) -> Conversion:
        """Convert the whole program."""
        events = collect_events(self._run, self._texts[0], self._warn)
        starts = self._headers.start_lines(events)
        sections = self._sections(events, starts)
        self._headers.read(sections, events)
        sections = self._divided(sections, events)
        operations = self._operations(sections, events, PhaseComments(self._control, has_headers=bool(starts)))
        headers = [
            (section.line, operation.name, section.values)
            for section, operation in zip(sections, operations, strict=True)
        ]
        settings = settings_from_headers(self._control, headers, self._warn, self._target)
        self._warn_of_losses(sections, operations, settings.get("orientation") == "vector")
        toolpath = Toolpath(self._run.files[0], operations, settings.get("part", ""))
        problems = self._warn.problems
        warnings = tuple(problem for problem in problems if problem.severity is Severity.WARNING)
        errors = tuple(problem for problem in problems if problem.severity is Severity.ERROR)
        without_offset = cut_without_offset(self._run, [section.rows for section in sections])
        return Conversion(toolpath, settings, warnings, errors, without_offset)

    def _sections(self, events: Sequence[ProgramEvent], starts: set[int]) -> list[ProgramSection]:
        """Return the sections that move the tool at the workpiece; ``starts`` are the lines where operations begin."""
        ends = self._headers.end_lines(events) if starts else set[int]()
        sections = split_program(events, len(self._run), starts, ends)
        known = known_positions(self._run)
        for section in sections:
            section.stretches = workpiece_stretches(
                self._run, known, section.first_row, section.end_row, self._control.level_approach, self._warn
            )
        return [section for section in sections if section.stretches]

    def _divided(self, sections: Sequence[ProgramSection], events: Sequence[ProgramEvent]) -> list[ProgramSection]:
        """Return the sections with one stretch each, with the work offset and edge of each."""
        divided = divide_sections(events, sections, self._run, self._warn)
        for section in divided:
            section.values |= self._headers.offset_settings(section) if section.part > 1 else {}
        return divided

    def _operations(
        self, sections: Sequence[ProgramSection], events: Sequence[ProgramEvent], phases: PhaseComments
    ) -> tuple[Operation, ...]:
        template_lines = self._headers.template_lines
        assigned = assign_events(events, sections, self._coolants, template_lines, self._reader.lost_smoothing)
        builder = EventBuilder(
            self._run, phases.phase_of, self._coolants, template_lines, self._reader.lost_smoothing, self._warn
        )
        return tuple(
            self._operation(section, own, phases, builder) for section, own in zip(sections, assigned, strict=True)
        )

    def _operation(
        self, section: ProgramSection, events: Sequence[ProgramEvent], phases: PhaseComments, builder: EventBuilder
    ) -> Operation:
        run, values = self._run, section.values
        off_blocks = {(event.line, event.file) for event in events if event.value == "off"}
        holes = read_spindle_holes(run, without_turns_in_place(run, section.rows, off_blocks), events, self._warn)
        rows, events = holes.rows, holes.without_own_events(events, self._rigid_tap)
        rows = without_pieces_of_arcs(run, rows, [event.row for event in events])
        section.stretches = [rows]
        found = holes.with_cycles(builder.build(events, rows, section.line))
        phase = phases.column(events, run, rows, self._headers.template_lines, self._warn)
        moves = build_moves(run, rows, phase, self._warn)
        default_name = f"TOOL_{builder.tool}" if builder.tool else Path(run.files[0]).stem
        name = values.get("operation", "") or default_name
        # An operation with the tool of the one before does not call it.
        values["tool"] = self._called_as[builder.tool] = values.get("tool") or self._called_as.get(builder.tool, "")
        return Operation(
            name=name if section.part == 1 else f"{name}_{section.part}",
            tool=_build_tool(values, builder.tool, self._control),
            frame=Frame(),
            moves=replace(moves, tip=holes.tips(moves.tip)),
            arcs=build_arcs(run, rows),
            events=self._with_length_number(found, section),
            line=section.line,
            intol=parse_number(values.get("intol")),
            outtol=parse_number(values.get("outtol")),
        )

    def _with_length_number(self, events: tuple[Event, ...], section: ProgramSection) -> tuple[Event, ...]:
        """Return the events with the number of the tool length (H) at each tool change that has another tool number."""
        numbers = self._run.edge[section.rows]
        numbers = numbers[numbers > 0]
        if not len(numbers) or not self._reader.uses_length_numbers:
            return events
        number = int(numbers[0])
        return tuple(
            replace(event, adjust=number) if isinstance(event, LoadTool) and event.number != number else event
            for event in events
        )

    def _warn_of_losses(
        self, sections: Sequence[ProgramSection], operations: Sequence[Operation], by_vectors: bool
    ) -> None:
        run, rows = self._run, [section.rows for section in sections]
        if self._headers.forced_line:
            self._warn.refuse(self._headers.forced_line, Wording("CNV178", "program_says_must"))
        refuse_unsimulated_motions(run, self._warn)
        warn_of_missing_words(run, rows, self._warn)
        warn_of_other_meanings(run, self._warn)
        warn_of_skipped_words(run, rows, self._texts[0], self._headers.template_lines, self._warn)
        warn_of_park_positions(run, self._warn)
        warn_of_park_angles(run, rows, self._warn)
        warn_of_normals(run, self._warn)
        warn_of_splines(run, self._warn)
        warn_of_cycles(run, self._warn)
        warn_of_register_changes(run, rows, "G" if self._headers.offset_is_word else "work offset ", self._warn)
        warn_of_interpolation(run, rows, by_vectors, self._warn)
        warn_of_poses(run, zip(rows, (operation.moves for operation in operations), strict=True), self._warn)
        machine_words, template_lines = self._reader.words_without_path, self._headers.template_lines
        warn_of_machine_words(self._texts, machine_words, template_lines, self._warn)
        warn_of_acting_words(self._run, self._warn)


def _coolant_words(control: Control) -> dict[int, str]:
    """M number -> CL word: OFF and ON before others with the same number, and of these the first."""
    words: dict[int, str] = {}
    for word in ("OFF", "ON", *control.coolant):
        if word in control.coolant:
            words.setdefault(control.coolant[word], word)
    return words


def _build_tool(values: dict[str, str], called: str, control: Control) -> Tool:
    """Return the cutter of an operation.

    values   values of the header; gets the settings with which the tool is called as in the program
    called   the tool as the program calls it, by number or name; empty if it calls none
    """
    kinds = {text: kind for kind, text in control.tool_types.items()}
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
