"""What a program does that a toolpath cannot hold: each becomes a warning with its line."""

import re
from collections.abc import Collection, Iterable, Sequence

import numpy as np

from trunnion.arrays import Ints, distinct
from trunnion.conversion.program_text import ProgramText
from trunnion.conversion.states import SAID_ANYHOW
from trunnion.errors import Problem, Severity, warning
from trunnion.messages import Wording
from trunnion.model.run import Orientation, ProgrammedWord, Run
from trunnion.model.toolpath import Kind, Moves
from trunnion.planning.poses.selection import choose_poses
from trunnion.verification.block_names import block_name_of

#: Lines with lost words that get a warning each; the others are only counted.
_MAX_WORD_WARNINGS = 5

_SURFACE_SPEED = frozenset({"G96", "G961", "G962"})

#: Findings of readers about what acts on the control or stops it, by their codes and variants: how its word is written.
_ACTING = {
    ("NC221", "fn_known_not_simulated"): "FN {number}",
    ("NC226", "fn_known_not_simulated"): "FN {number}",
    ("NC221", "not_simulated"): "{word}",
    ("NC226", "alarm"): "{word}",
}

#: How findings of readers begin where the path is that of the wall, or of the tool centre as programmed.
_WITHOUT_RADIUS = ("cycle 208:", "G41.2:", "G42.2:")

#: Rotary positions within this, degrees, are the same; programs have at most five decimals.
_SAME_ANGLE = 1e-4
#: A rotary axis within this, degrees, of where an operation begins is there: planes may have fewer digits.
_SAME_PARK_ANGLE = 0.01
#: Machine positions within this, mm, are the same.
_SAME_POSITION = 1e-3
#: A tool within this distance of the axis of a hole, mm, is on it; heights within it are the same.
ON_AXIS = 1e-5
#: The tool axis turns if one of its components changes by more than this.
_TURNS = 1e-9

#: G05.1 is G5.1.
_ZEROS = re.compile(r"^([GM])0+(?=\d)")


class Warnings:
    """Collects what cannot be converted: what is lost, and what must not be lost."""

    def __init__(self, files: Sequence[str]) -> None:
        """``files`` are those of the run."""
        self._files = files
        self._found: list[Problem] = []

    def __call__(self, line: int, wording: Wording, file: int = 0) -> None:
        """Add a warning, once; ``file`` is an index as in ``Run.file``."""
        problem = warning(self._files[file], line, wording)
        if problem not in self._found:
            self._found.append(problem)

    def refuse(self, line: int, wording: Wording, file: int = 0) -> None:
        """Add an error: the program must not be converted without it."""
        self._found.append(Problem(self._files[file], line, wording))

    @property
    def problems(self) -> tuple[Problem, ...]:
        """All warnings and errors, in the order in which they were added."""
        return tuple(self._found)


def warn_of_machine_words(
    texts: Sequence[ProgramText], machine_words: frozenset[str], template_lines: Collection[int], warn: Warnings
) -> None:
    """Warn of words that act on the machine but not on the path.

    texts           the program and its subprograms
    machine_words   the words of the control's family on which the path does not depend
    template_lines  lines of the program that were written from templates
    """
    count = 0
    lost_words = machine_words - SAID_ANYHOW - _SURFACE_SPEED
    for file, text in enumerate(texts):
        for line, words in text.sparse_words():
            plain = [_ZEROS.sub(r"\1", word) for word in words]
            if _SURFACE_SPEED.intersection(plain):
                warn.refuse(line, Wording("CNV170", "constant_surface_speed"), file)
            lost = [word for word in words if _ZEROS.sub(r"\1", word) in lost_words]
            if not lost or (file == 0 and line in template_lines):
                continue
            count += 1
            if count <= _MAX_WORD_WARNINGS:
                warn(line, Wording("CNV150", "not_carried", lost=tuple(lost)), file)
    if count > _MAX_WORD_WARNINGS:
        warn(0, Wording("CNV150", "more_lines_words", count=count - _MAX_WORD_WARNINGS))


def warn_of_acting_words(run: Run, warn: Warnings) -> None:
    """Warn of what no word of a block says alone: functions that print, speak to the PLC, wait, or raise an alarm."""
    lost: dict[tuple[str, int], str] = {}
    for found in run.diagnostics:
        written = _ACTING.get((found.code, found.wording.variant))
        if written is not None:
            lost[found.file, found.line] = written.format(**dict(found.wording.parameters))
    for (file, line), word in list(lost.items())[:_MAX_WORD_WARNINGS]:
        warn(line, Wording("CNV150", "not_carried", lost=(word,)), run.files.index(file))
    if len(lost) > _MAX_WORD_WARNINGS:
        warn(0, Wording("CNV150", "more_lines_words", count=len(lost) - _MAX_WORD_WARNINGS))


def warn_of_poses(run: Run, operations: Iterable[tuple[Ints, Moves]], warn: Warnings) -> None:
    """Warn of rotary positions other than those that posting chooses from the tool axis alone.

    operations   the rows (n,) of each operation, and its moves
    """
    machine = run.machine
    endless = np.array([machine.axes[column].endless for column in machine.rotary])
    displays_turn = np.array([np.isfinite(machine.axes[column].display_low) for column in machine.rotary])
    for rows, moves in operations:
        expected = choose_poses(machine, moves, keep_slide_limits=machine.workpiece_zero is not None).rotary
        difference = run.joints[rows][:, list(machine.rotary)] - expected
        difference = np.where(displays_turn, (difference + 180.0) % 360.0 - 180.0, difference)
        # Whole turns by which all of an operation is further or back change nothing within it.
        difference -= np.where(endless, 360.0 * np.round(difference[:1] / 360.0), 0.0)
        differing, columns = np.nonzero(np.abs(difference) > _SAME_ANGLE)
        if len(differing):
            name = machine.axes[machine.rotary[int(columns[0])]].name
            _warn_at_rows(
                run,
                rows[differing],
                Wording("CNV160", "other_rotary_positions", count=len(distinct(differing)), name=name),
                warn,
            )


def warn_of_interpolation(run: Run, operations: Iterable[Ints], by_vectors: bool, warn: Warnings) -> None:
    """Warn of motions that turn the tool in another way than the programs of ``trunnion.post`` do.

    operations   the rows (n,) of each operation
    by_vectors   orientations will be written as vectors, which turn the tool on great circles
    """
    for rows in operations:
        turns = np.abs(np.diff(run.axis[rows], axis=0, prepend=run.axis[rows[:1]])).max(axis=1) > _TURNS
        turns &= run.kind[rows] != Kind.RAPID
        great_circle = turns & run.tcp[rows] & (run.orientation[rows] == Orientation.GREAT_CIRCLE)
        great_circle &= not by_vectors
        without_tcp = turns & ~run.tcp[rows]
        for found, how in (
            (great_circle, "on a great circle"),
            (without_tcp, "without TCP"),
        ):
            points = rows[found]
            if len(points):
                _warn_at_rows(run, points, Wording("CNV160", "tool_turns_point", how=how, count=len(points)), warn)


def warn_of_register_changes(run: Run, operations: Iterable[Ints], offset: str, warn: Warnings) -> None:
    """Refuse work offsets and edges that change within an operation; an edge may begin after the first motions.

    operations   the rows (n,) of each operation
    offset       the text before the number of a work offset
    """
    for rows in operations:
        with_edge = rows[np.argmax(run.edge[rows] >= 0) :]
        for column, letter, concerned in ((run.work_offset, offset, rows), (run.edge, "D", with_edge)):
            others = concerned[column[concerned] != column[concerned[0]]]
            # Without a length in force rapids lead away: their positions are those of the spindle nose.
            others = others[(column[others] > 0) | (run.kind[others] != Kind.RAPID)]
            if len(others):
                warn.refuse(
                    int(run.line[others[0]]),
                    Wording(
                        "CNV143",
                        "within_operation",
                        letter=letter,
                        column=column[others[0]],
                        own_column=column[concerned[0]],
                    ),
                    int(run.file[others[0]]),
                )


def warn_of_park_positions(run: Run, warn: Warnings) -> None:
    """Warn of slides that park elsewhere than at home; retracting to the end of the travel is no parking."""
    names = run.machine.names
    retracts = [event.before_row for event in run.events if event.kind == "retract"]
    for word in (word for word in (ProgrammedWord.X, ProgrammedWord.Y, ProgrammedWord.Z) if word.name in names):
        axis = run.machine.axes[names.index(str(word.name))]
        rows = np.setdiff1d(np.flatnonzero(run.machine_frame & ((run.programmed & word) != 0)), retracts)
        positions = run.joints[rows, names.index(axis.name)]
        elsewhere = np.flatnonzero(np.abs(positions - axis.home) > _SAME_POSITION)
        if len(elsewhere):
            position = positions[elsewhere[0]]
            _warn_at_rows(
                run,
                rows[elsewhere],
                Wording("CNV161", "goes_machine_position", axis=axis.name, position=position),
                warn,
            )


def warn_of_park_angles(run: Run, operations: Sequence[Ints], warn: Warnings) -> None:
    """Warn of rotary axes that go elsewhere between operations than home and to where an operation begins or ends.

    operations   the rows (n,) of each operation
    """
    machine = run.machine
    ends = [-1, *(int(rows[-1]) for rows in operations)]
    begins = [*(int(rows[0]) for rows in operations), len(run)]
    for end, begin in zip(ends, begins, strict=True):
        rows = np.arange(end + 1, begin)
        for column in machine.rotary if len(rows) else ():
            axis = machine.axes[column]
            known = [axis.home, *(float(run.joints[row, column]) for row in (end, begin) if 0 <= row < len(run))]
            away = np.abs(run.joints[rows, column][:, None] - known)
            away = np.minimum(away % 360.0, -away % 360.0) if axis.endless else away
            elsewhere = np.flatnonzero(away.min(axis=1) > _SAME_PARK_ANGLE)
            if len(elsewhere):
                row = rows[elsewhere]
                said = Wording("CNV161", "goes_machine_position", axis=axis.name, position=run.joints[row[0], column])
                _warn_at_rows(run, row, said, warn)


def refuse_unsimulated_motions(run: Run, warn: Warnings) -> None:
    """Refuse what the reader only approximates: paths without the tool's radius."""
    for found in run.diagnostics:
        if found.severity is Severity.WARNING and found.text.startswith(_WITHOUT_RADIUS):
            wording = Wording("CNV172", "without_radius", text=found.text)
            warn.refuse(found.line, wording, run.files.index(found.file))


def warn_of_normals(run: Run, warn: Warnings) -> None:
    """Warn of surface normals."""
    if len(run.normals):
        _warn_at_rows(run, run.normals.row, Wording("CNV163", "block_surface_normal", count=len(run.normals)), warn)


def warn_of_splines(run: Run, warn: Warnings) -> None:
    """Warn of splines, of which only their points are carried over."""
    if len(run.splines):
        _warn_at_rows(run, run.splines.first, Wording("CNV163", "spline_program_lines", count=len(run.splines)), warn)


def warn_of_cycles(run: Run, warn: Warnings) -> None:
    """Warn of drilling cycles, of which only their motion is carried over; those of threads and bores stay cycles.

    The motion has the pecks of the program's control, which may divide the last ones otherwise than a CL file asks.
    """
    rows = [event.before_row for event in run.events if event.kind == "hole" and event.before_row < len(run)]
    if not rows:
        return
    ends = [*rows[1:], len(run)]
    pecked = sum(_is_pecked(run, first, end) for first, end in zip(rows, ends, strict=True))
    said: dict[str, object] = {"count": len(rows), "first": block_name_of(run, rows[0])}
    if pecked:
        wording = Wording("CNV163", "pecks_become_motion", **said, pecked=pecked)
    else:
        wording = Wording("CNV163", "cycles_become_motion", **said)
    _warn_at_rows(run, np.array(rows), wording, warn)


def _is_pecked(run: Run, first: int, end: int) -> bool:
    """Whether the tool cuts deeper more than once in the hole that begins with row ``first``; ``end``: the next one.

    A hole ends where its block ends, or the tool leaves its axis.
    """
    deepest, strokes = np.inf, 0
    for row in range(first, end):
        offset = run.tip[row] - run.tip[first]
        height = float(offset @ run.axis[first])
        if float(np.linalg.norm(offset - height * run.axis[first])) > ON_AXIS or run.line[row] != run.line[first]:
            break
        if run.kind[row] == Kind.LINEAR and height < deepest - ON_AXIS:
            deepest, strokes = height, strokes + 1
        if strokes > 1:
            return True
    return False


def _warn_at_rows(run: Run, rows: Ints, wording: Wording, warn: Warnings) -> None:
    """Warn of something in ``rows``, at the first of them."""
    warn(int(run.line[rows[0]]), wording, int(run.file[rows[0]]))
