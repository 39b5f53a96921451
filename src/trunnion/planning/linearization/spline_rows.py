"""Which splines stay splines: those that the control takes, and that nothing along them makes doubtful.

All others are the lines of their points, which the CL reader has made within its tolerance.
"""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.model.motion import MachiningMode
from trunnion.model.splines import Splines
from trunnion.model.toolpath import CutterComp, CycleOn, Kind, Operation
from trunnion.planning.options import ControlCapabilities

#: A spline starts in the row before it if they are nearer than this, mm.
_SAME_POINT: Final = 1e-6


def with_splines_kept(operation: Operation, mode: MachiningMode, capabilities: ControlCapabilities) -> Operation:
    """Return the operation with the splines that can be written as such.

    Only the tip of a tool that stands along +Z follows a spline for certain: with TCP, without it and in a tilted plane
    they become lines, and so they do beside holes and under radius compensation.
    """
    splines = operation.splines
    if not len(splines):
        return operation
    keep = np.zeros(len(splines), np.bool_)
    compensated = any(isinstance(event, CutterComp) and event.side != "OFF" for event in operation.events)
    drilled = any(isinstance(event, CycleOn) for event in operation.events)
    if mode is MachiningMode.THREE_AXIS and not compensated and not drilled:
        keep = _unbroken(operation)
        for k in np.flatnonzero(keep).tolist():
            keep[k] = capabilities.takes_spline(splines[k].spline)
    return replace(operation, splines=_between_rows(splines.select(keep), operation.moves.tip))


def _between_rows(splines: Splines, tip: Floats) -> Splines:
    """Splines that start and end exactly in their rows, whatever arithmetic has added: they must print the same."""
    poles = splines.poles.copy()
    poles[splines.pole_begin[:-1]] = tip[splines.first - 1]
    poles[splines.pole_begin[1:] - 1] = tip[splines.last]
    return splines.with_poles(poles)


def _unbroken(operation: Operation) -> Flags:
    """(m,) bool: it starts in the row before it; one feed per minute, one tool axis, and nothing stands between."""
    moves, splines = operation.moves, operation.splines
    rows = np.array([event.row for event in operation.events], np.int64)
    unbroken = np.zeros(len(splines), np.bool_)
    for k, (first, last, spline) in enumerate(splines[k] for k in range(len(splines))):
        if first < 1 or ((rows > first) & (rows <= last)).any():
            continue
        here, with_start = slice(first, last + 1), slice(first - 1, last + 1)
        feed = moves.feed[here]
        unbroken[k] = (
            bool((moves.kind[here] == Kind.LINEAR).all())
            and bool((feed == feed[0]).all())
            and not bool(moves.per_rev[here].any())
            and bool((moves.axis[with_start] == moves.axis[first]).all())
            and bool((np.abs(moves.tip[first - 1] - spline.poles[0]) <= _SAME_POINT).all())
        )
    return unbroken
