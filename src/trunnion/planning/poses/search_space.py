"""The search space: what the choice of poses may move in, as numbers for kernels."""

import math
from typing import Annotated, NamedTuple

import numpy as np

from trunnion.arrays import Ints2
from trunnion.machines import Machine, kinematic_parameters
from trunnion.machines.inverse import FlatArray, Pair
from trunnion.planning.axis_limits import limits_of
from trunnion.planning.poses.states import states_of


class SearchSpace(NamedTuple):
    """States, limits and preferences of the axes. Numbers are in flat tuples, which a kernel keeps in registers.

    states            (s, 3) int64  ``States.table``
    turn_ranges       (4,)          ``States.turn_ranges``
    low, high         (5,)          limits by column, mm or degrees; infinite where none is to be kept
    has_slide_limits                whether a slide has a limit to be kept
    start             (2,)          rotary positions before the first row, degrees
    preferred_sign    (2,)          sign that each rotary axis should have; 0: either
    second_angle_sum                sum of the second angles of both branches, degrees, up to whole turns
    display_low       (5,)          lower end of the 360 degrees that an axis displays; NaN if it displays its turns
    """

    states: Ints2
    turn_ranges: Annotated[tuple[int, ...], 4]
    low: Annotated[FlatArray, 5]
    high: Annotated[FlatArray, 5]
    has_slide_limits: bool
    start: Pair
    preferred_sign: Pair
    second_angle_sum: float
    display_low: Annotated[FlatArray, 5]


def search_space_of(machine: Machine, keep_slide_limits: bool) -> SearchSpace:
    """Return the search space of a machine; limits of slides count only with ``keep_slide_limits``."""
    low, high = limits_of(machine, keep_slide_limits)
    slides = list(machine.linear)
    states, phase = states_of(machine), kinematic_parameters(machine).phase
    first, second = (machine.axes[column] for column in machine.rotary)
    return SearchSpace(
        states=states.table,
        turn_ranges=states.turn_ranges,
        low=tuple(low.tolist()),
        high=tuple(high.tolist()),
        has_slide_limits=bool(np.isfinite(low[slides]).any() or np.isfinite(high[slides]).any()),
        start=(first.home, second.home),
        preferred_sign=(first.preferred_sign, second.preferred_sign),
        second_angle_sum=-2.0 * math.degrees(math.atan2(phase[1], phase[0])),
        display_low=tuple(axis.display_low for axis in machine.axes),
    )
