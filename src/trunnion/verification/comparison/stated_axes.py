"""Where the axes of two programs have been stated last: in machine coordinates, in a work offset, or nowhere yet.

In:     two runs of one language, on the same machine.
Out:    a state for each axis. A program that never states an axis moves the others while it stands where the program
        before has left it. One that states it in another work offset, or in machine coordinates, goes elsewhere as soon
        as the offset holds a value: rotary axes have values there, too.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints, distinct
from trunnion.messages import Wording
from trunnion.model.columns import StepColumn
from trunnion.model.run import ProgrammedWord, Run
from trunnion.verification.axes_from_home import AXIS_WORDS, axis_names
from trunnion.verification.comparison.states import ComparedState, Values

_PLANES: Final = ("tilt", "plane", "cycle800")

#: Not stated yet; in machine coordinates; in those of the workpiece before the program has selected a work offset.
#: At the end of its travel, to which a word has sent it.
_NOWHERE, _IN_MACHINE, _UNSELECTED, _AWAY = -1, 0, -2, -3
_ELSEWHERE: Final = {
    _NOWHERE: "nowhere", _IN_MACHINE: "in_machine", _UNSELECTED: "in_no_offset", _AWAY: "at_end_of_travel",
}  # fmt: skip


def first_statements(run: Run) -> Ints:
    """Return the rows that state an axis for the first time: they move it from wherever it has been."""
    stated = [np.flatnonzero(run.programmed & np.uint8(word))[:1] for word in AXIS_WORDS]
    return distinct(np.concatenate(stated)).astype(np.int64)


def rows_behind_retracts(run: Run) -> Ints:
    """Return the rows behind words that take the tool along its axis as far as it goes (k,), ascending."""
    events = [event.before_row for event in run.events if event.kind == "retract" and event.before_row < len(run)]
    rows = distinct(np.array(events, np.int64))
    return np.asarray(rows[~run.state.machine_frame.at(rows)])


def stated_axes(one: Run, two: Run) -> Iterator[ComparedState]:
    """Yield for each axis where it has been stated last."""
    if one.language != two.language or one.machine.key != two.machine.key:
        return
    for name, word in zip(axis_names(one), AXIS_WORDS, strict=True):
        yield _state(name, (one, two), (_column(one, word), _column(two, word)))


def _state(name: str, runs: tuple[Run, Run], columns: tuple[StepColumn, StepColumn]) -> ComparedState:
    first, second = columns
    offsets = [run.state.work_offset for run in runs]

    def words(run: Run, code: int) -> Wording:
        if code > _IN_MACHINE:
            return Wording("comparison", "in_offset", offset=run.work_offset_name(code))
        return Wording("comparison", _ELSEWHERE[code])

    def said(a: int, b: int) -> Wording:
        one, two = (words(run, int(column[row])) for run, column, row in zip(runs, columns, (a, b), strict=True))
        return Wording("comparison", "stated_axis", axis=name, one=one, two=two)

    def values(a: Ints, b: Ints) -> Values:
        return first.at(a), second.at(b)

    def counts(a: Ints, b: Ints) -> Flags:
        # Another offset is a difference of its own.
        return np.asarray(offsets[0].at(a) == offsets[1].at(b))

    return ComparedState(counts, lambda a, b: np.equal(*values(a, b)), values, said)


def _rows_of_planes(run: Run) -> list[int]:
    """Return the rows in which a plane turns the rotary axes by itself: it knows no work offset of theirs."""
    at = [(event.before_row, event.line) for event in run.events if event.kind in _PLANES]
    return [row for row, line in at if row < len(run) and run.line[row] == line]


def _column(run: Run, word: int) -> StepColumn:
    """Return where an axis has been stated last in each row, as a work offset or one of the values above."""
    rows = np.flatnonzero(run.programmed & np.uint8(word))
    rows = rows[~np.isin(rows, _rows_of_planes(run))]
    offsets = run.state.work_offset.at(rows).astype(np.int64)
    offsets[offsets == 0] = _UNSELECTED
    codes = np.where(run.state.machine_frame.at(rows), _IN_MACHINE, offsets)
    if word == int(ProgrammedWord.Z):
        away = rows_behind_retracts(run)
        away = away[~np.isin(away, rows)]
        order = np.argsort(np.append(rows, away), kind="stable")
        rows, codes = np.append(rows, away)[order], np.append(codes, np.full(len(away), _AWAY))[order]
    changes = np.flatnonzero(np.diff(codes, prepend=_NOWHERE))
    steps = {0: _NOWHERE, **dict(zip(rows[changes].tolist(), codes[changes].tolist(), strict=True))}
    return StepColumn(len(run), np.array(list(steps), np.int64), np.array(list(steps.values()), np.int64))
