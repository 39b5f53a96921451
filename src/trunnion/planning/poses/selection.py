"""Which of the possible axis positions the machine takes, for a whole operation at once.

The choice is the optimum of ``trunnion.planning.poses.optimizer`` over the states and costs of
``trunnion.planning.poses.states``.
"""

import math
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
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
from trunnion.planning.poses.states import LIMIT_TOLERANCE, STATE_BITS, SearchSpace, States, states_of


@dataclass(frozen=True, slots=True)
class PlannedPoses:
    """What ``follow`` found.

    rotary    (n, 2) float64  positions of the rotary axes as they display them, degrees
    state     (n,) uint8      the state of each row, with the bit REWOUND where the step into it is a rewind
    outcome   (n,) uint8      as listed in ``trunnion.planning.poses.placement``
    beyond_value    (n,) float64    where an axis is beyond its limit: its value, mm or degrees; not written elsewhere
    extremes  (5, 2) float64  least and greatest value of every axis, mm or degrees
    extreme_rows     (5, 2) int64    the rows where they are
    changes   (k,) int64      how many rows change the branch or turn an axis by more than ``POLE_JUMP``; the last of
                              them; the first k - 2 of them
    """

    rotary: Floats
    state: Codes
    outcome: Codes
    beyond_value: Floats
    extremes: Floats
    extreme_rows: Ints
    changes: Ints


#: Changes that are kept one by one.
_NAMED = 50

#: Rows that are planned at a time: half a megabyte, and milliseconds enough that two threads seldom meet.
_CHUNK = 16384

#: Axes at right angles, or parallel, within this sine.
_PARALLEL_SINE = 1e-12


def contact_of(moves: Moves, rows: slice = slice(None)) -> Codes:
    """(n,) uint8: IDLE where the move into a row does not touch the part, TOUCHES where it may, CUTS where it cuts."""
    code = np.full(len(Phase), MAY_TOUCH, np.uint8)
    code[[Phase.RAPID, Phase.APPROACH, Phase.DEPARTURE, Phase.TRAVERSE]] = NO_CONTACT
    code[Phase.CUT] = CUTS
    return np.where(moves.kind[rows] == Kind.RAPID, np.uint8(NO_CONTACT), code[moves.phase[rows]])


def search_space_of(
    machine: Machine, kinematics: KinematicParameters, states: States, keep_slide_limits: bool
) -> SearchSpace:
    """What there is to choose from on a machine; limits of slides count only with ``keep_slide_limits``."""
    low, high = limits_of(machine, keep_slide_limits)
    slides = list(machine.linear)
    kept = bool(np.isfinite(low[slides]).any() or np.isfinite(high[slides]).any())
    first, second = (machine.axes[column] for column in machine.rotary)
    start, side = (first.home, second.home), (first.preferred_sign, second.preferred_sign)
    second_angle_sum = -2.0 * math.degrees(math.atan2(kinematics.phase[1], kinematics.phase[0]))
    return SearchSpace(
        tuple(low.tolist()), tuple(high.tolist()), kept, states.turn_ranges, start, side, second_angle_sum
    )


def choose_states(machine: Machine, moves: Moves, keep_slide_limits: bool) -> Codes:
    """(n,) uint8: the state of each row that costs least, with the bits of ``trunnion.planning.poses.optimizer``.

    The preferred side is the definition's, or else the one on which most cutting stretches begin when none is
    preferred. Where all begin on one side, preferring it changes nothing.
    """
    state = cheapest_states(machine, moves, keep_slide_limits)
    cuts = contact_of(moves)
    begins = np.flatnonzero((cuts != NO_CONTACT) & (np.append(NO_CONTACT, cuts[:-1]) == NO_CONTACT))
    sides = states_of(machine).table[state[begins] & STATE_BITS, 0]
    if any(a.preferred_sign for a in machine.axes) or not len(begins) or sides.min() == sides.max():
        return state
    ones = int(sides.sum())
    often = int(sides[0]) if 2 * ones == len(sides) else int(2 * ones > len(sides))
    return cheapest_states(machine, moves, keep_slide_limits, often)


def cheapest_states(machine: Machine, moves: Moves, keep_slide_limits: bool, prefer: int = -1) -> Codes:
    """(n,) uint8: the states that cost least when branch ``prefer`` is preferred; -1: none."""
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
    """As ``choose_states``, but from row to row the nearest state whatever comes after: something to compare with."""
    states, kinematics = states_of(machine), kinematic_parameters(machine)
    backpointers = np.empty((len(moves), len(states)), np.uint8)
    state = np.empty(len(moves), np.uint8)
    space = search_space_of(machine, kinematics, states, keep_slide_limits)
    end = find_nearest(kinematics, space, states.table, moves.tip, moves.axis, backpointers, *workspace(len(states)))
    trace_back(backpointers, end, state)
    return state


def choose_poses(machine: Machine, moves: Moves, keep_slide_limits: bool) -> PlannedPoses:
    """Axis positions for every row in the states that cost least, from the home position of the rotary axes on.

    Parameters
    ----------
    machine
        Its limits are judged; those of the slides only with ``keep_slide_limits``.
    moves
        In the workpiece frame.
    """
    return choose_poses_in_one_pass(machine, moves, keep_slide_limits) or poses_of_states(
        machine, moves, choose_states(machine, moves, keep_slide_limits), keep_slide_limits
    )


def choose_poses_in_one_pass(machine: Machine, moves: Moves, keep_slide_limits: bool) -> PlannedPoses | None:
    """As ``follow``, in a single pass; None if there is anything to choose.

    Where both sides of a machine travel the same in a cut, the optimum is the nearest neighbour's choice if that needs
    no rewind, keeps its side and no side is preferred by the definition. Any other way has no less travel to its start,
    and as much on its side. For each row where it leaves that side the nearest neighbour found the travel no shorter; a
    return saves at most 180 degrees, and nothing if the side that it leaves is open, and costs ``BRANCH_CHANGE_COST``
    unless that side is open and the pole near. In the cut all other changes are rewinds. So every change makes it
    dearer.
    """
    if any(axis.preferred_sign for axis in machine.axes) or not branches_travel_alike(machine):
        return None
    kinematics, poses = kinematic_parameters(machine), _empty(np.empty(len(moves), np.uint8))
    space, display_low = (
        search_space_of(machine, kinematics, states_of(machine), keep_slide_limits),
        _display_low(machine),
    )
    progress = np.array([*space.start, math.remainder(space.start[0], 360.0), 0.0, 1.0, 0.0])
    room, joints = np.empty((2, min(_CHUNK, len(moves)), 7)), np.empty(5)

    def leaning(first: int) -> tuple[int, int, Floats]:
        axis, side = moves.axis[first : first + _CHUNK], int(progress[BRANCH])
        solutions = room[first // _CHUNK % 2, : len(axis)]
        solve_rotary(kinematics, axis, side, solutions)
        return first, side, solutions

    for first, side, solutions in prefetch(leaning, range(0, len(moves), _CHUNK)):
        if not follow_nearest(
            kinematics, space, display_low, first, moves.tip, moves.axis, solutions, side, progress,
            poses.state, poses.rotary, poses.outcome, poses.beyond_value, poses.extremes, poses.extreme_rows,
            poses.changes, joints,
        ):  # fmt: skip
            return None
    return poses


def branches_travel_alike(machine: Machine) -> bool:
    """Whether both branches always travel the same: the rotary axes at right angles, the spindle along the first one.

    Then the first angle of one branch is half a turn on from that of the other one, and the second one its negative.
    """
    first, second = (np.array(machine.axes[column].direction) for column in machine.rotary)
    across = np.linalg.norm(np.cross(first, machine.spindle_direction))
    return bool(abs(float(first @ second)) < _PARALLEL_SINE and across < _PARALLEL_SINE)


def poses_of_states(machine: Machine, moves: Moves, state: Codes, keep_slide_limits: bool) -> PlannedPoses:
    """Axis positions as ``follow`` gives them, for states (n,) uint8 of ``choose_states``."""
    states, kinematics = states_of(machine), kinematic_parameters(machine)
    space = search_space_of(machine, kinematics, states, keep_slide_limits)
    poses = _empty(state)
    place_rows(
        kinematics, space, states.table, _display_low(machine), moves.tip, moves.axis, state,
        poses.rotary, poses.outcome, poses.beyond_value, poses.extremes, poses.extreme_rows, poses.changes,
    )  # fmt: skip
    return poses


def _empty(state: Codes) -> PlannedPoses:
    """Columns to be filled, for these states."""
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
    """(5,) lower end of the 360 degrees that each axis displays, NaN: as it is."""
    return np.array([axis.display_low for axis in machine.axes])


def exceeds_travel(machine: Machine, extremes: Floats) -> Flags:
    """(5,) bool: the slide needs more room than its whole travel has, wherever the workpiece may sit."""
    span = extremes[:, 1] - extremes[:, 0]
    travel = np.array([a.high - a.low for a in machine.axes])
    slides = np.zeros(5, bool)
    slides[list(machine.linear)] = True
    return np.asarray(slides & (span > travel + LIMIT_TOLERANCE))
