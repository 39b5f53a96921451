"""The choice of axis positions for a whole operation at once.

It is the optimum of ``trunnion.planning.poses.optimizer`` over the states and costs of
``trunnion.planning.poses.states``.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.concurrency import prefetch
from trunnion.machines import Machine, kinematic_parameters
from trunnion.model.toolpath import Moves
from trunnion.planning.poses.contact import NO_CONTACT, contact_of
from trunnion.planning.poses.nearest_path import BRANCH, SOLUTION_COLUMNS, follow_nearest, solve_rotary
from trunnion.planning.poses.optimizer import find_cheapest, find_nearest, trace_back
from trunnion.planning.poses.placement import PoseColumns, place_rows
from trunnion.planning.poses.search_rows import workspace
from trunnion.planning.poses.search_space import search_space_of
from trunnion.planning.poses.states import STATE_BITS, states_of
from trunnion.records import dataclass

#: Changes that are kept one by one.
_NAMED: Final = 50

#: Rows per chunk: half a megabyte, and long enough in milliseconds that two threads seldom wait for each other.
_CHUNK: Final = 16384

#: Axes are parallel, or at right angles, within this sine.
_PARALLEL_SINE: Final = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class PlannedPoses:
    """The poses of an operation, row by row.

    rotary        (n, 2) float64  displayed positions of the rotary axes, degrees
    state         (n,) uint8      state of each row, with the bit REWIND_STEP if the step into it is a rewind
    outcome       (n,) uint8      as listed in ``trunnion.planning.poses.placement``
    beyond_value  (n,) float64    value of an axis that is beyond its limit, mm or degrees; undefined elsewhere
    extremes      (5, 2) float64  least and greatest value of every axis, mm or degrees
    extreme_rows  (5, 2) int64    rows that have them
    changes       (k,) int64      rows that change the branch or turn an axis by more than ``POLE_JUMP``: how many there
                                  are, the last one, and the first k - 2 of them
    """

    rotary: Floats
    state: Codes
    outcome: Codes
    beyond_value: Floats
    extremes: Floats
    extreme_rows: Ints
    changes: Ints

    @staticmethod
    def empty(state: Codes) -> "PlannedPoses":
        """Columns for kernels to fill."""
        return PlannedPoses(
            rotary=np.empty((len(state), 2)),
            state=state,
            outcome=np.zeros(len(state), np.uint8),
            beyond_value=np.empty(len(state)),
            extremes=np.tile([np.inf, -np.inf], (5, 1)),
            extreme_rows=np.zeros((5, 2), np.int64),
            changes=np.zeros(2 + _NAMED, np.int64),
        )

    @property
    def columns(self) -> PoseColumns:
        """All columns but the state, as kernels take them."""
        return PoseColumns(self.rotary, self.outcome, self.beyond_value, self.extremes, self.extreme_rows, self.changes)


def choose_states(machine: Machine, moves: Moves, keep_slide_limits: bool) -> Codes:
    """(n,) uint8: the cheapest state of each row, with the bits of ``trunnion.planning.poses.optimizer``.

    The definition says which branch is preferred, or else it is the one in which most cuts begin when none is. If all
    begin in one branch, preferring it changes nothing.
    """
    state = cheapest_states(machine, moves, keep_slide_limits)
    contact = contact_of(moves)
    starts = np.flatnonzero((contact != NO_CONTACT) & (np.append(NO_CONTACT, contact[:-1]) == NO_CONTACT))
    branches = states_of(machine).table[state[starts] & STATE_BITS, 0]
    if any(a.preferred_sign for a in machine.own_axes) or not len(starts) or branches.min() == branches.max():
        return state
    ones = int(branches.sum())
    is_tie = 2 * ones == len(branches)
    return cheapest_states(
        machine, moves, keep_slide_limits, prefer=int(branches[0] if is_tie else 2 * ones > len(branches))
    )


def cheapest_states(machine: Machine, moves: Moves, keep_slide_limits: bool, prefer: int = -1) -> Codes:
    """(n,) uint8: the cheapest states if branch ``prefer`` is preferred; -1: none."""
    space, kinematics = search_space_of(machine, keep_slide_limits), kinematic_parameters(machine)
    backpointers, work = np.empty((len(moves), len(space.states)), np.uint8), workspace(len(space.states))
    end = find_cheapest(kinematics, space, moves.tip, moves.axis, contact_of(moves), prefer, backpointers, work)
    return _traced(backpointers, end)


def choose_nearest_states(machine: Machine, moves: Moves, keep_slide_limits: bool) -> Codes:
    """As ``choose_states``, but from row to row the nearest state, without regard to what follows: for comparison."""
    space, kinematics = search_space_of(machine, keep_slide_limits), kinematic_parameters(machine)
    backpointers, work = np.empty((len(moves), len(space.states)), np.uint8), workspace(len(space.states))
    return _traced(backpointers, find_nearest(kinematics, space, moves.tip, moves.axis, backpointers, work))


def _traced(backpointers: Codes, end: int) -> Codes:
    """(n,) uint8: the states of the path that ends in state ``end``."""
    state = np.empty(len(backpointers), np.uint8)
    trace_back(backpointers, end, state)
    return state


def choose_poses(machine: Machine, moves: Moves, keep_slide_limits: bool) -> PlannedPoses:
    """Choose the cheapest poses, from the home position of the rotary axes on.

    machine  its limits are checked; those of the slides only with ``keep_slide_limits``
    moves    in the workpiece frame
    """
    return choose_poses_in_one_pass(machine, moves, keep_slide_limits) or poses_of_states(
        machine, moves, choose_states(machine, moves, keep_slide_limits), keep_slide_limits
    )


def choose_poses_in_one_pass(machine: Machine, moves: Moves, keep_slide_limits: bool) -> PlannedPoses | None:
    """As ``choose_poses``, in a single pass; None if there is anything to choose.

    Suppose that both branches always travel the same, and the definition prefers none. Then the nearest neighbour's
    choice is the optimum if it needs no rewind and keeps its branch. Any other choice has no less travel to its start,
    and as much within a branch. In each row where it leaves the branch, the nearest neighbour found the travel no
    shorter. To return saves at most 180 degrees, and nothing if the branch left is open; it costs
    ``BRANCH_CHANGE_COST`` unless that branch is open and the pole near. In the cut all other changes are rewinds. So
    every change makes the choice more expensive.
    """
    if any(axis.preferred_sign for axis in machine.own_axes) or not branches_travel_alike(machine):
        return None
    kinematics, space = kinematic_parameters(machine), search_space_of(machine, keep_slide_limits)
    poses = PlannedPoses.empty(np.empty(len(moves), np.uint8))
    progress = np.array([*space.start, math.remainder(space.start[0], 360.0), 0.0, 1.0, 0.0])
    buffers, joints = np.empty((2, min(_CHUNK, len(moves)), SOLUTION_COLUMNS)), np.empty(5)

    def solve(first: int) -> tuple[int, int, Floats]:
        axis, branch = moves.axis[first : first + _CHUNK], int(progress[BRANCH])
        solutions = buffers[first // _CHUNK % 2, : len(axis)]
        solve_rotary(kinematics, axis, branch, solutions)
        return first, branch, solutions

    columns = poses.columns
    for first, branch, solutions in prefetch(solve, range(0, len(moves), _CHUNK)):
        if not follow_nearest(
            kinematics, space, first, moves.tip, moves.axis, solutions, branch, progress, poses.state, columns, joints
        ):
            return None
    return poses


def branches_travel_alike(machine: Machine) -> bool:
    """Whether both branches always travel the same: rotary axes at right angles, and the spindle along the first one.

    Then the first angles of both branches are half a turn apart, and the second angles opposite.
    """
    first, second = (np.array(machine.axes[column].direction) for column in machine.rotary)
    across = np.linalg.norm(np.cross(first, machine.spindle_direction))
    return bool(abs(float(first @ second)) < _PARALLEL_SINE and across < _PARALLEL_SINE)


def poses_of_states(machine: Machine, moves: Moves, state: Codes, keep_slide_limits: bool) -> PlannedPoses:
    """Return the poses for states (n,) uint8 of ``choose_states``."""
    kinematics, space = kinematic_parameters(machine), search_space_of(machine, keep_slide_limits)
    poses = PlannedPoses.empty(state)
    place_rows(kinematics, space, moves.tip, moves.axis, state, poses.columns)
    return poses
