"""How far axes go where a program sends them to positions of the machine: known without any workpiece zero.

In:     a run.
Out:    the positions beyond the travel of their axes, mm or degrees, with their rows.
"""

from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Ints
from trunnion.model.run import CHUNK_ROWS, ProgrammedWord, Run
from trunnion.records import dataclass
from trunnion.verification.kinematics.home_tolerance import home_tolerance
from trunnion.verification.kinematics.machine_positions import MachinePositions

#: Travel beyond a limit by less than this is rounding, mm.
_ROUNDING = 1e-5

_SLIDE_WORDS = int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)


@dataclass(frozen=True, slots=True)
class MachinePosition:
    """An axis that a block sends beyond its travel in machine coordinates.

    column  of the axis in ``Machine.axes``
    value   where it is sent, mm or degrees; limit: the end of the travel that it passes
    row     of the run
    """

    column: int
    value: float
    limit: float
    row: int

    @property
    def beyond(self) -> float:
        """How far it is beyond the limit, mm or degrees."""
        return abs(self.value - self.limit)


def positions_beyond_travel(run: Run) -> Iterator[MachinePosition]:
    """Yield for each end of the travel of an axis the block that goes farthest beyond it, if one does.

    Of slides only those that a block names count: the others stay where nobody may know the machine position. Steps
    (G91) count only where zero and tool length are known. Retracts by a word end at the travel by themselves. Home in
    inches is home (``home_tolerance``).
    """
    rows = run.state.machine_frame.rows_with(True)
    retracts = [event.before_row for event in run.events if event.kind == "retract"]
    rows = rows[~np.isin(rows, retracts)]
    farthest: dict[tuple[int, int], MachinePosition] = {}
    for first in range(0, len(rows), CHUNK_ROWS):
        for found in _beyond(run, rows[first : first + CHUNK_ROWS]):
            key = found.column, int(found.value > found.limit)
            if key not in farthest or found.beyond > farthest[key].beyond:
                farthest[key] = found
    yield from (farthest[key] for key in sorted(farthest))


def unknown_steps(run: Run) -> Ints:
    """Return the rows that move a slide by a step from a machine position that nobody knows, (k,), increasing."""
    if MachinePositions.of(run).known:
        return np.zeros(0, np.int64)
    rows = run.state.machine_frame.rows_with(True)
    return np.asarray(rows[(run.state.machine_steps.at(rows) & run.programmed[rows] & _SLIDE_WORDS) != 0])


def _beyond(run: Run, rows: Ints) -> Iterator[MachinePosition]:
    """Yield the farthest of some rows at each end of each slide."""
    machine = run.machine
    joints, near_home = run.positions(rows).joints, home_tolerance(run, rows)
    known, steps = MachinePositions.of(run).known, run.state.machine_steps.at(rows)
    for column, axis in machine.own_columns:
        values = joints[:, column]
        named = np.ones(len(rows), np.bool_)
        if not axis.is_rotary:
            word = ProgrammedWord[axis.name]
            named = (run.programmed[rows] & int(word)) != 0
            if not known:
                named &= (steps & int(word)) == 0
        named &= np.abs(values - axis.home) > near_home[:, column]
        for limit, sign in ((axis.low, -1.0), (axis.high, 1.0)):
            over = np.where(named, sign * (values - limit), -np.inf)
            at = int(np.argmax(over)) if len(over) else -1
            if at >= 0 and over[at] > _ROUNDING:
                yield MachinePosition(column, float(values[at]), limit, int(rows[at]))
