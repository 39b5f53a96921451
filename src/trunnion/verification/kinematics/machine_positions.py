"""Which slides stand where the program has put them in coordinates of the machine.

In:     a run.
Out:    flags of rows.

A position in coordinates of the workpiece is one of the machine only if the workpiece zero and the tool length are
known. Otherwise the same number means another place: what a run says of the slides there is no more than a guess, so it
proves no retract, and says of no motion that nothing moves.
"""

from collections.abc import Iterator
from weakref import WeakKeyDictionary

import numpy as np

from trunnion.arrays import Codes, Flags, Ints, distinct
from trunnion.model.programmed_words import POSITION_WORDS, ROTARY_WORDS, names_no_axis
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.unknown_setups import rows_without_values

#: Rows that are searched at first for the next motion in workpiece coordinates; later ever more.
_FEW = 64

#: All coordinates of the tip.
_TIP_WORDS = int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)

_SLIDES = (ProgrammedWord.X, ProgrammedWord.Y, ProgrammedWord.Z)


class MachinePositions:
    """Knows for each slide in which rows it stands at a position that was programmed in machine coordinates.

    known   positions in coordinates of the workpiece are positions of the machine too
    """

    def __init__(self, run: Run) -> None:
        machine = run.machine
        self._width = len(machine.axes)
        self.known = machine.workpiece_zero is not None and machine.tool_length is not None
        self.known &= next(rows_without_values(run), None) is None
        self._spans: dict[int, tuple[Ints, Ints]] = {}
        if self.known:
            return
        frame = run.state.machine_frame.rows_with(True)
        retracts = _retracts_by_word(run, frame)
        for word in _SLIDES:
            named = frame[((run.programmed[frame] & int(word)) != 0) | np.isin(frame, retracts)]
            begins = np.concatenate(([-1], named))  # the machine stands at home when the program begins
            ends = [_next_in_workpiece(run, word, row + 1) for row in begins.tolist()]
            self._spans[machine.column(str(word.name))] = begins, np.array(ends, np.int64)

    @staticmethod
    def of(run: Run) -> "MachinePositions":
        """Return what is known of the slides of a run, found once for all checks."""
        found = _of_runs.get(run)
        if found is None:
            found = _of_runs[run] = MachinePositions(run)
        return found

    def at(self, rows: Ints) -> Flags:
        """Which axes stand where machine coordinates, or a known zero, have put them after rows, (k, 5) bool.

        Row -1 is the start of the program. Rotary axes always do.
        """
        found = self.unplaced(rows)
        found[:, [column for column in range(self._width) if column not in self._spans]] = True
        return found

    def unplaced(self, rows: Ints) -> Flags:
        """Which slides stand after rows at a machine position that nobody can compare with those of the workpiece,
        (k, 5) bool.
        """
        found = np.zeros((len(rows), self._width), np.bool_)
        for column, (begins, ends) in self._spans.items():
            found[:, column] = rows < ends[np.searchsorted(begins, rows, "right") - 1]
        return found

    def left_at_machine(self) -> Iterator[tuple[int, int]]:
        """Yield spans of rows, first and end, after which a slide stands where machine coordinates have put it.

        There are none if these are those of the workpiece too.
        """
        for begins, ends in self._spans.values():
            before_next = np.minimum(ends[1:], [*begins[2:], ends[-1]])  # spans do not overlap: there may be many
            yield from zip(begins[1:].tolist(), before_next.tolist(), strict=True)

    def half_stated(self, run: Run) -> Ints:
        """Rows that move the tip while a coordinate of it is still that of a machine position: (k,), increasing.

        In a tilted plane or under TCP all slides may follow from it, so that nobody knows where any of them is.
        """
        found = [_tip_rows(run, first + 1, end) for first, end in self.left_at_machine()]
        return distinct(np.concatenate([np.zeros(0, np.int64), *found]))

    def crossed(self, rows: Ints) -> Flags:
        """Which rows move a slide between the two kinds of coordinates: nobody knows how far, (k,) bool."""
        return np.asarray((self.at(rows) != self.at(rows - 1)).any(axis=1))


#: Kept as long as the runs.
_of_runs: WeakKeyDictionary[Run, MachinePositions] = WeakKeyDictionary()


def _next_in_workpiece(run: Run, word: ProgrammedWord, first: int) -> int:
    """Return the first row from ``first`` on that puts a slide where workpiece coordinates want it; n if there
    is none.
    """
    size, stated = _FEW, 0
    while first < len(run):
        end = min(first + size, len(run))
        programmed = run.programmed[first:end]
        in_workpiece = ~run.state.machine_frame.part(first, end)
        moves = _slide_moves(programmed, word)
        # In a plane, under TCP and with M114 slides follow from all three coordinates of the tip.
        named = np.bitwise_or.accumulate(np.append(stated, np.where(in_workpiece, programmed & _TIP_WORDS, 0)))[1:]
        stated = int(named[-1])
        tip = run.state.xyz_is_tip.part(first, end) & ((programmed & _TIP_WORDS) != 0)
        tip |= run.state.follows(first, end) & ((programmed & int(ROTARY_WORDS)) != 0)
        moves |= tip & (named == _TIP_WORDS)
        moves &= in_workpiece
        if moves.any():
            return first + int(np.argmax(moves))
        first, size = end, 4 * size
    return len(run)


def _tip_rows(run: Run, first: int, end: int) -> Ints:
    """Rows from ``first`` to the one before ``end`` that move the tip in coordinates of the workpiece."""
    programmed = run.programmed[first:end]
    moves = run.state.xyz_is_tip.part(first, end) & ((programmed & int(POSITION_WORDS)) != 0)
    moves |= run.state.follows(first, end) & ((programmed & int(ROTARY_WORDS)) != 0)
    moves &= ~run.state.machine_frame.part(first, end)
    return np.asarray(first + np.flatnonzero(moves))


def _retracts_by_word(run: Run, frame: Ints) -> Ints:
    """Rows of the machine frame to which a word such as M140 retracts along the tool, and names no axis."""
    retracts = np.array([event.before_row for event in run.events if event.kind == "retract"], np.int64)
    return np.asarray(frame[np.isin(frame, retracts) & ((run.programmed[frame] & _TIP_WORDS) == 0)])


def _slide_moves(programmed: Codes, word: ProgrammedWord) -> Flags:
    """Which words move a slide: its own, and those of a circle or a cycle, which name no axis."""
    return np.asarray(((programmed & int(word)) != 0) | names_no_axis(programmed))
