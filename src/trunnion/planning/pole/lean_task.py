"""What the modules of this folder hand to each other: the task, the regions in which it is solved, and the result."""

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.machines import KinematicParameters, Machine, kinematic_parameters
from trunnion.model.toolpath import Moves, Operation
from trunnion.planning.poses.selection import PlannedPoses
from trunnion.planning.poses.states import REWIND_STEP
from trunnion.planning.rotary_positions import tool_axes
from trunnion.planning.speed.rotary_speed import max_rotary_steps
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class LeanTask:
    """An operation whose tool axis may lean.

    max_step           (n, 2) float64  how far each rotary axis can turn in a row at its feed, degrees
    unbound            (n,) bool       rows whose duration no feed fixes, such as rapids
    fixed              (n,) bool       rows whose tool axis stays
    angle              the most that the tool axis may lean, degrees
    keep_slide_limits  limits of slides count
    """

    machine: Machine
    kinematics: KinematicParameters
    moves: Moves
    max_step: Floats
    unbound: Flags
    fixed: Flags
    angle: float
    keep_slide_limits: bool

    @staticmethod
    def of(machine: Machine, operation: Operation, fixed: Flags, angle: float, keep_slide_limits: bool) -> "LeanTask":
        """Return the task for an operation in the program's coordinate system; fields as in the class."""
        max_step, unbound = max_rotary_steps(machine, operation)
        kinematics = kinematic_parameters(machine)
        return LeanTask(machine, kinematics, operation.moves, max_step, unbound, fixed, angle, keep_slide_limits)

    def exceeds_speed(self, continuous: Floats, state: Codes, share: float = 1.0) -> Flags:
        """(n,) bool: rows in which an axis would turn farther than it can; ``max_step`` counts as a ``share`` of that.

        continuous  (n, 2) float64: rotary positions as they wind, degrees
        state       (n,) uint8: as in ``PlannedPoses``: rewinds are left out
        """
        step = np.abs(np.diff(continuous, axis=0, prepend=continuous[:1]))
        too_far = (step > self.max_step / share + 1e-9).any(axis=1)
        return np.asarray(too_far & ~self.unbound & (state & REWIND_STEP == 0))


@dataclass(frozen=True, slots=True)
class PoleRegion:
    """Rows ``first`` to ``end`` (exclusive) near the pole that were looked after.

    lean       the most that the tool axis leans there, degrees
    is_solved  the rotary axes keep within their speed, if that was the aim
    """

    first: int
    end: int
    lean: float
    is_solved: bool


@dataclass(frozen=True, slots=True, eq=False)
class LeanedMoves:
    """An operation whose tool axis leans near the pole.

    moves  with the tool axes that the machine will have
    rows   (k,) int64    ascending rows whose rotary positions are not those of the CAM's tool axis
    lean   (k,) float64  by how much the tool axis leans there, degrees
    """

    moves: Moves
    poses: PlannedPoses
    rows: Ints
    lean: Floats
    regions: tuple[PoleRegion, ...]


def axis_deviation(machine: Machine, rotary: Floats, axis: Floats) -> Floats:
    """(n,) float64: degrees between the tool axes at rotary positions (n, 2) and other tool axes (n, 3)."""
    chord = np.linalg.norm(tool_axes(machine, rotary) - axis, axis=1)
    return np.asarray(np.degrees(2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))))
