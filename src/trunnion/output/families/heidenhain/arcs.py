"""Circles and helices of iTNC 530 and TNC 640: about a centre, by a radius, by an angle.

All arcs are about Z, which is the tool axis. DR+ is counter-clockwise as seen against Z. Facts: the manuals of both
controls; docs/controls/heidenhain.md has them one by one.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.family_writer import MAX_CENTRE_ERROR_DIGITS, ArcWords, Formats
from trunnion.controls.words import ABSENT, round_to_counts
from trunnion.model.toolpath import Arcs

#: How near to half a turn a radius says a circle no more, degrees: there both its signs mean about the same.
_HALF_TURN_MARGIN: Final = 2.0


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, formats: Formats, by_radius: bool) -> ArcWords:
    """``CC X Y`` in a line before, and ``C X Y DR``; for a helix and for more than a turn ``CP IPA IZ DR``.

    IPA has the sign of DR. With ``by_radius`` it is ``CR X Y R DR`` wherever that is safe; R is negative over half a
    turn.
    """
    start, end, centre = tip[arcs.row[rows] - 1], tip[arcs.row[rows]], arcs.centre[rows]
    sense = np.sign(arcs.normal[rows, 2])
    place, decimals = formats["Z"].decimals, formats["arc_angle"].decimals
    rise = round_to_counts(np.ascontiguousarray(end[:, 2]), place) - round_to_counts(
        np.ascontiguousarray(start[:, 2]), place
    )
    helix = (rise != 0) | (arcs.full_turns[rows] > 0)
    sweep = _sweep(start, end, centre, sense, arcs.full_turns[rows])
    radius = _radius(start, end, centre, sweep, place)
    # Behind a helix the control stands where its angle led it to, which is nothing that was printed.
    behind = np.isin(arcs.row[rows] - 1, arcs.row[rows][helix])
    short = _radius_finds_centre(start, end, centre, sweep, radius, place) & ~helix & ~behind & by_radius
    columns = {
        "line": np.full(len(rows), ABSENT),
        "arc": np.where(helix | short, ABSENT, 1),
        "arc_by_radius": np.where(short, 1, ABSENT),
        "helix": np.where(helix, 1, ABSENT),
        "arc_radius": np.where(short, radius, ABSENT),
        "arc_angle": np.where(helix, round_to_counts(sweep, decimals), ABSENT),
        "arc_rise": np.where(helix & (rise != 0), rise, ABSENT),
        "counterclockwise": np.where(sense > 0, 1, ABSENT),
        "clockwise": np.where(sense < 0, 1, ABSENT),
        "Z": np.full(len(rows), ABSENT),
    }
    for c, word in enumerate("XY"):
        columns[word] = np.where(helix, ABSENT, round_to_counts(np.ascontiguousarray(end[:, c]), place))
    said = np.ones(len(rows), np.int64)
    number = formats["X"].text_of_count
    lines = [f"CC X{number(x)} Y{number(y)}" for x, y in _centres(start, centre, place).tolist()]
    return ArcWords(
        columns,
        {"X": said, "Y": said},
        ["" if left_out else line for line, left_out in zip(lines, short.tolist(), strict=True)],
    )


def _centres(start: Floats, centre: Floats, decimals: int) -> Ints:
    """(a, 2) counts: the centres as seen from where the circles start in print, so that nothing is rounded twice."""
    ways = [round_to_counts(np.ascontiguousarray((centre - start)[:, c]), decimals) for c in range(2)]
    starts = [round_to_counts(np.ascontiguousarray(start[:, c]), decimals) for c in range(2)]
    return np.column_stack([a + b for a, b in zip(ways, starts, strict=True)])


def _sweep(start: Floats, end: Floats, centre: Floats, sense: Floats, turns: Ints) -> Floats:
    """(a,) degrees, with the sign of DR; an arc that ends where it starts is a full turn."""
    a, b = start[:, :2] - centre[:, :2], end[:, :2] - centre[:, :2]
    angle = np.degrees(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], np.einsum("ij,ij->i", a, b)))
    part = np.mod(sense * angle, 360.0)
    closed = np.linalg.norm(a - b, axis=1) < 1e-4
    return np.asarray(sense * (np.where(closed, 360.0, part) + 360.0 * turns))


def _radius(start: Floats, end: Floats, centre: Floats, sweep: Floats, decimals: int) -> Ints:
    """(a,) counts, negative over half a turn."""
    away = [np.linalg.norm((point - centre)[:, :2], axis=1) for point in (start, end)]
    return round_to_counts(np.where(np.abs(sweep) > 180.0, -0.5, 0.5) * (away[0] + away[1]), decimals)


def _radius_finds_centre(
    start: Floats, end: Floats, centre: Floats, sweep: Floats, radius: Ints, decimals: int
) -> Flags:
    """(a,) whether a control finds the centre by what is printed, within ``MAX_CENTRE_ERROR_DIGITS`` of it."""
    digit = 10.0**-decimals
    first, last = (
        np.column_stack([round_to_counts(np.ascontiguousarray(point[:, c]), decimals) for c in range(2)]) * digit
        for point in (start, end)
    )
    chord = last - first
    length = np.linalg.norm(chord, axis=1)
    square = (radius * digit) ** 2 - 0.25 * length**2
    # A positive radius has the centre to the left of the chord where the circle turns to the left.
    height = np.sqrt(np.maximum(square, 0.0)) * np.sign(sweep) * np.sign(radius)
    left = np.column_stack((-chord[:, 1], chord[:, 0])) / np.maximum(length, digit)[:, None]
    found = 0.5 * (first + last) + height[:, None] * left
    near = np.abs(found - centre[:, :2]).max(axis=1, initial=0.0) < MAX_CENTRE_ERROR_DIGITS * digit
    half = np.abs(np.abs(sweep) - 180.0) < _HALF_TURN_MARGIN
    return np.asarray(near & (square > 0.0) & (length > digit) & ~half)
