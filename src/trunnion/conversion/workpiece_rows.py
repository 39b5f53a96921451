"""Which rows of a run move the tool at the workpiece; the others are moves of the machine and are left out."""

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.conversion.unsupported import Warnings
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind

_XY = ProgrammedWord.X | ProgrammedWord.Y
_XYZ = _XY | ProgrammedWord.Z
_POSITION = _XYZ | ProgrammedWord.VECTOR


def workpiece_rows(run: Run, first: int, end: int, level_approach: bool, warn: Warnings) -> Ints:
    """Rows from ``first`` up to ``end`` that move the tool at the workpiece; none before its first position there.

    level_approach   the control approaches X and Y first, then Z (``Control.level_approach``)
    """
    rows = np.arange(first, end)
    approach = _level_approaches(run, rows) if level_approach else np.zeros(len(rows), np.bool_)
    at_part = ~run.machine_frame[rows] & ~approach
    positions = at_part & ((run.programmed[rows] & _XYZ) != 0)
    if not positions.any():
        return rows[:0]
    begin = int(np.argmax(positions))
    at_part &= ~_rotary_positioning(run, rows)
    last = int(np.flatnonzero(at_part)[-1])
    left_out = begin + np.flatnonzero(~(at_part | approach)[begin:last])
    if len(left_out):
        row = int(rows[left_out[0]])
        what = "moves to machine positions within an operation are left out"
        warn(int(run.line[row]), what, file=int(run.file[row]))
    kept = begin + np.flatnonzero(at_part[begin:])
    if run.kind[rows[begin]] == Kind.ARC and rows[begin] > 0:
        return np.concatenate(([rows[begin] - 1], rows[kept]))  # an arc needs its start point
    return rows[kept]


def _rotary_positioning(run: Run, rows: Ints) -> Flags:
    """(n,) bool: rapids of the rotary axes alone, without TCP, away from the part or after the last position there."""
    programmed = run.programmed[rows]
    rotary_only = ((programmed & _POSITION) == 0) & (programmed != 0)
    alone = rotary_only & ~run.tcp[rows] & (run.kind[rows] == Kind.RAPID)
    works = ~alone & ~run.machine_frame[rows]
    order = np.arange(len(rows))
    after_last = order > (int(np.flatnonzero(works)[-1]) if works.any() else -1)
    return np.asarray(alone & ((_latest(run.machine_frame[rows]) > _latest(works)) | after_last))


def _level_approaches(run: Run, rows: Ints) -> Flags:
    """(n,) bool: the first leg of an approach, in X and Y from home, before a second one in Z alone."""
    words = run.programmed[rows] & _POSITION
    works = ~run.machine_frame[rows] & (words != 0)
    rapid = (run.kind[rows] == Kind.RAPID) & ~run.tcp[rows]
    worked_before = np.concatenate(([-1], _latest(works)[:-1]))
    from_home = (_latest(run.machine_frame[rows]) >= worked_before) & (worked_before < np.arange(len(rows)))
    first_leg = works & rapid & ((words & ~np.uint8(_XY)) == 0) & from_home
    found = np.zeros(len(rows), np.bool_)
    found[:-1] = first_leg[:-1] & rapid[1:] & (words[1:] == ProgrammedWord.Z)
    return found


def _latest(flags: Flags) -> Ints:
    """(n,): index of the latest True up to each row, -1 before the first."""
    return np.asarray(np.maximum.accumulate(np.where(flags, np.arange(len(flags)), -1)))
