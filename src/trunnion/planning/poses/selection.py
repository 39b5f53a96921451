"""Which of the possible axis positions the machine takes, for a whole operation at once.

The choice is the optimum of ``trunnion.planning.poses.optimizer`` over the states and costs of
``trunnion.planning.poses.states``.
"""

import math
from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Codes, Flags, Floats, Ints
from trunnion.concurrency import one_ahead
from trunnion.machines import Machine, Packed, pack
from trunnion.model.toolpath import Kind, Moves, Phase
from trunnion.planning.poses.optimizer import CUTS, IDLE, TOUCHES, cheapest, nearest, trace, workspace
from trunnion.planning.poses.placement import SIDE, lean, place, straight_on
from trunnion.planning.poses.states import LIMIT_TOLERANCE, STATE, Choice, States, limits_of, states_of


@dataclass(frozen=True, slots=True)
class Poses:
    """What ``follow`` found.

    rotary    (n, 2) float64  positions of the rotary axes as they display them, degrees
    state     (n,) uint8      the state of each row, with the bit REWOUND where the step into it is a rewind
    outcome   (n,) uint8      as listed in ``trunnion.planning.poses.placement``
    beyond    (n,) float64    where an axis is beyond its limit: its value, mm or degrees; not written elsewhere
    extremes  (5, 2) float64  least and greatest value of every axis, mm or degrees
    where     (5, 2) int64    the rows where they are
    changes   (k,) int64      how many rows change the branch or turn an axis by more than ``POLE_JUMP``; the last of
                              them; the first k - 2 of them
    """

    rotary: Floats
    state: Codes
    outcome: Codes
    beyond: Floats
    extremes: Floats
    where: Ints
    changes: Ints


#: Changes that are kept one by one.
_NAMED = 50

#: Rows that are planned at a time: half a megabyte, and milliseconds enough that two threads seldom meet.
_CHUNK = 16384

#: Axes at right angles, or parallel, within this sine.
_SQUARE = 1e-12


def cutting(moves: Moves, rows: slice = slice(None)) -> Codes:
    """(n,) uint8: IDLE where the move into a row does not touch the part, TOUCHES where it may, CUTS where it cuts."""
    code = np.full(len(Phase), TOUCHES, np.uint8)
    code[[Phase.RAPID, Phase.APPROACH, Phase.DEPARTURE, Phase.TRAVERSE]] = IDLE
    code[Phase.CUT] = CUTS
    return np.where(moves.kind[rows] == Kind.RAPID, np.uint8(IDLE), code[moves.phase[rows]])


def choice_of(machine: Machine, packed: Packed, states: States, keep_slides: bool) -> Choice:
    """What there is to choose from on a machine; limits of slides count only with ``keep_slides``."""
    low, high = limits_of(machine, keep_slides)
    slides = list(machine.linear)
    kept = bool(np.isfinite(low[slides]).any() or np.isfinite(high[slides]).any())
    first, second = (machine.axes[column] for column in machine.rotary)
    start, side = (first.home, second.home), (first.preferred_sign, second.preferred_sign)
    both = -2.0 * math.degrees(math.atan2(packed.phase[1], packed.phase[0]))
    return Choice(tuple(low.tolist()), tuple(high.tolist()), kept, states.span, start, side, both)


def choose(machine: Machine, moves: Moves, keep_slides: bool) -> Codes:
    """(n,) uint8: the state of each row that costs least, with the bits of ``trunnion.planning.poses.optimizer``.

    The preferred side is the definition's, or else the one on which most cutting stretches begin when none is
    preferred. Where all begin on one side, preferring it changes nothing.
    """
    state = least_cost(machine, moves, keep_slides)
    cuts = cutting(moves)
    begins = np.flatnonzero((cuts != IDLE) & (np.append(IDLE, cuts[:-1]) == IDLE))
    sides = states_of(machine).table[state[begins] & STATE, 0]
    if any(a.preferred_sign for a in machine.axes) or not len(begins) or sides.min() == sides.max():
        return state
    ones = int(sides.sum())
    often = int(sides[0]) if 2 * ones == len(sides) else int(2 * ones > len(sides))
    return least_cost(machine, moves, keep_slides, often)


def least_cost(machine: Machine, moves: Moves, keep_slides: bool, prefer: int = -1) -> Codes:
    """(n,) uint8: the states that cost least when branch ``prefer`` is preferred; -1: none."""
    states, packed = states_of(machine), pack(machine)
    choice = choice_of(machine, packed, states, keep_slides)
    back = np.empty((len(moves), len(states)), np.uint8)
    state = np.empty(len(moves), np.uint8)
    work = workspace(len(states))
    end = cheapest(packed, choice, states.table, moves.tip, moves.axis, cutting(moves), prefer, back, *work)
    trace(back, end, state)
    return state


def choose_nearest(machine: Machine, moves: Moves, keep_slides: bool) -> Codes:
    """As ``choose``, but from row to row the nearest state whatever comes after: something to compare with."""
    states, packed = states_of(machine), pack(machine)
    back = np.empty((len(moves), len(states)), np.uint8)
    state = np.empty(len(moves), np.uint8)
    choice = choice_of(machine, packed, states, keep_slides)
    end = nearest(packed, choice, states.table, moves.tip, moves.axis, back, *workspace(len(states)))
    trace(back, end, state)
    return state


def follow(machine: Machine, moves: Moves, keep_slides: bool) -> Poses:
    """Axis positions for every row in the states that cost least, from the home position of the rotary axes on.

    Parameters
    ----------
    machine
        Its limits are judged; those of the slides only with ``keep_slides``.
    moves
        In the workpiece frame.
    """
    return settled(machine, moves, keep_slides) or take(
        machine, moves, choose(machine, moves, keep_slides), keep_slides
    )


def settled(machine: Machine, moves: Moves, keep_slides: bool) -> Poses | None:
    """As ``follow``, in a single pass; None if there is anything to choose.

    Where both sides of a machine travel the same in a cut, the optimum is the nearest neighbour's choice if that needs
    no rewind, keeps its side and no side is preferred by the definition. Any other way has no less travel to its start,
    and as much on its side. For each row where it leaves that side the nearest neighbour found the travel no shorter; a
    return saves at most 180 degrees, and nothing if the side that it leaves is open, and costs ``SIDE_CHANGE`` unless
    that side is open and the pole near. In the cut all other changes are rewinds. So every change makes it dearer.
    """
    if any(axis.preferred_sign for axis in machine.axes) or not sides_travel_alike(machine):
        return None
    packed, poses = pack(machine), _empty(np.empty(len(moves), np.uint8))
    choice, display_low = choice_of(machine, packed, states_of(machine), keep_slides), _display_low(machine)
    stand = np.array([*choice.start, math.remainder(choice.start[0], 360.0), 0.0, 1.0, 0.0])
    room, joints = np.empty((2, min(_CHUNK, len(moves)), 7)), np.empty(5)

    def leaning(first: int) -> tuple[int, int, Floats]:
        axis, side = moves.axis[first : first + _CHUNK], int(stand[SIDE])
        tilts = room[first // _CHUNK % 2, : len(axis)]
        lean(packed, axis, side, tilts)
        return first, side, tilts

    for first, side, tilts in one_ahead(leaning, range(0, len(moves), _CHUNK)):
        if not straight_on(
            packed, choice, display_low, first, moves.tip, moves.axis, tilts, side, stand,
            poses.state, poses.rotary, poses.outcome, poses.beyond, poses.extremes, poses.where, poses.changes, joints,
        ):  # fmt: skip
            return None
    return poses


def sides_travel_alike(machine: Machine) -> bool:
    """Whether both branches always travel the same: the rotary axes at right angles, the spindle along the first one.

    Then the first angle of one branch is half a turn on from that of the other one, and the second one its negative.
    """
    first, second = (np.array(machine.axes[column].direction) for column in machine.rotary)
    across = np.linalg.norm(np.cross(first, machine.spindle_direction))
    return bool(abs(float(first @ second)) < _SQUARE and across < _SQUARE)


def take(machine: Machine, moves: Moves, state: Codes, keep_slides: bool) -> Poses:
    """Axis positions as ``follow`` gives them, for states (n,) uint8 of ``choose``."""
    states, packed = states_of(machine), pack(machine)
    choice = choice_of(machine, packed, states, keep_slides)
    poses = _empty(state)
    place(
        packed, choice, states.table, _display_low(machine), moves.tip, moves.axis, state,
        poses.rotary, poses.outcome, poses.beyond, poses.extremes, poses.where, poses.changes,
    )  # fmt: skip
    return poses


def _empty(state: Codes) -> Poses:
    """Columns to be filled, for these states."""
    return Poses(
        rotary=np.empty((len(state), 2)),
        state=state,
        outcome=np.zeros(len(state), np.uint8),
        beyond=np.empty(len(state)),
        extremes=np.tile([np.inf, -np.inf], (5, 1)),
        where=np.zeros((5, 2), np.int64),
        changes=np.zeros(2 + _NAMED, np.int64),
    )


def _display_low(machine: Machine) -> Floats:
    """(5,) lower end of the 360 degrees that each axis displays, NaN: as it is."""
    return np.array([axis.display_low for axis in machine.axes])


def beyond_fit(machine: Machine, extremes: Floats) -> Flags:
    """(5,) bool: the slide needs more room than its whole travel has, wherever the workpiece may sit."""
    span = extremes[:, 1] - extremes[:, 0]
    travel = np.array([a.high - a.low for a in machine.axes])
    slides = np.zeros(5, bool)
    slides[list(machine.linear)] = True
    return np.asarray(slides & (span > travel + LIMIT_TOLERANCE))
