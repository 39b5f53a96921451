"""Which kind of operation it is: three-axis, in a tilted plane, or simultaneous.

In:     an operation in the program's coordinate system, and the coordinate system that it had of its own.
Out:    how the machine is to make it, and its plane if it is tilted.

By rule: a tool axis that is +Z of the program throughout is three-axis, one that stands still otherwise is a tilted
plane, one that changes is simultaneous. The user's word is stronger than the rule. A tilted plane for which the control
has no words is made as a simultaneous operation, where it has words for that.
"""

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import Problem, Severity
from trunnion.plan.frames import frame_of
from trunnion.plan.motion import Manner
from trunnion.plan.wishes import Wishes
from trunnion.toolpath import Frame, Operation

#: Tool axes are the same when no component differs by more than this; CL files print seven decimals or more.
_SAME = 1e-7

#: A coordinate system stands on the tool axis when they differ by no more than this sine; seven decimals twice.
_ALONG = 1e-6

#: Decimals of a plane's origin, mm: any point of the plane serves, so that it is one which prints whole.
_WHOLE = 4

#: X of the program is too close to the tool axis to point the way in the plane below this sine.
_CLOSE = 1e-3


def manner_of(operation: Operation, wish: Manner | None) -> Manner:
    """How an operation is to be made; ``wish`` is the user's word, None where there is none."""
    if wish is not None:
        return wish
    axis = operation.moves.axis
    if not _steady(axis, axis[0]):
        return Manner.TCP
    return Manner.THREE_AXIS if _steady(axis[:1], np.array([0.0, 0.0, 1.0])) else Manner.TILTED


def in_other_words(file: str, operation: Operation, manner: Manner, wishes: Wishes) -> tuple[Manner, list[Problem]]:
    """The manner that the control has words for, and what there is to say when it is not the one that the rule has."""
    simultaneous = Manner.TCP if wishes.tcp else Manner.WITHOUT_TCP
    open_ = wishes.manner is None and simultaneous in wishes.manners
    if manner is Manner.TILTED and manner not in wishes.manners and open_:
        what = f"operation {operation.name} stands in a {manner}, for which the control has no words"
        how = f"it is made {'with TCP' if wishes.tcp else 'without TCP'}"
        return simultaneous, [Problem(file, operation.line, what, how, Severity.WARNING)]
    return simultaneous if manner is Manner.TCP else manner, []


def contradictions(
    file: str, operation: Operation, manner: Manner, manners: frozenset[Manner] = frozenset(Manner)
) -> list[Problem]:
    """Why an operation cannot be made in a manner, be it the user's wish or the control's words."""
    axis, line = operation.moves.axis, operation.moves.line
    if manner not in manners:
        what = f"operation {operation.name}: the control has no words for {manner}"
        return [Problem(file, operation.line, what, f"it has words for {', '.join(sorted(manners))}")]
    if manner is Manner.THREE_AXIS:
        wanted, what = np.array([0.0, 0.0, 1.0]), "the tool axis is not +Z of the program, and manner is three-axis"
    elif manner is Manner.TILTED:
        wanted, what = axis[0], "the tool axis changes, and manner is tilted"
    else:
        return []
    wrong = np.flatnonzero(np.abs(axis - wanted).max(axis=1) > _SAME)
    cure = "leave the setting manner out, or split the operation"
    return [Problem(file, int(line[wrong[0]]), f"operation {operation.name}: {what}", cure)] if len(wrong) else []


def plane_of(axis: Floats, own: Frame) -> Frame:
    """The tilted plane under a tool axis, in the program's coordinate system.

    Parameters
    ----------
    axis : (3,) float64
        The tool axis, which becomes exactly the plane's Z.
    own
        The operation's own coordinate system. If it stands on the tool axis, the plane has its origin and its X;
        otherwise the program's zero, and X as the program's X falls onto the plane.
    """
    if float(np.linalg.norm(np.cross(own.matrix()[:, 2], axis))) < _ALONG and own.matrix()[:, 2] @ axis > 0.0:
        y, origin = np.cross(axis, np.array(own.x)), np.array(own.origin)
    else:
        y, origin = np.cross(axis, [1.0, 0.0, 0.0]), np.zeros(3)
        if float(np.linalg.norm(y)) < _CLOSE:
            y = np.cross(axis, [0.0, 0.0, -1.0])
    y = y / np.linalg.norm(y)
    return frame_of(np.round(origin, _WHOLE) + 0.0, np.cross(y, axis), y)


def _steady(axis: Floats, wanted: Floats) -> bool:
    if np.abs(axis[-1] - wanted).max() > _SAME:  # the usual case decides itself without looking at all rows
        return False
    return bool(np.abs(axis - wanted).max() <= _SAME)
