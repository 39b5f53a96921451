"""Rotary axes that turn without TCP while the tool is at the part.

The tool is away from the part at home along the spindle, or after a word that retracts it. Elsewhere it is away only
if a number says so: the distance from the turned part (``trunnion.machines.turn_clearance``). That needs to know where
the part turns to, so the workpiece zero must be known. One turn needs less: the rotary axis next to the part alone, at
constant tilt, in a program that has no machine positions at all, turns the part about its own zero.
"""

from collections.abc import Callable
from dataclasses import field
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints, distinct
from trunnion.machines import SAFE_DISTANCE, Mount, SweptPart, turn_clearance, turns_part_alone
from trunnion.messages import Wording
from trunnion.model.programmed_words import ROTARY_WORDS
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.verification.context import Context
from trunnion.verification.kinematics.cut_extent import cut_extent
from trunnion.verification.kinematics.home_tolerance import home_tolerance, spindle_slide
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.kinematics.positioning_moves import only_positions_rotary_axes, rotary_positioning_flags
from trunnion.verification.results import Place
from trunnion.verification.row_ranges import chunk_bounds

#: Smaller rotary motion, degrees, is none; and smaller motion of a slide, mm.
STILL: Final = 1e-3


@dataclass(slots=True, eq=False)
class RotaryMovesAtPart:
    """What was found: the faults, and how the other turns are safe.

    at_home, by_word  turns behind a retract home along the spindle, and behind a word for it
    distances         of each turn that a number makes safe, mm from the turned part
    """

    places: list[Place] = field(default_factory=list)
    at_home: int = 0
    by_word: int = 0
    distances: list[float] = field(default_factory=list)

    def said(self) -> Wording:
        """How the turns are safe."""
        ways = [Wording("turns", "at_home", count=self.at_home)] if self.at_home else []
        ways += [Wording("turns", "by_word", count=self.by_word)] if self.by_word else []
        if self.distances:
            nearest = {"count": len(self.distances), "distance": min(self.distances)}
            ways.append(Wording("turns", "by_distance", **nearest, least=SAFE_DISTANCE))
        return Wording("turns", "away_by", ways=tuple(ways)) if ways else Wording("turns", "away")


def turn_flags(run: Run, rows: Ints) -> Flags:
    """Which rows, not counting the first of the run, move a rotary axis, (k,) bool."""
    columns = list(run.machine.rotary)
    before, after = run.positions(rows - 1).joints[:, columns], run.positions(rows).joints[:, columns]
    return np.asarray((np.abs(after - before) > STILL).any(axis=1))


def stands_away(context: Context) -> Callable[[int], bool]:
    """Whether the tool is away from the part at an event of the run: at home along the spindle, or behind a retract.

    The function takes the place of the event among those of the run.
    A program that has neither is not judged: it is away everywhere.
    """
    return _Judge(context).stands_away


def rows_away(context: Context) -> Ints | None:
    """Return the rows that lead home along the spindle, and those behind which a word retracts the tool, increasing.

    None for a program that has neither.
    """
    return _Judge(context).rows_away()


def rotary_moves_at_part(context: Context) -> RotaryMovesAtPart:
    """Judge every turn of a rotary axis that positions it with TCP off."""
    return _Judge(context).result()


class _Judge:
    """Judges the turns of one program."""

    def __init__(self, context: Context) -> None:
        self._context, self._run = context, context.run
        self._machine = context.run.machine
        self._retracts = np.sort(np.array([e.before_row for e in self._run.events if e.kind == "retract"], np.int64))
        self._along, self._outward = spindle_slide(self._machine)
        frame = self._run.state.machine_frame.rows_with(True)
        self._frame = frame[~np.isin(frame, self._retracts)]
        self._machine_positions = MachinePositions.of(self._run)
        self._safe_height = self._height_of_retract()
        self._homes = self._rows_home()
        self._part: SweptPart | None = None
        self._part_is_known = False

    def result(self) -> RotaryMovesAtPart:
        """Judge all turns."""
        found, run = RotaryMovesAtPart(), self._run
        positioning = _positioning_rows(run)
        rows = positioning[positioning > 0]
        rows = rows[turn_flags(run, rows)]
        before_of: dict[int, int] = {}  # the last row before each that does more, or leads home
        for row in positioning.tolist():
            before = row - 1
            before_of[row] = before if self._is_home(before) else before_of.get(before, before)
        for row in rows.tolist():
            before = before_of[row]
            if before < 0:
                continue  # from where the program starts, which is home
            if self._is_retracted(before, row):
                found.by_word += 1
            elif self._is_home(before):
                found.at_home += 1
            else:
                self._judge_by_number(row, found)
        return found

    def rows_away(self) -> Ints | None:
        """Return the rows home along the spindle, and those before which a word retracts the tool; None: neither."""
        if self._safe_height is None and not len(self._retracts):
            return None
        return distinct(np.concatenate((np.array(sorted(self._homes), np.int64), self._retracts)))

    def stands_away(self, place: int) -> bool:
        """Whether the tool is away from the part at an event, as far as the program shows it."""
        if self._safe_height is None and not len(self._retracts):
            return True
        before = self._run.events[place].before_row - 1
        while (
            before >= 0 and not self._is_home(before) and only_positions_rotary_axes(self._run, np.array([before]))[0]
        ):
            before -= 1
        if before < 0 or self._is_home(before):
            return True
        last = next((event for event in reversed(self._run.events[:place]) if event.kind == "retract"), None)
        return last is not None and last.before_row >= before + (not self._run.state.machine_frame[before])

    def _is_retracted(self, before: int, row: int) -> bool:
        """Whether a word has retracted the tool between two rows; if that word is a motion, it is ``before``."""
        first = before if self._run.state.machine_frame[before] else before + 1
        begin, end = np.searchsorted(self._retracts, (first, row + 1))
        return bool(end > begin)

    def _is_home(self, row: int) -> bool:
        """Whether a row leads to the height to which this program retracts, or above, in machine coordinates."""
        return row in self._homes

    def _rows_home(self) -> set[int]:
        """Return the rows in machine coordinates that lead to that height or above."""
        rows = self._with_known_height(self._run.state.machine_frame.rows_with(True))
        if self._safe_height is None or not len(rows):
            return set()
        return set(
            rows[self._height(rows) >= self._safe_height - home_tolerance(self._run, rows)[:, self._along]].tolist()
        )

    def _height_of_retract(self) -> float | None:
        """Return the height of home, along the spindle; the highest machine position of a program that never goes
        there.
        """
        rows = self._with_known_height(self._frame)
        if not len(rows):
            return None
        heights = self._height(rows)
        home = self._outward * float(self._machine.home[self._along])
        goes_home = bool((np.abs(heights - home) <= home_tolerance(self._run, rows)[:, self._along]).any())
        return home if goes_home else float(heights.max())

    def _with_known_height(self, rows: Ints) -> Ints:
        """Those of rows whose slide along the spindle stands where machine coordinates have put it, (k,)."""
        return np.asarray(rows[self._machine_positions.at(rows)[:, self._along]])

    def _height(self, rows: Ints) -> Floats:
        """How far out the slide along the spindle is at the end of rows, (k,) mm."""
        return np.asarray(self._outward * self._run.positions(rows).joints[:, self._along])

    # By a number

    def _judge_by_number(self, row: int, found: RotaryMovesAtPart) -> None:
        """Judge a turn by the distance between the tool and the turned part."""
        poses = self._run.positions(np.array([row - 1, row])).joints
        distance = self._distance(row, poses[0], poses[1])
        if distance is not None and distance >= SAFE_DISTANCE:
            found.distances.append(distance)
            return
        cure = self._cure(distance)
        said = Wording("turns", "at_part", cure=cure)
        if distance is not None:
            said = Wording("turns", "near_part", distance=distance, least=SAFE_DISTANCE, cure=cure)
        found.places.append(self._context.place(row, distance or 0.0, said))

    def _distance(self, row: int, before: Floats, after: Floats) -> float | None:
        """Distance of the tool from the part that a row turns, mm; None if it is not known where the part turns to."""
        machine, slides = self._run.machine_at(row), list(self._machine.linear)
        if (np.abs(after[slides] - before[slides]) > STILL).any() or not self._knows_the_turn(row, before, after):
            return None
        if not self._part_is_known:
            self._part, self._part_is_known = cut_extent(self._run), True
        if self._part is None:
            return None
        return turn_clearance(machine, before, after, self._part)

    def _knows_the_turn(self, row: int, before: Floats, after: Floats) -> bool:
        """Whether it is known where the part, or the head, turns to, and how high the tip is."""
        machine = self._run.machine_at(row)
        moved = [k for k in machine.rotary if abs(after[k] - before[k]) > STILL]
        if machine.tool_length is None:
            if any(machine.axes[k].mount is Mount.TOOL for k in moved):
                return False  # the tip swings by a length that is not known
            if self._machine_positions.at(np.array([row - 1]))[0, self._along]:
                return False  # the tip is below a position of the machine by a length that is not known
        if machine.workpiece_zero is not None:
            return True
        return not len(self._frame) and turns_part_alone(machine, before, after, STILL)

    def _cure(self, distance: float | None) -> Wording:
        """Return what to do about a turn at the part."""
        cure = Wording("turns", "go_home", axis=self._machine.axes[self._along].name)
        if len(self._retracts) and not len(self._frame):
            cure = Wording("turns", "retract")
        unplaced = distance is None and self._machine.workpiece_zero is None
        return Wording("turns", "or_say_zero", cure=cure) if unplaced else cure


def _positioning_rows(run: Run) -> Ints:
    """Rows that position rotary axes at rapid with TCP off: alone, or in machine coordinates."""
    found = [np.zeros(0, np.int64)]
    for start, end in chunk_bounds(len(run)):
        names_rotary = (run.programmed[start:end] & int(ROTARY_WORDS)) != 0
        in_frame = run.state.machine_frame.part(start, end) & names_rotary & ~run.state.tcp.part(start, end)
        found.append(start + np.flatnonzero(rotary_positioning_flags(run, start, end) | in_frame))
    return np.concatenate(found)
