"""Columns of a run that have no row for each motion: modal values by their changes, and surface normals."""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints, make_read_only
from trunnion.model.columns import StepColumn
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceNormals:
    """Surface normals that blocks program: ``row`` (k,), ascending, and ``vector`` (k, 3) in the workpiece frame.

    The vectors keep the length that they have in the program.
    """

    row: Ints
    vector: Floats

    def __post_init__(self) -> None:
        make_read_only(self.row, self.vector)

    def __len__(self) -> int:
        return len(self.row)

    @staticmethod
    def empty() -> "SurfaceNormals":
        """Return a table without normals."""
        return SurfaceNormals(np.zeros(0, np.int64), np.zeros((0, 3)))


#: Added to ``ModalState.length_axis`` where a parameter of the control decides.
BY_PARAMETER: Final = 3


@dataclass(frozen=True, slots=True, eq=False)
class ModalState:
    """Values that change seldom, as columns stored by their changes; ``Run`` has whole columns of the same names.

    at_ends     the control places the tip at the ends of blocks alone: axes go straight between them (M114)
    xyz_is_tip  ``Run.xyz`` is the tool tip, not the positions of the linear axes
    plane       the row of ``Run.planes`` in whose coordinates words are; -1: in none of them
    compensation_plane  where radius compensation is on, the row of ``Run.compensation_planes``; -1: across the tool
    compensation_style  how the control compensates, a key of ``compensation.styles.STYLES``; 0: not known
    stated_radius  the radius that the program states for it, mm (G41.1 D of LinuxCNC); NaN: none
    radius      the number by which radius compensation takes the radius (D); -1: it is that of the tool, or of the edge
    machine_steps  in coordinates of the machine: bits of the linear axes that a block moves from where they are (G91)
    feed_path   a ``FeedPath``: the path that F refers to where rotary axes turn without TCP
    length_axis  along which of X, Y and Z the tool length counts where positions are those of the linear axes: 0, 1, 2;
                -1: none; ``BY_PARAMETER`` more: along that one or along Z, as a parameter of the control says
    working_plane  the axis across the working plane that the program has chosen: 0, 1, 2; 2 while it has chosen none
    """

    file: StepColumn
    feed: StepColumn
    feed_mode: StepColumn
    rpm: StepColumn
    spindle: StepColumn
    tool: StepColumn
    edge: StepColumn
    compensation: StepColumn
    radius: StepColumn
    compensation_plane: StepColumn
    compensation_style: StepColumn
    stated_radius: StepColumn
    work_offset: StepColumn
    tcp: StepColumn
    at_ends: StepColumn
    machine_frame: StepColumn
    machine_steps: StepColumn
    inches: StepColumn
    orientation: StepColumn
    xyz_is_tip: StepColumn
    plane: StepColumn
    feed_path: StepColumn
    length_axis: StepColumn
    working_plane: StepColumn

    def follows(self, first: int, end: int) -> Flags:
        """Whether linear axes follow the rotary ones to the tip, with TCP or at the ends of blocks, in consecutive
        rows.
        """
        return np.asarray(self.tcp.part(first, end) | self.at_ends.part(first, end))

    def follows_at(self, rows: Ints) -> Flags:
        """As ``follows`` for rows (k,) in any order."""
        return np.asarray(self.tcp.at(rows) | self.at_ends.at(rows))
