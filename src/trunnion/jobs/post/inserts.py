"""Raw text (INSERT) that ends or bends a program: found by running what the program does with the text and without it.

In:     a program as it was planned.
Out:    problems at the lines of the INSERT statements, before the program is written.
"""

import math
import re
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Final

import numpy as np

from trunnion import readers
from trunnion.arrays import Floats, Ints
from trunnion.controls.inches import without_comments
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording, phrase
from trunnion.model.deviations import Deviations
from trunnion.model.motion import Motion
from trunnion.model.run import Run
from trunnion.model.splines import Splines
from trunnion.model.template_passage import TemplatePassage
from trunnion.model.toolpath import Arcs, Event, Insert, Kind, LoadTool, SpindleOff, SpindleOn
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.output.said_words import said_words
from trunnion.readers.control.event_recorder import SPINDLE_SENSES
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.known_words import HOME, begins_with

#: The error of a motion whose end is up to machine data.
_POSITION_IN_DOUBT: Final = "NC224"

#: A work offset that the program writes: with INSERT the CL file asks for it.
_OFFSET_WRITTEN: Final = "NC352"

#: Columns of a run that a text must leave as they are, and what each of them is.
_COLUMNS: Final = {
    "machine_frame": phrase("points_in_machine_coordinates"),
    "inches": phrase("changes_unit"),
    "work_offset": phrase("changes_work_offset"),
    "tcp": phrase("switches_tcp"),
    "tool": phrase("changes_tool"),
    "edge": phrase("changes_tool_length"),
    "compensation": phrase("switches_radius_compensation"),
    "kind": phrase("moves_of_other_kind"),
    "tip": phrase("points_elsewhere"),
    "rotary": phrase("rotary_axes_elsewhere"),
    "feed_mode": phrase("changes_meaning_of_feed"),
    "feed": phrase("changes_feed"),
    "spindle": phrase("switches_spindle"),
    "rpm": phrase("changes_spindle_speed"),
    "orientation": phrase("changes_how_tool_axis_moves"),
}

#: Events that a text may make: functions of the machine's builder, dwells, stops, messages.
_HARMLESS_EVENTS: Final = frozenset({"m", "h", "dwell", "stop", "optional_stop", "message"})

#: Events of a motion's first row that a trial has too.
_SWITCHES: Final = (LoadTool, SpindleOn, SpindleOff)

#: Blocks that jumps and loops of a text may execute.
_STEP_LIMIT: Final = 20_000

#: Places behind the words with which an operation chooses its modes, at which no text is tried.
_BEHIND_MODES: Final = ("same_tool", "preselect", "after_approach", "between_planes", "stop")

#: Words of a text.
_WORD: Final = re.compile(r"(?<![A-Z0-9_.])([A-Z_]+)([0-9]*(?:\.[0-9]+)?)")

#: Words that select a working plane.
_PLANE: Final = re.compile(r"(?<![A-Z0-9_.])G1([789])(?![0-9.])")

_MOST_LISTED: Final = 20

#: What is said of a text that calls a subprogram.
_NOT_RUN: Final = "subprogram_not_run"


def insert_problems(program: Program) -> list[Problem]:
    """Return what is wrong with the raw texts of a program; empty where its control has no reader."""
    if not readers.can_read(program.machine):
        return []
    problems = [problem for name in _BEHIND_MODES for problem in _modes_at(name, program)]
    harmless: set[object] = set()
    with tempfile.TemporaryDirectory() as folder:
        for motion in program.motions:
            texts: dict[str, Insert] = {}
            for event in motion.operation.events:
                if isinstance(event, Insert) and not _is_remark(event, program):
                    texts.setdefault(event.text, event)
            if not texts:
                continue
            trial, before = _Trial(program, motion, Path(folder)), len(problems)
            alike = trial.conditions(tuple(texts))
            if alike in harmless:
                continue
            effects = dict(trial.effects(list(texts)))
            for text, event in texts.items():
                effect = effects.get(text) or _not_known(text, program)
                if not effect:
                    continue
                problems.append(_problem(program, motion, event, effect))
                if len(problems) >= _MOST_LISTED:
                    return problems
            if len(problems) == before:
                harmless.add(alike)
    return problems


def _modes_at(name: str, program: Program) -> list[Problem]:
    """Words of a template that change how the control smooths or turns: the operation does not say its own again.

    The path does not show them, so that no proof does.
    """
    template = program.control.templates.get(name)
    if template is None:
        return []
    found = _modes_of(template.plain_lines(), program)
    return [_mode_problem(template.place_of(k), template.title, word) for k, word in found]


def mode_problems(program: Program, passages: Iterable[TemplatePassage]) -> list[Problem]:
    """Return the same of the lines that functions have written, which nobody knows before."""
    if not readers.can_read(program.machine):
        return []
    return [
        _mode_problem(each.source, each.title, word)
        for each in passages
        if each.template in _BEHIND_MODES
        for _, word in _modes_of(each.texts, program)
    ]


def _mode_problem(place: tuple[str, int], source: Wording, word: str) -> Problem:
    return Problem(*place, Wording("CTL457", "mode_not_stated_again", source=source, word=word))


def _modes_of(lines: Sequence[str], program: Program) -> list[tuple[int, str]]:
    """Return the words of lines that change a mode which the path does not show, with the indices of the lines.

    So does another working plane than XY, unless the lines end in XY: cuts do not say theirs, and lengths count by it.
    """
    reader, machine = readers.reader_of(program.machine), program.machine
    found, plane = list[tuple[int, str]](), (0, "")
    for k, line in enumerate(lines):
        words = without_comments(program.control, line.replace("\0", "1")).upper()
        if word := reader.raw_words.not_known(words, machine) and _mode_in(words, reader):
            found.append((k, word))
        for match in _PLANE.finditer(words):
            known = not reader.raw_words.not_known(match[0], machine)
            plane = k, "" if known or match[1] == "7" else match[0]
    return [*found, plane] if plane[1] else found


def _mode_in(words: str, reader: FamilyReader) -> str:
    """Return the first word of a block that changes a mode which the path does not show; empty if there is none."""
    for match in _WORD.finditer(words):
        word = match[1] + match[2].lstrip("0")
        if word in reader.words_without_path:
            return word
        smoothing = reader.smoothing.match(words, match.start()) if reader.smoothing else None
        if smoothing:
            return smoothing[0]
    return ""


def _is_remark(event: Insert, program: Program) -> bool:
    """Whether the text of a template is nothing but remarks, of which a program may have one a block."""
    lines = event.text.split("\n")
    return (
        bool(event.template) and said_words(lines, program.control, ()) == set() and not _not_known(event.text, program)
    )


def _problem(program: Program, motion: Motion, event: Insert, effect: Wording) -> Problem:
    """Return what is wrong with a text, at its line of the CL file or at its template."""
    file, text = program.file_of(motion.operation), event.text.strip().replace("\n", " | ")
    if not event.template:
        variant = "calls_subprogram" if effect.variant == _NOT_RUN else "changes_something"
        return Problem(file, event.line, Wording("CTL455", variant, text=text, effect=effect))
    template = program.control.templates[event.template]
    wording = Wording(
        "CTL457",
        "template_changes_something",
        source=template.title,
        text=text,
        file=file,
        line=event.line,
        effect=effect,
    )
    return Problem(*template.place_of(0), wording)


def _not_known(text: str, program: Program) -> Wording | None:
    """Which word of a text nobody knows to change nothing, a phrase: a run shows only what its reader follows."""
    known = readers.reader_of(program.machine).raw_words.not_known
    word = next((word for line in text.split("\n") if (word := known(line, program.machine))), "")
    return phrase("not_known_to_change_nothing", word=word) if word else None


class _Trial:
    """Writes and runs some moves of one motion, with and without texts between them."""

    def __init__(self, program: Program, motion: Motion, folder: Path) -> None:
        self._program, self._motion = replace(program, control=program.control.without_functions()), motion
        self._file = folder / "trial"
        self._quiet = program.control.family.comment("text")[0]

    def conditions(self, texts: tuple[str, ...]) -> object:
        """Return what the effect of texts depends on: in another motion with the same they have the same."""
        motion, operation = self._motion, self._motion.operation
        switched = [event for event in operation.events if event.row == 0 and isinstance(event, _SWITCHES)]
        settings = self._program.effective_settings(operation)
        return (
            texts, motion.mode, motion.plane, operation.tool, _first_feed(operation.moves.feed),
            tuple(replace(event, line=0) for event in switched), tuple(sorted(settings.items())),
        )  # fmt: skip

    def effects(self, texts: Sequence[str]) -> list[tuple[str, Wording]]:
        """Return the texts that change something, each with what it does: alone, or with those around it."""
        if not texts:
            return []
        effect = self._effect(texts)
        if not effect:
            return []
        half = len(texts) // 2
        found = [*self.effects(texts[:half]), *self.effects(texts[half:])] if half else []
        return found or [(texts[0], effect)]

    def _effect(self, texts: Sequence[str]) -> Wording | None:
        """Return what texts do, a phrase; None if nothing."""
        without = self._run([self._quiet] * len(texts))
        try:
            with_text = self._run(texts)
        except InputError as error:
            return phrase("cannot_be_run", reason=error.problems[0].wording)
        words = [word for word in readers.known_words(self._program.machine) if HOME not in word.effects]
        return _difference(without, with_text, words)

    def _run(self, texts: Sequence[str]) -> Run:
        sink = BytesIO()
        write_program(replace(self._program, motions=[_with_texts(self._motion, texts)], notices=()), sink)
        self._file.write_bytes(sink.getvalue())
        machine, encoding = self._program.machine, self._program.text_form.encoding
        return readers.run_program(self._file, machine, readers.RunOptions(step_limit=_STEP_LIMIT, encoding=encoding))


def _with_texts(motion: Motion, texts: Sequence[str]) -> Motion:
    """Return a motion to and fro between its first point and the one farthest from it, with each text at both."""
    operation = motion.operation
    distance = np.linalg.norm(operation.moves.tip - operation.moves.tip[0], axis=1)
    rows: Ints = np.zeros(2 * len(texts) + 2, np.int64)
    rows[1::2] = int(distance.argmax())
    moves = operation.moves.select(rows)
    feed = np.where(moves.feed > 0.0, moves.feed, _first_feed(operation.moves.feed))
    kind = np.full(len(rows), Kind.LINEAR, np.uint8)
    kind[0] = Kind.RAPID
    events: list[Event] = [event for event in operation.events if event.row == 0 and isinstance(event, _SWITCHES)]
    events += [Insert(2 * k + at + 1, 0, text) for k, text in enumerate(texts) for at in (0, 1)]
    return replace(
        motion,
        operation=replace(
            operation,
            moves=replace(moves, feed=feed, kind=kind),
            arcs=Arcs.empty(),
            splines=Splines.empty(),
            events=tuple(events),
        ),
        rotary=motion.rotary[rows],
        deviations=Deviations.none(),
        starts_operation=True,
        ends_in_hole=False,
    )


def _first_feed(feed: Floats) -> float:
    known = feed[feed > 0.0]
    return float(known[0]) if len(known) else 100.0


def _difference(without: Run, with_text: Run, declared: Sequence[readers.KnownWord]) -> Wording | None:
    """Return what a run does that another one does not, a phrase; words ``declared`` to do nothing do nothing."""
    known = {diagnostic.wording for diagnostic in without.errors}
    # What stands behind an end that the text has brought about is a consequence of it.
    end = min((event.line for event in with_text.events if event.kind == "end"), default=math.inf)
    errors = [each for each in with_text.errors if each.code != _OFFSET_WRITTEN]
    faults = [each for each in errors if each.wording not in known and each.line <= end]
    if len(with_text) > len(without) and all(each.code == _POSITION_IN_DOUBT for each in faults):
        return phrase("moves_machine")
    effect = _first_change(without, with_text)
    if effect:
        return effect
    if faults:
        fault = faults[0].wording
        if called := _missing_subprogram(fault):
            return phrase("subprogram_not_run", called=called)
        return phrase("effect_not_known", fault=fault)
    if len(with_text) < len(without):
        return phrase("ends_program")
    more = {
        "where the machine is" if kind == "known" else kind
        for kind, text, _ in _events(with_text, without) - _events(without, without)
        # A text asks for its words and variables.
        if kind not in ("unasked", "variable") and not (kind == "known" and begins_with(declared, text))
    }
    if "spindle" in more:
        return _COLUMNS["spindle"]
    return phrase("changes_more", kinds=tuple(sorted(more))) if more else None


def _missing_subprogram(fault: Wording) -> str:
    """Return the subprogram that a reader does not have; empty if that is not the fault."""
    match fault.variant:
        case "missing_subprogram_number" | "missing_called_number":
            return f"O{fault.parameter('number'):04d}"
        case "missing_subprogram":
            return f"O{fault.parameter('label')}"
        case "unknown_or_missing" | "unknown_or_missing_word":
            return str(fault.parameter("call"))
    return ""


def _first_change(without: Run, with_text: Run) -> Wording | None:
    """Return what is different in the first row that is, a phrase; None if the rows that both have are the same."""
    rows = min(len(without), len(with_text))
    found: Wording | None = None
    first = rows
    for name, what in _COLUMNS.items():
        before, after = (getattr(run, name)[:rows].astype(np.float64) for run in (without, with_text))
        differs = ~np.isclose(before, after, rtol=0.0, atol=1e-9, equal_nan=True).reshape(rows, -1).all(axis=1)
        row = int(np.argmax(differs)) if differs.any() else rows
        if row < first:
            first, found = row, what
    return found


def _events(run: Run, without: Run) -> set[tuple[str, str, int]]:
    """Return what happens in a run besides motion: kind, value, and for the spindle the row.

    A text may stop and start the spindle within its lines, which no row shows. A spindle that is told to turn as it
    does ``without`` the text, or stands behind the last row, is none of these.
    """
    found: set[tuple[str, str, int]] = set()
    for event in run.events:
        kind, value, row = event.kind, str(event.value), event.before_row
        if kind == "spindle":
            if row < len(without) and SPINDLE_SENSES.get(value) != int(without.spindle[row]):
                found.add((kind, value, row))
        elif kind not in _HARMLESS_EVENTS:
            found.add((kind, value, -1))
    return found
