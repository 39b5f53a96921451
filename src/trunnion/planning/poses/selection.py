"""The choice of axis positions for a whole operation at once.

It is the optimum of ``trunnion.planning.poses.optimizer`` over the states and costs of
``trunnion.planning.poses.states``.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Codes, Floats, Ints
from trunnion.concurrency import prefetch
from trunnion.machines import KinematicParameters, Machine, kinematic_parameters
from trunnion.model.toolpath import Kind, Moves, Phase
from trunnion.planning.axis_limits import limits_of
from trunnion.planning.poses.optimizer import (
    CUTS,
    MAY_TOUCH,
    NO_CONTACT,
    find_cheapest,
    find_nearest,
    trace_back,
    workspace,
)
from trunnion.planning.poses.placement import BRANCH, follow_nearest, place_rows, solve_rotary
from trunnion.planning.poses.states import STATE_BITS, SearchSpace, States, states_of


@dataclass(frozen=True, slots=True)
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


#: Changes that are kept one by one.
_NAMED: Final = 50

#: Rows per chunk: half a megabyte, and long enough in milliseconds that two threads seldom wait for each other.
_CHUNK: Final = 16384

#: Axes are parallel, or at right angles, within this sine.
_PARALLEL_SINE: Final = 1e-12


def contact_of(moves: Moves, rows: slice = slice(None)) -> Codes:
    """(n,) uint8: whether the move into a row touches the part: NO_CONTACT, MAY_TOUCH or CUTS."""
    code = np.full(len(Phase), MAY_TOUCH, np.uint8)
    code[[Phase.RAPID, Phase.APPROACH, Phase.DEPARTURE, Phase.TRAVERSE]] = NO_CONTACT
    code[Phase.CUT] = CUTS
    return np.where(moves.kind[rows] == Kind.RAPID, np.uint8(NO_CONTACT), code[moves.phase[rows]])


def search_space_of(
    machine: Machine, kinematics: KinematicParameters, states: States, keep_slide_limits: bool
) -> SearchSpace:
    """The search space of a machine; limits of slides count only with ``keep_slide_limits``."""
    low, high = limits_of(machine, keep_slide_limits)
    slides = list(machine.linear)
    has_slide_limits = bool(np.isfinite(low[slides]).any() or np.isfinite(high[slides]).any())
    first, second = (machine.axes[column] for column in machine.rotary)
    start, sign = (first.home, second.home), (first.preferred_sign, second.preferred_sign)
    second_angle_sum = -2.0 * math.degrees(math.atan2(kinematics.phase[1], kinematics.phase[0]))
    return SearchSpace(
        tuple(low.tolist()), tuple(high.tolist()), has_slide_limits, states.turn_ranges, start, sign, second_angle_sum
    )


def choose_states(machine: Machine, moves: Moves, keep_slide_limits: bool) -> Codes:
    """(n,) uint8: the cheapest state of each row, with the bits of ``trunnion.planning.poses.optimizer``.

    The definition says which branch is preferred, or else it is the one in which most cuts begin when none is. If all
    begin in one branch, preferring it changes nothing.
    """
    state = cheapest_states(machine, moves, keep_slide_limits)
    contact = contact_of(moves)
    starts = np.flatnonzero((contact != NO_CONTACT) & (np.append(NO_CONTACT, contact[:-1]) == NO_CONTACT))
    branches = states_of(machine).table[state[starts] & STATE_BITS, 0]
    if any(a.preferred_sign for a in machine.axes) or not len(starts) or branches.min() == branches.max():
        return state
    ones = int(branches.sum())
    is_tie = 2 * ones == len(branches)
    return cheapest_states(
        machine, moves, keep_slide_limits, prefer=int(branches[0] if is_tie else 2 * ones > len(branches))
    )


def cheapest_states(machine: Machine, moves: Moves, keep_slide_limits: bool, prefer: int = -1) -> Codes:
    """(n,) uint8: the cheapest states if branch ``prefer`` is preferred; -1: none."""
    states, kinematics = states_of(machine), kinematic_parameters(machine)
    space = search_space_of(machine, kinematics, states, keep_slide_limits)
    backpointers = np.empty((len(moves), len(states)), np.uint8)
    state = np.empty(len(moves), np.uint8)
    work = workspace(len(states))
    end = find_cheapest(
        kinematics, space, states.table, moves.tip, moves.axis, contact_of(moves), prefer, backpointers, *work
    )
    trace_back(backpointers, end, state)
    return state


def choose_nearest_states(machine: Machine, moves: Moves, keep_slide_limits: bool) -> Codes:
    """As ``choose_states``, but from row to row the nearest state, without regard to what follows: for comparison."""
    states, kinematics = states_of(machine), kinematic_parameters(machine)
    backpointers = np.empty((len(moves), len(states)), np.uint8)
    state = np.empty(len(moves), np.uint8)
    space = search_space_of(machine, kinematics, states, keep_slide_limits)
    end = find_nearest(kinematics, space, states.table, moves.tip, moves.axis, backpointers, *workspace(len(states)))
    trace_back(backpointers, end, state)
    return state


def choose_poses(machine: Machine, moves: Moves, keep_slide_limits: bool) -> PlannedPoses:
    """Choose the cheapest poses, from the home position of the rotary axes on.

    Parameters
    ----------
    machine
        Its limits are checked; those of the slides only with ``keep_slide_limits``.
    moves
        In the workpiece frame.
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
    if any(axis.preferred_sign for axis in machine.axes) or not branches_travel_alike(machine):
        return None
    kinematics, poses = kinematic_parameters(machine), _empty(np.empty(len(moves), np.uint8))
    space, display_low = (
        search_space_of(machine, kinematics, states_of(machine), keep_slide_limits),
        _display_low(machine),
    )
    progress = np.array([*space.start, math.remainder(space.start[0], 360.0), 0.0, 1.0, 0.0])
    buffers, joints = np.empty((2, min(_CHUNK, len(moves)), 7)), np.empty(5)

    def solve(first: int) -> tuple[int, int, Floats]:
        axis, branch = moves.axis[first : first + _CHUNK], int(progress[BRANCH])
        solutions = buffers[first // _CHUNK % 2, : len(axis)]
        solve_rotary(kinematics, axis, branch, solutions)
        return first, branch, solutions

    for first, branch, solutions in prefetch(solve, range(0, len(moves), _CHUNK)):
        if not follow_nearest(
            kinematics, space, display_low, first, moves.tip, moves.axis, solutions, branch, progress,
            poses.state, poses.rotary, poses.outcome, poses.beyond_value, poses.extremes, poses.extreme_rows,
            poses.changes, joints,
        ):  # fmt: skip
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
    """The poses for states (n,) uint8 of ``choose_states``."""
    states, kinematics = states_of(machine), kinematic_parameters(machine)
    space = search_space_of(machine, kinematics, states, keep_slide_limits)
    poses = _empty(state)
    place_rows(
        kinematics, space, states.table, _display_low(machine), moves.tip, moves.axis, state,
        poses.rotary, poses.outcome, poses.beyond_value, poses.extremes, poses.extreme_rows, poses.changes,
    )  # fmt: skip
    return poses


def _empty(state: Codes) -> PlannedPoses:
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


def _display_low(machine: Machine) -> Floats:
    """(5,) float64: lower end of the 360 degrees that each axis displays; NaN if it displays its turns."""
    return np.array([axis.display_low for axis in machine.axes])
