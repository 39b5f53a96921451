"""How fast axes are on arcs: at their ends, and at most, where the way from end to end says little.

In:     rows of a run that are arcs.
Out:    speeds and accelerations of the axes by the share of the arc that is done: its time makes those by time of them.
Units:  mm and degrees.

A full circle ends where it begins, and its axes move all the same. While the rotary axes stand, slides are cosines of
the angle, and their derivatives are known; where rotary axes turn along an arc, both are taken from samples.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, kinematic_parameters
from trunnion.model.arc_extremes import ArcPaths
from trunnion.model.axis_positions import joints_from_rows
from trunnion.model.run import PositionChunk, Run
from trunnion.model.subdivision import arc_frames, circle_points
from trunnion.records import dataclass

#: Places of a turn at which speeds are looked at: between two of them a cosine is 0.998 of its greatest value at least.
_PER_TURN: Final = 48

#: Places at most on an arc along which rotary axes turn; those of long ones are spread by the golden ratio, which
#: repeats no angle.
_MOST_PLACES: Final = 480
_GOLDEN: Final = 0.6180339887498949

#: Share of the way between two places over which differences stand for derivatives.
_STEP: Final = 1e-3

#: Arcs at a time, so that what is computed of them takes little memory.
_AT_A_TIME: Final = 256

#: Rotary axes that turn by less along an arc stand, degrees.
_STANDS: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class ArcSpeeds:
    """Derivatives of axis values by the share of m arcs, mm or degrees.

    rows          (m,)       of the run
    begin, end    (m, 5)     speeds at the ends
    most          (m, 5)     greatest speeds, without sign
    acceleration  (m, 5)     greatest second derivatives, without sign
    """

    rows: Ints
    begin: Floats
    end: Floats
    most: Floats
    acceleration: Floats

    @staticmethod
    def of(run: Run, first: int, end: int, positions: PositionChunk) -> "ArcSpeeds":
        """Return the arcs in rows from ``first`` to the one before ``end``; ``positions`` is the ``Run.chunk``
        of them.
        """
        part = slice(*np.searchsorted(run.arcs.row, [first, end]).tolist())
        rows = run.arcs.row[part]
        found = ArcSpeeds(rows, *np.zeros((4, len(rows), 5)))
        at = rows - first
        paths = ArcPaths.of(run.arcs, part, positions.tip[at], positions.tip[at + 1])
        rotary = positions.joints[:, list(run.machine.rotary)]
        begin, way = rotary[at], rotary[at + 1] - rotary[at]
        with np.errstate(invalid="ignore"):
            turns = np.abs(way).max(axis=1) > _STANDS
        for some, measure in ((np.flatnonzero(~turns), _standing), (np.flatnonzero(turns), _turning)):
            for k in range(0, len(some), _AT_A_TIME):
                which = some[k : k + _AT_A_TIME]
                measured = measure(run.machine_at(first), paths.select(which), begin[which], way[which])
                columns = found.begin, found.end, found.most, found.acceleration
                for column, values in zip(columns, measured, strict=True):
                    column[which] = values
        return found


_Measured = tuple[Floats, Floats, Floats, Floats]


def _standing(machine: Machine, paths: ArcPaths, rotary: Floats, way: Floats) -> _Measured:
    """Speeds while the rotary axes stand at ``rotary`` (m, 2)."""
    frame = arc_frames(paths.start, paths.end, paths.centre, paths.normal, paths.full_turns)
    middle = paths.centre + frame.height[:, None] * paths.normal
    ahead = np.cross(paths.normal, frame.across)
    tips = (middle, middle + frame.across, middle + ahead, middle + frame.rise[:, None] * paths.normal)
    joints = _joints(machine, np.concatenate(tips), np.tile(rotary, (4, 1))).reshape(4, -1, 5)
    cosine, sine, slope = (each[:, None, :] for each in joints[1:] - joints[0])
    sweep, grows = frame.sweep[:, None, None], frame.growth[:, None, None] - 1.0
    # The ends, and between them the places of one turn, of which the others are like it but for a changing radius.
    done = np.linspace(0.0, 1.0, _PER_TURN + 1)[None, :, None]
    shares = np.concatenate((done * np.minimum(1.0, 2.0 * np.pi / sweep), 1.0 - done[:, :1] * sweep), axis=1)
    size, angle = 1.0 + grows * shares, sweep * shares
    level = cosine * np.cos(angle) + sine * np.sin(angle)
    across = sine * np.cos(angle) - cosine * np.sin(angle)
    speed = grows * level + size * sweep * across + slope
    bend = sweep * (2.0 * grows * across - size * sweep * level)
    return speed[:, 0], speed[:, -1], np.abs(speed).max(axis=1), np.abs(bend).max(axis=1)


def _turning(machine: Machine, paths: ArcPaths, rotary: Floats, way: Floats) -> _Measured:
    """Speeds while the rotary axes turn by ``way`` (m, 2)."""
    turns = paths.full_turns + 1.0 + np.ceil(np.nan_to_num(np.abs(way)).max(axis=1) / 360.0)
    counts = np.minimum(_PER_TURN * turns, _MOST_PLACES).astype(np.int64)
    lasts = np.cumsum(counts + 1) - 1
    firsts = lasts - counts
    arc = np.repeat(np.arange(len(paths)), counts + 1)
    place = np.arange(len(arc)) - firsts[arc]
    spread = np.where(counts[arc] < _MOST_PLACES, place / counts[arc], np.mod(place * _GOLDEN, 1.0))
    spread[lasts] = 1.0
    step = (_STEP / (_PER_TURN * turns))[arc, None]
    shares = (spread[:, None] * (1.0 - 2.0 * step) + step * np.array([0.0, 1.0, 2.0])).ravel()
    three = np.repeat(arc, 3)
    tips = circle_points(
        paths.start[three], paths.end[three], paths.centre[three], paths.normal[three], paths.full_turns[three], shares
    )
    joints = _joints(machine, tips, rotary[three] + shares[:, None] * way[three]).reshape(-1, 3, 5)
    speed = (joints[:, 2] - joints[:, 0]) / (2.0 * step)
    bend = np.abs(joints[:, 2] - 2.0 * joints[:, 1] + joints[:, 0]) / step**2
    most, most_bent = (np.maximum.reduceat(each, firsts) for each in (np.abs(speed), bend))
    return speed[firsts], speed[lasts], most, most_bent


def _joints(machine: Machine, tips: Floats, rotary: Floats) -> Floats:
    every = np.ones(len(tips), np.bool_)
    return joints_from_rows(machine, kinematic_parameters(machine), every, tips, rotary)
