"""Operations and coordinate systems expressed in another coordinate system."""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.toolpath import Frame, From, Operation

#: Greatest error of a coordinate that was turned into another coordinate system, mm: CL files have seven decimals of a
#: direction, which is two last digits of the finest control at an arm of 400 mm. All that prints as two digits is
#: within, so that what is printed stays what it is when it is turned again.
TURNING_NOISE: Final = 2.5e-5

#: Decimals of the lengths that parts are drawn with.
_DRAWN_DECIMALS: Final = 3


def into_frame(operation: Operation, frame: Frame) -> Operation:
    """Return the operation in another coordinate system; the same object if it is the same one.

    With M the matrix and o the origin of a frame in the CAM's absolute system, a point is
    M_to^T (M_from p + o_from - o_to) and a direction M_to^T M_from u.
    """
    if operation.frame == frame:
        return operation
    turn = frame.matrix().T @ operation.frame.matrix()
    shift = frame.matrix().T @ (np.array(operation.frame.origin) - np.array(frame.origin))
    return replace(_transformed(operation, turn, shift), frame=frame)


def into_plane(operation: Operation, plane: Frame) -> Operation:
    """Return the operation in the coordinates of a plane, which is given in the operation's frame; its
    ``frame`` stays.
    """
    turn = plane.matrix().T
    return _transformed(operation, turn, -turn @ np.array(plane.origin))


def relative_frame(own: Frame, frame: Frame) -> Frame:
    """``own`` expressed in ``frame``; both are given in the CAM's absolute system."""
    turn = frame.matrix().T
    origin = turn @ (np.array(own.origin) - np.array(frame.origin))
    return frame_from_vectors(origin, turn @ np.array(own.x), turn @ np.array(own.y))


def without_turning_noise(lengths: Floats) -> Floats:
    """Lengths that were turned, mm, of any shape: those within ``TURNING_NOISE`` of a thousandth are that thousandth.

    So zero stays zero, and holes that were drawn at one height have one height.
    """
    drawn = np.round(lengths, _DRAWN_DECIMALS)
    return np.asarray(np.where(np.abs(lengths - drawn) <= TURNING_NOISE, drawn, lengths))


def frame_from_vectors(origin: Floats, x: Floats, y: Floats) -> Frame:
    """Return a frame from origin, X and Y, (3,) float64 each."""
    columns = [(float(v[0]), float(v[1]), float(v[2])) for v in (origin, x, y)]
    return Frame(*columns)


def _transformed(operation: Operation, turn: Floats, shift: Floats) -> Operation:
    """Transform the points p of an operation to turn p + shift, free of noise, and its directions u to turn u."""
    moves, arcs = operation.moves, operation.arcs
    normal = None if moves.normal is None else moves.normal @ turn.T
    tip, centre = moves.tip @ turn.T + shift, arcs.centre @ turn.T + shift
    poles = operation.splines.poles @ turn.T + shift
    if not np.array_equal(turn, np.eye(3)):
        tip, centre = without_turning_noise(tip), without_turning_noise(centre)
        poles = without_turning_noise(poles)
    return replace(
        operation,
        moves=replace(moves, tip=tip, axis=moves.axis @ turn.T, normal=normal),
        arcs=replace(arcs, centre=centre, normal=arcs.normal @ turn.T),
        splines=operation.splines.with_poles(poles),
        events=tuple(
            replace(event, tip=tuple(turn @ event.tip + shift), axis=tuple(turn @ event.axis))
            if isinstance(event, From)
            else event
            for event in operation.events
        ),
    )
