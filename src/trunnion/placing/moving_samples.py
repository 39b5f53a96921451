"""Samples of the ways between rows: where arcs reach farthest, and steps while rotary axes turn.

While the rotary axes stand, a slide on a line has its extremes at the ends, and on an arc where its derivative is zero:
these points are exact. While they turn under TCP, slides leave their lines: samples stand at most ``STEP`` apart.
"""

import math
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, kinematic_parameters
from trunnion.model.arc_extremes import ArcPaths
from trunnion.model.subdivision import arc_frames, circle_points
from trunnion.model.turning_lines import chord_excursion, longest_arms
from trunnion.placing.path_rows import PathRows

#: The farthest that a rotary axis turns between two samples, degrees.
STEP: Final = 0.5

#: Rotary axes that turn by less stand, degrees.
_STANDS: Final = 1e-9

#: A rotary axis that turns by more is rewound, which the planner does away from the part, degrees.
_REWINDS: Final = 180.001

#: The most samples between two rows.
_MOST: Final = 720


def turning_samples(rows: PathRows, angles: Floats) -> tuple[Floats, Floats, Ints]:
    """Tips (k, 3), rotary positions (k, 2) and rows (k,) of samples between rows while rotary axes turn."""
    way = np.abs(np.diff(angles, axis=0)).max(axis=1, initial=0.0)
    way[rows.begins[1:] | ~rows.straight[1:] | (way > _REWINDS)] = 0.0
    counts = np.minimum(np.ceil(way / STEP) - 1.0, _MOST)
    arc_row = rows.arc_row[rows.arc_row > 0]
    on_arc = arc_row[way[arc_row - 1] > _STANDS]
    if len(on_arc):  # as many as for the same way of a rotary axis, and at least one each 7.5 degrees
        turns = rows.arcs.full_turns[np.searchsorted(rows.arc_row, on_arc)] + 1.0
        counts[on_arc - 1] = np.minimum(np.maximum(counts[on_arc - 1], 48.0 * turns), _MOST)
    to = np.flatnonzero(counts > 0.0) + 1
    number = counts[to - 1].astype(np.int64)
    row = np.repeat(to, number)
    place = np.arange(len(row)) - np.repeat(np.cumsum(number) - number, number) + 1.0
    share = (place / np.repeat(number + 1.0, number))[:, None]
    tip = rows.tip[row - 1] + share * (rows.tip[row] - rows.tip[row - 1])
    if len(on_arc):
        bent = np.isin(row, on_arc)
        arc = np.searchsorted(rows.arc_row, row[bent])
        tip[bent] = _on_arcs(rows.arcs.select(arc), share[bent, 0])
    return tip, angles[row - 1] + share * (angles[row] - angles[row - 1]), row


def arc_samples(rows: PathRows, angles: Floats, normals: Floats) -> tuple[Floats, Floats, Ints]:
    """Tips (k, 3), rotary positions (k, 2) and rows (k,) of the points of arcs where slides reach farthest.

    ``normals`` (n, 3, 3) are those of the forms of the rows.
    """
    before = np.maximum(rows.arc_row - 1, 0)
    stands = np.abs(angles[rows.arc_row] - angles[before]).max(axis=1, initial=0.0) <= _STANDS
    stands |= rows.begins[rows.arc_row]
    which = np.flatnonzero(stands)
    if not len(which):
        return np.zeros((0, 3)), np.zeros((0, 2)), np.zeros(0, np.int64)
    arcs, row = rows.arcs.select(which), rows.arc_row[which]
    found = [_turning_points(arcs, normals[row, slide]) for slide in range(3)]
    arc, share = (np.concatenate([one[k] for one in found]) for k in range(2))
    arc = arc.astype(np.int64)
    return _on_arcs(arcs.select(arc), share), angles[row[arc]], row[arc]


def _on_arcs(arcs: ArcPaths, share: Floats) -> Floats:
    return circle_points(arcs.start, arcs.end, arcs.centre, arcs.normal, arcs.full_turns, share)


def _turning_points(arcs: ArcPaths, normal: Floats) -> tuple[Ints, Floats]:
    """Arcs and shares of their sweep at which normal (m, 3) . tip has an extreme.

    The tip is ``middle + (1 + c a)(across cos a + ahead sin a) + rise a / sweep`` at the angle a. The derivative with
    the size of the start is level cos(a - phase) + drift; the change of size within an arc is rounding, or its
    extremes are taken for those of a circle.
    """
    frame = arc_frames(arcs.start, arcs.end, arcs.centre, arcs.normal, arcs.full_turns)
    ahead = np.cross(arcs.normal, frame.across)
    cosine, sine = (np.einsum("ij,ij->i", normal, each) for each in (frame.across, ahead))
    drift = frame.rise * np.einsum("ij,ij->i", normal, arcs.normal) / frame.sweep
    change = (frame.growth - 1.0) / frame.sweep
    along, across = sine + change * cosine, change * sine - cosine
    level, phase = np.hypot(along, across), np.arctan2(across, along)
    bends = level > np.abs(drift)
    away = np.arccos(np.where(bends, -drift / np.where(bends, level, 1.0), 0.0))
    arc, share = [], []
    for begin in (phase + away, phase - away):
        earliest = np.mod(begin, 2.0 * math.pi)
        latest = earliest + 2.0 * math.pi * np.floor((frame.sweep - earliest) / (2.0 * math.pi))
        for angle in (earliest, latest):
            inside = np.flatnonzero(bends & (angle > 0.0) & (angle < frame.sweep))
            arc.append(inside)
            share.append(angle[inside] / frame.sweep[inside])
    return np.concatenate(arc), np.concatenate(share)


def most_between(machine: Machine, rows: PathRows, positions: Floats, zero: Floats) -> float:
    """Return the bound over the ways to all rows, mm, with the zero (3,) there; NaN if rotary axes stand between
    slides.

    rows       as the part is turned
    positions  (n, 2) float64: of the rotary axes, degrees
    """
    x, y, z = zero.tolist()
    if rows.length is not None and np.isfinite(rows.length).any():
        machine = replace(machine, tool_length=max(machine.tool_length or 0.0, float(np.nanmax(rows.length))))
    kinematics = kinematic_parameters(replace(machine, workpiece_zero=(x, y, z)))
    turn = np.abs(np.diff(positions, axis=0))
    pieces = np.maximum(np.ceil(turn.max(axis=1, initial=0.0) / STEP), 1.0)
    counts = rows.straight[1:] & ~rows.begins[1:] & (turn.max(axis=1, initial=0.0) > 0.0) & (pieces <= 180.0 / STEP)
    if not counts.any():
        return 0.0
    if len(set(kinematics.rotary_below)) > 1:
        return np.nan
    angle = np.radians(turn.sum(axis=1) / pieces)[counts]
    way = (np.linalg.norm(np.diff(rows.tip, axis=0), axis=1) / pieces)[counts]
    arm = longest_arms(kinematics, rows.tip)
    arm = np.maximum(arm[1:], arm[:-1])[counts]
    slides = np.linalg.norm(np.array(kinematics.slides_inverse).reshape(3, 3), axis=1).max()
    return float((slides * chord_excursion(angle, way, arm)).max())
