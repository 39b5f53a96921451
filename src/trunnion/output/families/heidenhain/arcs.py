"""Circles and helices of iTNC 530 and TNC 640: about a centre, by a radius, by an angle.

All arcs are about Z, the tool axis; DR+ is counter-clockwise as seen against Z. Facts: the manuals of both controls;
docs/controls/heidenhain.md lists them.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.family_writer import MAX_CENTRE_ERROR_DIGITS, ArcWords, Formats
from trunnion.controls.words import ABSENT, NumberFormat
from trunnion.model.arcs import FLAT_ARC
from trunnion.model.toolpath import Arcs

#: Sweeps nearer to half a turn are not programmed by a radius: both its signs give almost the same circle; degrees.
_HALF_TURN_MARGIN: Final = 2.0


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, formats: Formats, by_radius: bool) -> ArcWords:
    """Return ``CC X Y`` in a line before, and ``C X Y DR``; for helices and more than one turn, ``CP IPA IZ DR``.

    IPA has the sign of DR. With ``by_radius``, circles are ``CR X Y R DR`` wherever that is safe; R is negative for
    sweeps of more than half a turn. Arguments as ``FamilyWriter.arc_words``.
    """
    start, end, centre = tip[arcs.row[rows] - 1], tip[arcs.row[rows]], arcs.centre[rows]
    sense = np.sign(arcs.normal[rows, 2])
    length = formats["Z"]
    rise = length.counts(end[:, 2]) - length.counts(start[:, 2])
    rises = (rise != 0) & (np.abs(end[:, 2] - start[:, 2]) >= FLAT_ARC)
    helix = rises | (arcs.full_turns[rows] > 0)
    sweep = _sweep(start, end, centre, sense, arcs.full_turns[rows])
    radius = _radius(start, end, centre, sweep, length)
    # After a helix the control is where the angle has led it, and not at a printed point.
    after_helix = np.isin(arcs.row[rows] - 1, arcs.row[rows][helix])
    use_radius = _radius_finds_centre(start, end, centre, sweep, radius, length) & ~helix & ~after_helix & by_radius
    columns = {
        "line": np.full(len(rows), ABSENT),
        "arc": np.where(helix | use_radius, ABSENT, 1),
        "arc_by_radius": np.where(use_radius, 1, ABSENT),
        "helix": np.where(helix, 1, ABSENT),
        "arc_radius": np.where(use_radius, radius, ABSENT),
        "arc_angle": np.where(helix, formats["arc_angle"].counts(sweep), ABSENT),
        "arc_rise": np.where(helix & rises, rise, ABSENT),
        "counterclockwise": np.where(sense > 0, 1, ABSENT),
        "clockwise": np.where(sense < 0, 1, ABSENT),
        "Z": np.full(len(rows), ABSENT),
    }
    for c, word in enumerate("XY"):
        columns[word] = np.where(helix, ABSENT, length.counts(end[:, c]))
    always = np.ones(len(rows), np.int64)
    centres = _centres(start, centre, length).tolist()
    return ArcWords(columns, {"X": always, "Y": always}, _centre_lines(centres, use_radius, formats))


def _centre_lines(centres: list[list[int]], use_radius: Flags, formats: Formats) -> list[str]:
    """``CC`` before each arc that needs its centre, else an empty text."""
    text = formats["X"].text_of_count
    lines = [f"CC X{text(x)} Y{text(y)}" for x, y in centres]
    return ["" if by_radius else line for line, by_radius in zip(lines, use_radius.tolist(), strict=True)]


def _centres(start: Floats, centre: Floats, length: NumberFormat) -> Ints:
    """Return (a, 2) counts: the centres relative to the printed start points, so that nothing is rounded twice."""
    offsets = [length.counts((centre - start)[:, c]) for c in range(2)]
    starts = [length.counts(start[:, c]) for c in range(2)]
    return np.column_stack([a + b for a, b in zip(offsets, starts, strict=True)])


def _sweep(start: Floats, end: Floats, centre: Floats, sense: Floats, turns: Ints) -> Floats:
    """Return (a,) degrees with the sign of DR; an arc that ends where it starts is a full turn."""
    a, b = start[:, :2] - centre[:, :2], end[:, :2] - centre[:, :2]
    angle = np.degrees(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], np.einsum("ij,ij->i", a, b)))
    within_turn = np.mod(sense * angle, 360.0)
    closed = np.linalg.norm(a - b, axis=1) < 1e-4
    return np.asarray(sense * (np.where(closed, 360.0, within_turn) + 360.0 * turns))


def _radius(start: Floats, end: Floats, centre: Floats, sweep: Floats, length: NumberFormat) -> Ints:
    """Return (a,) counts, negative for sweeps of more than half a turn."""
    radii = [np.linalg.norm((point - centre)[:, :2], axis=1) for point in (start, end)]
    return length.counts(np.where(np.abs(sweep) > 180.0, -0.5, 0.5) * (radii[0] + radii[1]))


def _radius_finds_centre(
    start: Floats, end: Floats, centre: Floats, sweep: Floats, radius: Ints, number_format: NumberFormat
) -> Flags:
    """Return (a,) whether the control finds the centre by the printed radius, within ``MAX_CENTRE_ERROR_DIGITS``."""
    digit = number_format.digit
    first, last = (
        np.column_stack([number_format.counts(point[:, c]) for c in range(2)]) * digit for point in (start, end)
    )
    chord = last - first
    length = np.linalg.norm(chord, axis=1)
    square = (radius * digit) ** 2 - 0.25 * length**2
    # With a positive radius the centre is to the left of the chord if the circle turns left.
    height = np.sqrt(np.maximum(square, 0.0)) * np.sign(sweep) * np.sign(radius)
    left = np.column_stack((-chord[:, 1], chord[:, 0])) / np.maximum(length, digit)[:, None]
    found = 0.5 * (first + last) + height[:, None] * left
    near = np.abs(found - centre[:, :2]).max(axis=1, initial=0.0) < MAX_CENTRE_ERROR_DIGITS * digit
    half = np.abs(np.abs(sweep) - 180.0) < _HALF_TURN_MARGIN
    return np.asarray(near & (square > 0.0) & (length > digit) & ~half)
