"""Motions to CL points, or above them, by words that leave out an axis whose place nobody knows.

In:     a run that is matched with CL files.
Out:    their rows, with the axes.

Behind a way home an axis stands at a position of the machine, and behind a turn all of them stand elsewhere in the
workpiece. That the numbers of such a place are those of a CL point is chance: until the program states the axis, no
motion goes to a point, and none is above all of them. With workpiece zero and tool length a position of the machine is
one of the workpiece too; how far a word retracts is not known even then, unless the run has a motion for it.
"""

from collections.abc import Collection, Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Ints, distinct
from trunnion.model.programmed_words import POSITION_WORDS, names_no_axis
from trunnion.model.run import ProgrammedWord, Run
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.kinematics.positioning_moves import first_workpiece_position
from trunnion.verification.matching.pairs import Matching

_AXES: Final = {"X": int(ProgrammedWord.X), "Y": int(ProgrammedWord.Y), "Z": int(ProgrammedWord.Z)}
_ALL: Final = sum(_AXES.values())

#: Smaller rotary motion, degrees, is none.
_STILL: Final = 1e-6


def unstated_axes(run: Run, matching: Matching, passages: Collection[int]) -> Iterator[tuple[int, tuple[str, ...]]]:
    """Yield the first motion to a CL point behind each way home that leaves out axes, and these.

    passages  rows that go to no CL point, and are lawful because of where they are
    """
    missing = 0
    for first, end, left in _behind_ways_home(run):
        missing |= left
        for row in range(first, end):
            words = int(run.programmed[row])
            missing &= 0 if bool(names_no_axis(run.programmed[row : row + 1])[0]) else ~words
            if not missing:
                break
            if not words & int(POSITION_WORDS):
                continue
            needed = missing if row in matching.nc or row in passages else 0
            if needed and row not in matching.nc and row + 1 < end:
                # The other half of a leg states the axis right away; until then only the height matters.
                needed &= _along_tool(run, row) | ~int(run.programmed[row + 1])
            if needed:
                yield row, tuple(name for name, bit in _AXES.items() if needed & bit)
                missing = 0
                break


def _along_tool(run: Run, row: int) -> int:
    """Return the axes on which the height along the tool depends: of an upright one Z alone."""
    axis = np.abs(run.positions(np.array([row])).axis[0])
    return sum(bit for part, bit in zip(axis.tolist(), _AXES.values(), strict=True) if part > _STILL)


def _behind_ways_home(run: Run) -> Iterator[tuple[int, int, int]]:
    """Yield the first motion in the workpiece behind each way home, the row before which it ends, and the axes that
    are not known then.
    """
    frame = run.state.machine_frame.rows_with(True)
    retracts = np.array([event.before_row for event in run.events if event.kind == "retract"], np.int64)
    known = MachinePositions.of(run).known
    if known:
        frame, retracts = frame[:0], retracts[~np.isin(retracts, frame)]
    ways: Ints = distinct(np.concatenate((frame, retracts)))
    # A program that goes home before all else finds the axes where they were left.
    left = _ALL if len(ways) and not known and first_workpiece_position(run, 0, int(ways[0])) is None else 0
    begin: int | None = None
    for k, row in enumerate(ways.tolist()):
        begin = max(row - 1, 0) if begin is None else begin
        at_machine = row < len(run) and bool(run.state.machine_frame[row])
        left |= int(run.programmed[row]) & _ALL if at_machine else _AXES["Z"]
        following = int(ways[k + 1]) if k + 1 < len(ways) else len(run)
        first = first_workpiece_position(run, row + 1 if at_machine else row, following)
        if first is None:
            continue
        turned = bool((np.abs(run.rotary[first] - run.rotary[begin]) > _STILL).any())
        yield first, following, _ALL if turned and not known else left
        left, begin = 0, None
