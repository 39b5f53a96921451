"""First legs of an approach of which nobody knows where the linear axes are.

In:     a run.
Out:    their rows, each with why.

X and Y are positioned first, and Z is still where it was: at a position of the machine. How high above the part that is
follows from the workpiece zero and the tool length. With both the leg is known like every other motion.
"""

from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Ints
from trunnion.messages import Wording, phrase
from trunnion.model.run import Run
from trunnion.model.unknown_setups import rows_without_values
from trunnion.records import dataclass
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.kinematics.positioning_moves import approach_rows


@dataclass(frozen=True, slots=True, eq=False)
class UnknownApproaches:
    """Rows (k,), increasing, and why each of them is not known."""

    rows: Ints
    reasons: tuple[Wording, ...]


def unknown_approaches(run: Run) -> UnknownApproaches:
    """Return the rows of which it is not known where the linear axes are."""
    found = sorted((dict(_unknown(run)) | dict(rows_without_values(run))).items())
    return UnknownApproaches(np.array([row for row, _ in found], np.int64), tuple(why for _, why in found))


def _unknown(run: Run) -> Iterator[tuple[int, Wording]]:
    positions, machine = MachinePositions.of(run), run.machine
    is_placed = positions.known
    missing = phrase("left_height_unknown")
    if machine.workpiece_zero is not None and machine.tool_length is not None:
        # Only another work offset or tool is without its value, and that makes machine positions unknown.
        missing = next((why for _, why in rows_without_values(run)), missing)
    yield from ((row, missing) for row in positions.half_stated(run).tolist())
    frame = run.state.machine_frame.rows_with(True)
    # A retract whose way is known is a motion in machine coordinates.
    retracts = [event.before_row for event in run.events if event.kind == "retract"]
    words = np.array([row for row in retracts if row >= len(run) or not run.state.machine_frame[row]], np.int64)
    for row in approach_rows(run).tolist():
        if not is_placed:
            yield row, missing
            continue
        before = int(np.searchsorted(frame, row))
        last = int(frame[before - 1]) if before else -1
        behind = int(np.searchsorted(words, row, "right"))
        if behind and int(words[behind - 1]) > last:
            yield row, phrase("left_retract_unknown")
        elif last < 0:
            yield row, phrase("left_where_unknown")
