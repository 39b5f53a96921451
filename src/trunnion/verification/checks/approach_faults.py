"""Ways from home that lead through the part.

In:     a program whose workpiece zero and tool length are known, on a machine whose head tilts the tool.
Out:    places of rapids that pass through what the program cuts, although they neither begin nor end there.

X and Y of a tilted plane lead along the table only where the table tilts the part. Where the head tilts the tool, the
same words may lead below the part, and the next one up through it.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints, distinct
from trunnion.machines import Mount
from trunnion.messages import Wording
from trunnion.model.run import ProgrammedWord, Run
from trunnion.verification.context import Context
from trunnion.verification.kinematics.cut_extent import cut_extent
from trunnion.verification.kinematics.positioning_moves import approach_rows
from trunnion.verification.results import Place

#: Smaller angles are none, degrees.
_STILL: Final = 1e-3

#: Places on a rapid that are looked at.
_PLACES: Final = 257


def approaches_through_part(context: Context) -> Iterator[Place]:
    """Yield both legs by X and Y of the plane, and then along the tool, that pass through the box around all cuts."""
    run, machine = context.run, context.run.machine
    known = machine.workpiece_zero is not None and machine.tool_length is not None
    rows = approach_rows(run) if known and machine.has_rotary_head else np.zeros(0, np.int64)
    rows = rows[_tilts_tool(run, rows) & ((run.programmed[rows] & int(ProgrammedWord.Z)) == 0)]
    part = cut_extent(run) if len(rows) else None
    if part is None:
        return
    shares = np.linspace(0.0, 1.0, _PLACES)[:, None]
    for row in distinct(np.concatenate((rows, rows + 1))).tolist():
        start, end = run.positions(np.array([row - 1, row])).tip
        inside = ((start + shares * (end - start) > part.low) & (start + shares * (end - start) < part.high)).all(
            axis=1
        )
        if inside.any() and not inside[0] and not inside[-1]:
            yield context.place(row, 0.0, Wording("modal", "through_part"))


def _tilts_tool(run: Run, rows: Ints) -> Flags:
    """In which rows a head has turned the tool, (k,) bool."""
    columns = [k for k, column in enumerate(run.machine.rotary) if run.machine.axes[column].mount is Mount.TOOL]
    return np.asarray((np.abs(run.rotary[rows][:, columns]) > _STILL).any(axis=1))
