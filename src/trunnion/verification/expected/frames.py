"""Operations in the coordinate system of the program.

The planner has its own derivation of this (``trunnion.model.frames``). There are two on purpose: a mistake in one of
them must not cancel out when a program is verified.
"""

from dataclasses import replace

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.toolpath import Frame, Operation


def transform_to_frame(frame: Frame, operation: Operation) -> Operation:
    """Return the operation as seen from another coordinate system, by homogeneous matrices; its events stay as they
    are.
    """
    if operation.frame == frame:
        return operation
    change = np.linalg.inv(_homogeneous_matrix(frame)) @ _homogeneous_matrix(operation.frame)
    turn, shift = change[:3, :3], change[:3, 3]
    moves, arcs = operation.moves, operation.arcs
    return replace(
        operation,
        frame=frame,
        moves=replace(
            moves,
            tip=np.ascontiguousarray(moves.tip @ turn.T + shift),
            axis=np.ascontiguousarray(moves.axis @ turn.T),
            normal=None if moves.normal is None else moves.normal @ turn.T,
        ),
        arcs=replace(arcs, centre=arcs.centre @ turn.T + shift, normal=arcs.normal @ turn.T),
        splines=operation.splines.with_poles(operation.splines.poles @ turn.T + shift),
    )


def _homogeneous_matrix(frame: Frame) -> Floats:
    """(4, 4): from coordinates in the frame to the absolute system of the CAM."""
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1] = frame.x, frame.y
    matrix[:3, 2] = np.cross(frame.x, frame.y)
    matrix[:3, 3] = frame.origin
    return matrix
