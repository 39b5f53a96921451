"""What a program says about the machine and a toolpath has no place for: each becomes a remark."""

from collections.abc import Collection, Iterable, Sequence

import numpy as np

from trunnion.arrays import Ints
from trunnion.convert.source import Source
from trunnion.errors import Problem, Severity
from trunnion.plan.poses import follow
from trunnion.reader import Orientation, Run, Written
from trunnion.reader.sinumerik.words import G_SILENT, SILENT, SILENT_CALLS, SILENT_VALUES
from trunnion.toolpath import Kind

#: Remarks of one kind that are made one by one.
_NAMED = 5

#: Words that every operation's head says, or that are said by other means.
_SAID_ANYHOW = frozenset({"G40", "G60", "G601", "FNORM", "COMPOF", "EXTERN"})
_SURFACE_SPEED = frozenset({"G96", "G961", "G962"})
_LOST = (
    frozenset({*SILENT, *SILENT_VALUES, *SILENT_CALLS, *(f"G{code}" for code in G_SILENT)}) | _SURFACE_SPEED
) - _SAID_ANYHOW

#: Rotary axes stand where they stood within this, degrees; programs have at most five decimals.
_SAME_ANGLE = 1e-4
_SAME_POSITION = 1e-3


class Remarks:
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


def remark_words(files: Sequence[str], known: Collection[int], remark: Remarks) -> None:
    """Say which words only drive the machine.

    Parameters
    ----------
    files
        Of the run: the program, and its subprograms.
    known
        Lines of the program that are lines of templates.
    """
    told = 0
    said = ((file, *line) for file, name in enumerate(files) for line in Source(name).words())
    for file, line, words in said:
        lost = [word for word in words if word in _LOST]
        if not lost or (file == 0 and line in known):
            continue
        told += 1
        if told <= _NAMED:
            what = f"{' '.join(lost)} is not carried over"
            speed = _SURFACE_SPEED.intersection(lost)
            remark(line, what, "S is taken as rev/min" if speed else "say it in a template of the control", file)
    if told > _NAMED:
        remark(0, f"and {told - _NAMED} more lines with words that are not carried over")


def remark_poses(run: Run, operations: Iterable[Ints], remark: Remarks) -> None:
    """Say where the rotary axes stand otherwise than posting from the tool axis alone will place them.

    operations   the rows (n,) of each operation
    """
    machine = run.machine
    whole = np.array([np.isfinite(machine.axes[column].display_low) for column in machine.rotary])
    for rows in operations:
        tip, axis = np.ascontiguousarray(run.tip[rows]), np.ascontiguousarray(run.axis[rows])
        expected = follow(machine, tip, axis, keep_slides=machine.workpiece_zero is not None).rotary
        off = run.joints[rows][:, list(machine.rotary)] - expected
        off = np.where(whole, (off + 180.0) % 360.0 - 180.0, off)
        places, columns = np.nonzero(np.abs(off) > _SAME_ANGLE)
        if len(places):
            name = machine.axes[machine.rotary[int(columns[0])]].name
            many = len(np.unique(places))
            what = f"{many} points place the rotary axes otherwise than their tool axis says, the first by {name}"
            _at(run, rows[places], what, "only the tool axis is carried over", remark)


def remark_ways(run: Run, operations: Iterable[Ints], remark: Remarks) -> None:
    """Say where the tool turns between two points in another way than a program of ours lets it turn.

    operations   the rows (n,) of each operation
    """
    for rows in operations:
        turned = np.abs(np.diff(run.axis[rows], axis=0, prepend=run.axis[rows[:1]])).max(axis=1) > 1e-9
        turned &= run.kind[rows] != Kind.RAPID
        circle = turned & run.tcp[rows] & (run.orientation[rows] == Orientation.GREAT_CIRCLE)
        free = turned & ~run.tcp[rows]
        for there, what in ((circle, "turn the tool on a great circle"), (free, "turn the tool without TRAORI")):
            places = np.flatnonzero(there)
            if len(places):
                cure = "between points it goes as the control's templates say"
                _at(run, rows[places], f"{len(places)} points {what}, which is not carried over", cure, remark)


def remark_registers(run: Run, operations: Iterable[Ints], remark: Remarks) -> None:
    """Say where work offset or edge change on the way.

    operations   the rows (n,) of each operation
    """
    for rows in operations:
        for column, letter in ((run.offset, "G"), (run.edge, "D")):
            others = rows[column[rows] != column[rows[0]]]
            if len(others):
                what = f"{letter}{column[others[0]]} within an operation is not carried over"
                _at(run, others, what, f"{letter}{column[rows[0]]} holds for all of it", remark)


def remark_homes(run: Run, remark: Remarks) -> None:
    """Say which slides park elsewhere than at their home."""
    names = run.machine.names
    for word in (word for word in (Written.X, Written.Y, Written.Z) if word.name in names):
        axis = run.machine.axes[names.index(str(word.name))]
        placed = np.flatnonzero(run.machine_frame & ((run.programmed & word) != 0))
        places = run.joints[placed, names.index(axis.name)]
        away = np.flatnonzero(np.abs(places - axis.home) > _SAME_POSITION)
        if len(away):
            what = f"{axis.name} goes to the machine position {places[away[0]]:g}, which is not carried over"
            _at(run, placed[away], what, "the control's templates say where to park", remark)


def _at(run: Run, rows: Ints, what: str, cure: str, remark: Remarks) -> None:
    """A remark about rows, at the first of them."""
    remark(int(run.block[rows[0]]), what, cure, int(run.file[rows[0]]))
