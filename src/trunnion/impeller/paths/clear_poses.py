"""Whether a whole tool is clear of an impeller at single poses: for the links between passes.

In:     the bodies of an impeller, a ball-ended tool.
Out:    a function of ball centres and tool axes.
Units:  mm.
"""

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.impeller.paths.clearance import SLACK, Margins, Obstacles, distances_of, tool_body
from trunnion.impeller.paths.clearance_kernel import ToolData
from trunnion.impeller.paths.linking import IsClear
from trunnion.simulation.tools.profile import ToolShape

#: Half the length of what stands for the ball's centre, mm.
_POINT = 1e-4


def pose_check(
    obstacles: Obstacles, tool: ToolShape, radius: float, tolerance: float, side_tolerance: float = 0.0
) -> IsClear:
    """Return a function that says of poses whether the ball and all above it are clear.

    radius          of the tool's ball
    tolerance       how far the ball may be in a surface: it touches one where it cuts
    side_tolerance  how far all above the ball may be in a surface: where the side of the tool cuts, it touches one

    Raises ``InputError`` if the tool has no ball of this radius.
    """
    body = tool_body(tool, radius, Margins(0.0, 0.0, 0.0, 1.0)).real
    point = np.array([[0.0, -_POINT], [_POINT, 0.0], [0.0, _POINT]])
    data = ToolData(np.r_[0, len(point) + body.first], np.vstack((point, body.corners)), np.zeros(len(body.wanted) + 1))
    wanted = np.full(len(data.wanted), -side_tolerance)
    wanted[0] = radius - tolerance - SLACK

    def is_clear(centre: Floats, axis: Floats) -> Flags:
        distances = distances_of(
            obstacles, data, np.ascontiguousarray(centre), np.ascontiguousarray(axis), 2.0 * radius
        )
        return np.asarray((distances.min(axis=2) >= wanted).all(axis=1))

    return is_clear
