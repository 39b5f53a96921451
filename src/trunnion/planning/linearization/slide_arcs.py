"""Arcs without TCP: those that the slides X and Y make by themselves stay arcs, the others become lines."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, forward
from trunnion.model.toolpath import Operation
from trunnion.planning.linearization.arc_chords import arc_piece_counts, lines_for_arcs

#: Directions are parallel, or at right angles, within this sine.
_PARALLEL_SINE: Final = 1e-6

#: Rotary axes that turn by less than this, degrees, are at rest.
_NO_MOTION: Final = 1e-9


def keep_slide_arcs(
    machine: Machine, operation: Operation, rotary: Floats, chord_tolerance: float
) -> tuple[Operation, Ints]:
    """Return the operation with lines for arcs that X and Y alone do not make, and the row from which each row comes,
    (n,).
    """
    arcs = operation.arcs
    if not len(arcs.row):
        return operation, np.arange(len(operation.moves))
    turn = np.abs(rotary[arcs.row] - rotary[arcs.row - 1]).max(axis=1)
    about_z = [_is_about_z(machine, rotary[row], arcs.normal[k]) for k, row in enumerate(arcs.row.tolist())]
    keep = (turn <= _NO_MOTION) & np.array(about_z)
    copies = arc_piece_counts(operation, keep, chord_tolerance)
    return lines_for_arcs(operation, keep, chord_tolerance), np.repeat(np.arange(len(operation.moves)), copies)


def _is_about_z(machine: Machine, rotary: Floats, normal: Floats) -> bool:
    """Whether an arc about ``normal`` (3,), workpiece frame, turns about Z of slides that are at right angles."""
    directions = _slide_directions(machine, rotary)
    is_square = bool(np.abs(directions.T @ directions - np.eye(3)).max() < _PARALLEL_SINE)
    return is_square and abs(float(directions[:, 2] @ normal)) > 1.0 - 0.5 * _PARALLEL_SINE**2


def _slide_directions(machine: Machine, rotary: Floats) -> Floats:
    """(3, 3): columns are the tip's directions, workpiece frame, as X, Y and Z grow; ``rotary`` (2,), degrees."""
    joints = np.zeros((4, 5))
    joints[:, list(machine.rotary)] = rotary
    for k, name in enumerate("XYZ"):
        joints[k + 1, machine.column(name)] = 1.0
    tip, _ = forward(machine, joints)
    return np.asarray((tip[1:] - tip[0]).T)
