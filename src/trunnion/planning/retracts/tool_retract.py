"""A retract along the tool axis at the end of a motion, before templates lead the tool home along a machine axis.

Where a head tilts the tool, the way home is not the way out of the part.
"""

from dataclasses import replace

import numpy as np

from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import CutterComp, CycleOff, CycleOn, Kind, Moves, Phase


def with_tool_retract(motion: Motion, distance: float) -> Motion:
    """Return a motion that ends with a rapid of ``distance`` mm along its tool axis.

    A three-axis motion stays as it is, for its way home is along the tool; so does one that ends with a hole, from
    which the cycle has retracted the tool, and one with radius compensation. Events at the end come after the retract.
    """
    operation = motion.operation
    # A cycle that is switched off after the last row has made its hole there.
    before_end = (event for event in operation.events if event.row < len(operation.moves))
    cycles = [event for event in before_end if isinstance(event, CycleOn | CycleOff)]
    in_cycle = motion.ends_in_hole or (bool(cycles) and isinstance(cycles[-1], CycleOn))
    compensated = any(isinstance(event, CutterComp) for event in operation.events)
    if motion.mode is MachiningMode.THREE_AXIS or in_cycle or compensated or not len(operation.moves):
        return motion
    return with_row_along_tool(motion, distance)


def with_row_along_tool(motion: Motion, distance: float) -> Motion:
    """Return a motion that ends with a rapid of ``distance`` mm along its tool axis, before its events at the end."""
    operation = motion.operation
    moves, rows = operation.moves, len(operation.moves)
    last = Moves(
        moves.tip[-1:] + distance * moves.axis[-1:],
        moves.axis[-1:],
        np.array([Kind.RAPID], np.uint8),
        np.array([Phase.RETRACT], np.uint8),
        moves.feed[-1:],
        moves.per_rev[-1:],
        moves.line[-1:],
        None if moves.normal is None else np.full((1, 3), np.nan),
    )
    events = tuple(replace(event, row=rows + 1) if event.row == rows else event for event in operation.events)
    return replace(
        motion,
        operation=replace(operation, moves=_joined(moves, last), events=events),
        rotary=np.concatenate((motion.rotary, motion.rotary[-1:])),
        cl_rows=None if motion.cl_rows is None else np.append(motion.cl_rows, -1),
    )


def _joined(first: Moves, second: Moves) -> Moves:
    """Return the rows of both."""
    normal = None if first.normal is None or second.normal is None else np.concatenate((first.normal, second.normal))
    return Moves(
        np.concatenate((first.tip, second.tip)),
        np.concatenate((first.axis, second.axis)),
        np.concatenate((first.kind, second.kind)),
        np.concatenate((first.phase, second.phase)),
        np.concatenate((first.feed, second.feed)),
        np.concatenate((first.per_rev, second.per_rev)),
        np.concatenate((first.line, second.line)),
        normal,
    )
