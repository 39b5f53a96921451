"""Radius compensation in a plane that is not across the tool: it would offset the path along the tool axis too."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.model.run import CHUNK_ROWS
from trunnion.verification.context import Context
from trunnion.verification.results import Place

#: The tool axis may be off the normal of the plane by so much, degrees: more than the rounding of printed angles.
_ASKEW: Final = 0.05


def compensated_askew(context: Context) -> Iterator[Place]:
    """Yield the first motion under compensation whose tool axis is not perpendicular to the plane of compensation."""
    run = context.run
    if not len(run.compensation_planes):
        return
    on = np.flatnonzero(run.compensation != 0)
    on = on[(run.state.compensation_plane.at(on) >= 0) & ~run.state.machine_frame.at(on)]
    for first in range(0, len(on), CHUNK_ROWS):
        rows = on[first : first + CHUNK_ROWS]
        normal = run.compensation_planes[run.state.compensation_plane.at(rows)]
        along = np.abs(np.einsum("ij,ij->i", run.positions(rows).axis, normal))
        angle = np.degrees(np.arccos(np.minimum(along, 1.0)))
        askew = np.flatnonzero(angle > _ASKEW)
        if len(askew):
            worst = float(angle[askew[0]])
            text = f"radius compensation in a plane to which the tool is not perpendicular, by {worst:.2f} degrees"
            yield context.place(int(rows[askew[0]]), worst, f"{text}: it offsets the path along the tool as well")
            return
