"""What a program says about the machine and a toolpath has no place for: each becomes a remark."""

import re
from collections.abc import Collection, Iterable, Sequence

import numpy as np

from trunnion.arrays import Ints
from trunnion.conversion.program_text import ProgramText
from trunnion.errors import Problem, Severity
from trunnion.model.run import Orientation, ProgrammedWord, Run
from trunnion.model.toolpath import Kind, Moves
from trunnion.planning.poses.selection import choose_poses

#: Remarks of one kind that are made one by one.
_MAX_WARNINGS = 5

#: Words that every operation's head says, or that are said by other means.
_ALWAYS_WRITTEN = frozenset(
    {"G40", "G60", "G601", "FNORM", "COMPOF", "EXTERN", "G49", "G80", "G90", "G94", "G8", "G97"}
)
_SURFACE_SPEED = frozenset({"G96", "G961", "G962"})
_TOOL_LENGTHS = frozenset({"G43", "G43.1", "G43.2", "G44"})
_CANCELS = frozenset({"G15", "G50", "G50.1", "G13.1", "G22", "G23", "G91.1", "G90.1"})

#: Rotary axes stand where they stood within this, degrees; programs have at most five decimals.
_SAME_ANGLE = 1e-4
_SAME_POSITION = 1e-3

#: G05.1 is G5.1.
_ZEROS = re.compile(r"^([GM])0+(?=\d)")


class Warnings:
    """Takes what does not survive the way back, each with its line; file as in ``Run.file``."""

    def __init__(self, files: Sequence[str]) -> None:
        self._files = files
        self._found: list[Problem] = []

    def __call__(self, line: int, what: str, cure: str = "", file: int = 0) -> None:
        """Take one."""
        self._found.append(Problem(self._files[file], line, what, cure, Severity.WARNING))

    @property
    def problems(self) -> tuple[Problem, ...]:
        """All of them."""
        return tuple(self._found)


def warn_of_machine_words(
    sources: Sequence[ProgramText], machine_words: frozenset[str], known: Collection[int], warn: Warnings
) -> None:
    """Say which words only drive the machine.

    Parameters
    ----------
    sources
        The program, and its subprograms.
    machine_words
        Words of the control's family that the path does not depend on.
    known
        Lines of the program that are lines of templates.
    """
    count = 0
    lost_words = (machine_words | _SURFACE_SPEED) - _ALWAYS_WRITTEN - _TOOL_LENGTHS - _CANCELS
    written = ((file, *line) for file, source in enumerate(sources) for line in source.sparse_words())
    for file, line, words in written:
        lost = [word for word in words if _ZEROS.sub(r"\1", word) in lost_words]
        if not lost or (file == 0 and line in known):
            continue
        count += 1
        if count <= _MAX_WARNINGS:
            what = f"{' '.join(lost)} is not carried over"
            speed = _SURFACE_SPEED.intersection(lost)
            warn(line, what, "S is taken as rev/min" if speed else "say it in a template of the control", file)
    if count > _MAX_WARNINGS:
        warn(0, f"and {count - _MAX_WARNINGS} more lines with words that are not carried over")


def warn_of_poses(run: Run, operations: Iterable[tuple[Ints, Moves]], warn: Warnings) -> None:
    """Say where the rotary axes stand otherwise than posting from the tool axis alone will place them.

    operations   the rows (n,) of each operation, and what became of them
    """
    machine = run.machine
    whole = np.array([np.isfinite(machine.axes[column].display_low) for column in machine.rotary])
    for rows, moves in operations:
        expected = choose_poses(machine, moves, keep_slides=machine.workpiece_zero is not None).rotary
        off = run.joints[rows][:, list(machine.rotary)] - expected
        off = np.where(whole, (off + 180.0) % 360.0 - 180.0, off)
        places, columns = np.nonzero(np.abs(off) > _SAME_ANGLE)
        if len(places):
            name = machine.axes[machine.rotary[int(columns[0])]].name
            many = len(np.unique(places))
            what = f"{many} points place the rotary axes otherwise than their tool axis says, the first by {name}"
            _warn_at_rows(run, rows[places], what, "only the tool axis is carried over", warn)


def warn_of_interpolation(run: Run, operations: Iterable[Ints], by_vectors: bool, warn: Warnings) -> None:
    """Say where the tool turns between two points in another way than a program of ours lets it turn.

    operations   the rows (n,) of each operation
    by_vectors   orientations will be said by vectors: these turn the tool on great circles
    """
    for rows in operations:
        turned = np.abs(np.diff(run.axis[rows], axis=0, prepend=run.axis[rows[:1]])).max(axis=1) > 1e-9
        turned &= run.kind[rows] != Kind.RAPID
        circle = turned & run.tcp[rows] & (run.orientation[rows] == Orientation.GREAT_CIRCLE)
        circle &= not by_vectors
        free = turned & ~run.tcp[rows]
        for there, what in ((circle, "turn the tool on a great circle"), (free, "turn the tool without TCP")):
            places = np.flatnonzero(there)
            if len(places):
                cure = "between points it goes as the control's templates say"
                _warn_at_rows(run, rows[places], f"{len(places)} points {what}, which is not carried over", cure, warn)


def warn_of_register_changes(run: Run, operations: Iterable[Ints], offset: str, warn: Warnings) -> None:
    """Say where work offset or edge change on the way; an edge that comes on after the first motions does not.

    operations   the rows (n,) of each operation
    offset       what stands before the number of a work offset
    """
    for rows in operations:
        written = rows[np.argmax(run.edge[rows] >= 0) :]
        for column, letter, there in ((run.work_offset, offset, rows), (run.edge, "D", written)):
            others = there[column[there] != column[there[0]]]
            if len(others):
                what = f"{letter}{column[others[0]]} within an operation is not carried over"
                _warn_at_rows(run, others, what, f"{letter}{column[there[0]]} holds for all of it", warn)


def warn_of_park_positions(run: Run, warn: Warnings) -> None:
    """Say which slides park elsewhere than at their home; one that is drawn back to its end is not parked."""
    names = run.machine.names
    drawn_back = [event.before_row for event in run.events if event.kind == "retract"]
    for word in (word for word in (ProgrammedWord.X, ProgrammedWord.Y, ProgrammedWord.Z) if word.name in names):
        axis = run.machine.axes[names.index(str(word.name))]
        placed = np.setdiff1d(np.flatnonzero(run.machine_frame & ((run.programmed & word) != 0)), drawn_back)
        places = run.joints[placed, names.index(axis.name)]
        away = np.flatnonzero(np.abs(places - axis.home) > _SAME_POSITION)
        if len(away):
            what = f"{axis.name} goes to the machine position {places[away[0]]:g}, which is not carried over"
            _warn_at_rows(run, placed[away], what, "the control's templates say where to park", warn)


def warn_of_normals(run: Run, warn: Warnings) -> None:
    """Say that normals of surfaces stay behind."""
    if len(run.normals):
        what = f"{len(run.normals)} blocks say the surface's normal, which is not carried over"
        _warn_at_rows(run, run.normals.row, what, "a CL file has contact points of the CAM in its place", warn)


def _warn_at_rows(run: Run, rows: Ints, what: str, cure: str, warn: Warnings) -> None:
    """A remark about rows, at the first of them."""
    warn(int(run.line[rows[0]]), what, cure, int(run.file[rows[0]]))
