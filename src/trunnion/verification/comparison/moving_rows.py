"""One program of a comparison: the rows in which its tool moves, and what holds there."""

import numpy as np

from trunnion.arrays import Flags, Floats, Ints, distinct
from trunnion.machines import forward
from trunnion.messages import Wording
from trunnion.model.feed_path import row_feed_path_lengths
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.comparison.stated_axes import first_statements
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.matching.rows_to_match import workpiece_rows
from trunnion.verification.row_ranges import CHUNK

_SENSES = {1: "clockwise_at", -1: "counterclockwise_at", 0: "off_at"}


class MovingRows:
    """A program without blocks that move and change nothing; motions are counted from 0.

    ``moves`` are those that go elsewhere than the one before. A block that states an axis for the first time counts
    too, as it moves the axis from wherever it has been.

    ``left_out`` are rows that go to points that nobody knows, as ``unknown_points`` has them.

    ``coolants`` and ``tools`` give each coolant word and tool the same number in both programs; they are filled in.
    """

    def __init__(
        self,
        run: Run,
        with_machine_frame: bool,
        coolants: dict[str, int],
        tools: dict[str, int],
        *,
        left_out: Flags | None = None,
    ) -> None:
        self.run = run
        in_workpiece = workpiece_rows(run)
        rows = in_workpiece.rows(0, len(in_workpiece))
        if left_out is not None:
            rows = rows[~left_out[rows]]
        if with_machine_frame:
            rows = distinct(np.concatenate((rows, run.state.machine_frame.rows_with(True))))
        self.coolant = _coolant_numbers(run, coolants)
        numbers = [tools.setdefault(_tool_name(name), len(tools)) for name in run.tools]
        self.tool = np.array(numbers, np.int64)[run.tool]
        self.start_tip, self.start_axis = (column[0] for column in forward(run.machine_at(0), run.start[None]))
        moving = self._moving(rows)
        self._machine_positions = MachinePositions.of(run) if with_machine_frame else None
        if self._machine_positions is not None:
            moving |= self._machine_positions.crossed(rows)
        moves = moving.copy()
        if with_machine_frame:
            moving |= np.isin(rows, first_statements(run))
        self.rows, self.moves = rows[moving], moves[moving]
        self._from_anywhere = np.zeros(len(self.rows), np.bool_)
        if left_out is not None:
            self._from_anywhere = np.concatenate(([True], left_out | run.state.machine_frame.column()))[self.rows]

    def __len__(self) -> int:
        return len(self.rows)

    def _moving(self, rows: Ints) -> Flags:
        """Which rows move the tool."""
        run = self.run
        moving = np.ones(len(rows), np.bool_)
        for start in range(1, len(rows), CHUNK):
            part, before = rows[start : start + CHUNK], rows[start - 1 : start - 1 + CHUNK][: len(rows) - start]
            moved = np.abs(run.tip[part] - run.tip[before]).max(axis=1, initial=0.0) > 1e-9
            moved |= np.abs(run.axis[part] - run.axis[before]).max(axis=1, initial=0.0) > 1e-12
            moving[start : start + CHUNK] = moved | (run.kind[part] == Kind.ARC)
        return moving

    def in_machine(self, rows: Ints) -> Flags:
        """Which rows move in machine coordinates that nothing relates to those of the workpiece, (k,) bool.

        Numbers of these two kinds may be the same where the places are not.
        """
        if self._machine_positions is None or self._machine_positions.known:
            return np.zeros(len(rows), np.bool_)
        return np.asarray(self.run.state.machine_frame.at(rows))

    def comes_from_anywhere(self, k: int) -> bool:
        """Whether nobody knows where motion ``k`` begins."""
        return bool(self._from_anywhere[k])

    def comes_from_above(self, k: int, tip: Floats, tolerance: float) -> bool:
        """Whether motion ``k`` comes at rapid from where nobody knows to a point straight above a tip."""
        row = self.rows[k]
        if not self._from_anywhere[k] or self.run.kind[row] != Kind.RAPID:
            return False
        axis = self.run.axis[row]
        away = self.run.tip[row] - tip
        height = float(away @ axis)
        return height > 0.0 and bool(np.abs(away - height * axis).max() <= tolerance)

    def start(self, k: int) -> tuple[Floats, Floats]:
        """Tip and tool axis before motion ``k``."""
        if k == 0:
            return self.start_tip, self.start_axis
        row = self.rows[k - 1]
        return self.run.tip[row], self.run.axis[row]

    def feeds(self, rows: Ints) -> Floats:
        """Return feeds of the tip in rows, mm/min, 0 for rapids."""
        run = self.run
        feed = np.where(run.feed_mode[rows] == 95, run.feed[rows] * run.rpm[rows], run.feed[rows])
        inverse_time, counted = run.feed_mode[rows] == 93, row_feed_path_lengths(run, rows)
        free = ~np.isnan(counted)
        if inverse_time.any() or free.any():
            length = self._lengths(rows)
            feed = np.where(inverse_time, feed * length, feed)
            feed[free] *= length[free] / counted[free]
        return np.asarray(np.where(run.kind[rows] == Kind.RAPID, 0.0, np.nan_to_num(feed)))

    def counted_lengths(self, rows: Ints) -> Floats:
        """Return the paths of the tip in rows whose F does not count them, (k,) mm; NaN in the others."""
        run = self.run
        counted = row_feed_path_lengths(run, rows)
        return np.where(np.isnan(counted) & (run.feed_mode[rows] != 93), np.nan, self._lengths(rows))

    def programmed(self, rows: Ints) -> Floats:
        """Return the number after F in rows, (k,), whatever it counts; 0 where none is in force."""
        return np.asarray(np.nan_to_num(self.run.feed[rows]))

    def programmed_feeds(self, rows: Ints) -> Floats:
        """Return the number after F in rows, (k,); 0 where it is a time or counts axes, and another one for each
        motion.
        """
        run = self.run
        of_path = (run.feed_mode[rows] != 93) & np.isnan(row_feed_path_lengths(run, rows))
        return np.asarray(np.where(of_path, self.programmed(rows), 0.0))

    def _lengths(self, rows: Ints) -> Floats:
        """Return how far the tip goes in rows, (k,) mm."""
        away = self.run.tip[rows] - self.run.tip[np.maximum(rows - 1, 0)]
        return np.asarray(np.sqrt((away**2).sum(axis=1)))

    def circle(self, k: int) -> tuple[Floats, Floats] | None:
        """Centre and normal of the circle that motion ``k`` is, if it is one."""
        row = self.rows[k]
        if self.run.kind[row] != Kind.ARC:
            return None
        m = int(np.searchsorted(self.run.arcs.row, row))
        return self.run.arcs.centre[m], self.run.arcs.normal[m]

    def full_turns(self, k: int) -> int:
        """Full turns of the circle that motion ``k`` is."""
        m = int(np.searchsorted(self.run.arcs.row, self.rows[k]))
        return int(self.run.arcs.full_turns[m])

    def spindle_words(self, row: int) -> Wording:
        """Speed and sense of the spindle in a row."""
        return Wording("comparison", _SENSES[int(self.run.spindle[row])], speed=self.run.rpm[row])

    def tool_name(self, row: int) -> Wording | str:
        """Return the tool in the spindle in a row."""
        return self.run.tools[self.run.tool[row]] or Wording("comparison", "none")

    def block_name(self, k: int) -> Wording:
        """Line and block number of motion ``k``; of the last one if the program has ended."""
        if not len(self.run):
            return Wording("comparison", "at_line", line=0)
        row = int(self.rows[k]) if k < len(self.rows) else len(self.run) - 1
        number = int(self.run.block_number[row])
        in_block, at_line = ("in_block", "at_line") if k < len(self.rows) else ("behind_block", "behind_line")
        return Wording("comparison", in_block if number >= 0 else at_line, line=self.run.line[row], number=number)


def unknown_points(run: Run) -> Flags:
    """Return which rows go to points that nobody knows: an axis still stands where the machine's zero alone says.

    Those of the machine's own coordinates are not among them.
    """
    found = np.zeros(len(run), np.bool_)
    positions = MachinePositions.of(run)
    if not positions.known:
        slides = [run.machine.column(name) for name in "XYZ"]
        found = positions.at(np.arange(len(run)))[:, slides].any(axis=1) & ~run.state.machine_frame.column()
    return found


def _tool_name(name: str) -> str:
    return str(int(name)) if name.isdigit() else name


def _coolant_numbers(run: Run, numbers: dict[str, int]) -> Ints:
    """Return a number for the coolant in each row, (n,)."""
    state = np.full(len(run), numbers.setdefault("off", len(numbers)), np.int64)
    for event in run.events:
        if event.kind == "coolant":
            state[event.before_row :] = numbers.setdefault(str(event.value), len(numbers))
    return state
