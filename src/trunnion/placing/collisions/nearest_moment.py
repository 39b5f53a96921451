"""The moment of a path at which two hulls come nearest to each other.

Most moments are never looked at. At one of them the hulls are so far apart, and until the bodies have moved as far as
that is beyond the least distance known, they cannot be nearer. Where this leads nowhere, as on ways along a table, a
plane between the hulls settles a whole piece of the way: points of a body go on straight lines there, but for a sag.
"""

from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Flags, Floats, Floats2, Floats3, Ints
from trunnion.jit import inner, kernel
from trunnion.machines.links import LinkChain
from trunnion.simulation.collisions.clearance import write_relative_pose
from trunnion.simulation.collisions.hull_gap import gap_between, plane_gap
from trunnion.simulation.collisions.hull_points import HullPoints

#: What is nearer by less is as near, mm.
CLOSE: Final = 0.01

#: Pieces of the way that are halved so often are done: bodies move no thousandth of a millimetre on them.
_DEEPEST: Final = 24
_NO_WAY: Final = 1e-3


class Course(NamedTuple):
    """How the frame of one body moves in that of another along a path.

    angles, normals, offsets, begins  as in ``PathSamples``
    turn      (m,) radians that both rotary axes turn on the way to each moment
    way       (m,) how far points of the bodies can have moved against each other until then, at one zero, mm
    drift     (m,) how much more for each mm that the zero is away from there
    columns, senses  the joints between the links, as in ``joint_senses``
    axes      (5,) columns of the rotary axes and of the slides
    back      (3, 3) turns the frame of the second body back, as the part was turned
    carried   whether the second body sits on the part's side with the zero
    """

    angles: Floats2
    normals: Floats3
    offsets: Floats2
    begins: Flags
    turn: Floats
    way: Floats
    drift: Floats
    columns: Ints
    senses: Floats
    axes: Ints
    back: Floats2
    carried: bool


@inner
def _pose_at(
    chain: LinkChain, course: Course, zero: Floats, moment: int, share: float, joints: Floats, pose: Floats2
) -> None:
    """Write the map (4, 4) from the frame of the first body to that of the second, on the way to a moment."""
    before = moment if share >= 1.0 else moment - 1
    for k in range(2):
        a, b = course.angles[before, k], course.angles[moment, k]
        joints[course.axes[k]] = a + share * (b - a)
    for k in range(3):
        a, b = course.offsets[before, k], course.offsets[moment, k]
        for j in range(3):
            a += course.normals[before, k, j] * zero[j]
            b += course.normals[moment, k, j] * zero[j]
        joints[course.axes[2 + k]] = a + share * (b - a)
    write_relative_pose(chain, course.columns, course.senses, joints, pose)
    if not course.carried:
        return
    for k in range(3):
        pose[k, 3] -= zero[k]
    for column in range(4):
        x, y, z = pose[0, column], pose[1, column], pose[2, column]
        for k in range(3):
            pose[k, column] = course.back[k, 0] * x + course.back[k, 1] * y + course.back[k, 2] * z


@kernel(writes="pose")
def course_pose(chain: LinkChain, course: Course, zero: Floats, moment: int, share: float, pose: Floats2) -> None:
    """Write the map (4, 4) from the frame of the first body to that of the second, on the way to a moment."""
    _pose_at(chain, course, zero, moment, share, np.zeros(5), pose)


@kernel(writes="direction")
def nearest_moment(
    chain: LinkChain,
    course: Course,
    one: HullPoints,
    other: HullPoints,
    zero: Floats,
    away: float,
    ranges: Ints,
    limit: float,
    exact: bool,
    direction: Floats,
) -> tuple[float, int, float]:
    """Return the least distance of two hulls along a path if it is below ``limit``, mm, its moment and the share of the
    way to it that is done; else the limit and -1. What is found is the least but for ``CLOSE``.

    one, other  points of the hulls, in the frames of their bodies
    zero        (3,) mm, which is ``away`` mm from that of ``course.way``
    ranges      (2,) first and end of the moments that count
    exact       else the first moment at which the hulls may be nearer than the limit is returned, as it is
    direction   (3,) unit vector, a guess of the way from the second hull to the first; that of the result is written
    """
    first, end = ranges[0], ranges[1]
    pose, ahead, middle = np.eye(4), np.eye(4), np.eye(4)
    joints, work, own = np.zeros(5), np.zeros((7, 3)), direction.copy()
    stack = np.empty((2 * _DEEPEST + 4, 2))
    at, share, moment = -1, 1.0, first
    while moment < end and limit > 0.0:
        _pose_at(chain, course, zero, moment, 1.0, joints, pose)
        low = plane_gap(one, other, pose, own)
        if low < limit - CLOSE or not _clears_next(course, moment, end, away, low - limit + CLOSE):
            low, high = gap_between(one, other, pose, own, work)
            if not exact and low < limit - CLOSE:
                return low, moment, 1.0
            if exact and high < limit:
                limit, at, share = high, moment, 1.0
                _copy(own, direction)
        room, after = low - limit + CLOSE, moment + 1
        while after < end and _moved(course, moment, after, away) < room:
            after += 1
        if after - 1 > moment:
            moment = after - 1
            continue
        if after >= end:
            break
        if course.begins[after]:
            moment = after
            continue
        # Nothing is settled by how far bodies move: look at the piece itself, and at halves of it.
        size = _moved(course, moment, after, away)
        sag = 0.375 * course.turn[after] * size
        count = 1
        stack[0, 0], stack[0, 1] = 0.0, 1.0
        while count > 0 and limit > 0.0:
            count -= 1
            begin, finish = stack[count, 0], stack[count, 1]
            part = finish - begin
            if begin > 0.0:
                _pose_at(chain, course, zero, after, begin, joints, pose)
            else:
                _pose_at(chain, course, zero, moment, 1.0, joints, pose)
            _pose_at(chain, course, zero, after, finish, joints, ahead)
            wanted = limit - CLOSE + sag * part * part
            here, there = plane_gap(one, other, pose, own), plane_gap(one, other, ahead, own)
            if min(here, there) >= wanted:
                continue
            low, high = gap_between(one, other, ahead, own, work)
            if not exact and low < limit - CLOSE:
                return low, after, finish
            if exact and high < limit:
                limit, at, share = high, after, finish
                _copy(own, direction)
                wanted = limit - CLOSE + sag * part * part
            if low >= wanted and plane_gap(one, other, pose, own) >= wanted:
                continue
            half = 0.5 * (begin + finish)
            _pose_at(chain, course, zero, after, half, joints, middle)
            low, high = gap_between(one, other, middle, own, work)
            if not exact and low < limit - CLOSE:
                return low, after, half
            if exact and high < limit:
                limit, at, share = high, after, half
                _copy(own, direction)
            if low - 0.5 * size * part >= limit - CLOSE or size * part < _NO_WAY or count + 2 > stack.shape[0]:
                continue
            stack[count, 0], stack[count, 1] = half, finish
            stack[count + 1, 0], stack[count + 1, 1] = begin, half
            count += 2
        moment = after
    return limit, at, share


@inner
def _copy(source: Floats, target: Floats) -> None:
    """Write a vector into another: ``target[:] = source`` takes seconds to compile at each place."""
    for k in range(3):
        target[k] = source[k]


@inner
def _moved(course: Course, moment: int, after: int, away: float) -> float:
    """How far points of the bodies can move between two moments, mm."""
    moved: float = course.way[after] - course.way[moment] + away * (course.drift[after] - course.drift[moment])
    return moved


@inner
def _clears_next(course: Course, moment: int, end: int, away: float, room: float) -> bool:
    """Whether so much room, mm, lasts until the next moment."""
    return moment + 1 >= end or course.begins[moment + 1] or _moved(course, moment, moment + 1, away) < room
