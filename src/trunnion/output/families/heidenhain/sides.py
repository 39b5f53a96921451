"""Where an operation goes from RL to RR, or back, as a Heidenhain control refuses it."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags
from trunnion.controls.family_writer import UnsupportedFeatureError
from trunnion.messages import Wording
from trunnion.model.toolpath import BlockSkip, CutterComp, Operation

#: A motion no longer than this may be none once it is printed, mm.
_NO_MOTION: Final = 1e-3

_OFF: Final = "OFF"


def sides_at_once(operation: Operation) -> Iterator[tuple[int, UnsupportedFeatureError]]:
    """Yield CUTCOM to the other side without a motion in the plane with R0 between, by lines of the CL file."""
    moves = _moves_in_plane(operation)
    side, left, since, last = _OFF, _OFF, 0, _OFF
    for event in _acting(operation):
        now = last if event.side == "ON" else event.side
        if now == _OFF and side != _OFF:
            left, since = side, event.row
        elif now != _OFF:
            before = left if side == _OFF else side
            if before not in (_OFF, now) and (side != _OFF or not moves[since : event.row].any()):
                wording = Wording("CTL220", "cutcom_changes_side", side=now, before=before)
                yield event.line, UnsupportedFeatureError(wording)
            left, last = _OFF, now
        side = now


def _acting(operation: Operation) -> Iterator[CutterComp]:
    """Yield each CUTCOM that a motion follows before the next one: it acts in that motion."""
    events = [event for event in operation.events if isinstance(event, CutterComp)]
    ends = [*(event.row for event in events[1:]), len(operation.moves)]
    return (event for event, end in zip(events, ends, strict=False) if event.row < end)


def _moves_in_plane(operation: Operation) -> Flags:
    """Return which rows (n,) move across the tool, whether blocks are skipped or not."""
    moves = operation.moves
    steps = np.diff(moves.tip, axis=0, prepend=np.inf)  # from home to the first point everything moves
    steps[:1] = 0.0
    along = np.einsum("ij,ij->i", steps, moves.axis)
    moving: Flags = np.linalg.norm(steps - along[:, None] * moves.axis, axis=1) > _NO_MOTION
    skips = [(event.row, event.on) for event in operation.events if isinstance(event, BlockSkip)]
    for (row, on), (end, _) in zip(skips, [*skips[1:], (len(moves), False)], strict=False):
        moving[row:end] &= not on
    return moving
