"""A part that is clamped otherwise than it is drawn: its toolpaths, and what the head of its program says of it.

First it is tilted about X of the program's coordinate system, as by a fixture with that angle, then turned about Z of
the machine frame; both right-handed, and about the workpiece zero.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.controls.vocabulary import PLACED_NOTICE
from trunnion.errors import Problem, Severity
from trunnion.machines.machine import Vector
from trunnion.model.frames import frame_from_vectors, into_frame, into_plane
from trunnion.model.toolpath import Frame, Operation, Toolpath
from trunnion.placing.path_rows import turn_and_tilt

#: How a tilt begins in the head of a program; a turn begins with ``PLACED_NOTICE``.
_TILTED: Final = "PART TILTED"

_NUMBER: Final = r"\s+(-?[0-9]+(?:\.[0-9]+)?)\s+DEG"

#: So much of a program is its head, bytes.
_HEAD: Final = 1 << 16

#: Angles that differ by less are the same, degrees: they are printed in thousandths.
_SAME: Final = 2e-3


def placed_notices(zero: Vector, turn: float, tilt: float) -> tuple[str, ...]:
    """Comments for the head of a program: how the part is clamped, degrees, and where its zero (3,) is, mm."""
    x, y, z = (f"{letter}{value:.3f}" for letter, value in zip("XYZ", zero, strict=True))
    return (*_clamped(turn, tilt), f"WORKPIECE ZERO {x} {y} {z} MM ON THE MACHINE, AXES AT 0")


def _clamped(turn: float, tilt: float) -> Iterator[str]:
    turn %= 360.0
    if tilt:
        side = "UP" if tilt > 0.0 else "DOWN"
        yield f"{_TILTED} {number(tilt)} DEG FIRST, ABOUT ITS X, RIGHT-HANDED, ITS +Y SIDE {side}"
    if turn or tilt:
        yield f"{PLACED_NOTICE} {number(turn)} DEG ABOUT Z, COUNTER-CLOCKWISE SEEN FROM ABOVE, FROM +Z"
    else:
        yield "PART CLAMPED AS DRAWN, NOT TURNED"


def number(degrees: float) -> str:
    """An angle in thousandths of a degree, as short as it can be written."""
    return f"{round(degrees, 3) + 0.0:.3f}".rstrip("0").removesuffix(".")


def turned_toolpaths(
    toolpaths: Sequence[Toolpath], degrees: float, tilt: float = 0.0, *, absolute: bool = False
) -> list[Toolpath]:
    """Toolpaths of a part that is tilted about X and then turned about Z, in the program's coordinate system.

    That is the coordinate system of the first operation with motion, or the ``absolute`` one of the CAM system.
    """
    if degrees % 360.0 == 0.0 and tilt == 0.0:
        return list(toolpaths)
    moving = (operation for path in toolpaths for operation in path.operations if len(operation.moves))
    frame = Frame() if absolute else next((operation.frame for operation in moving), Frame())
    back = turn_and_tilt(degrees, tilt).T
    plane = frame_from_vectors(np.zeros(3), back[:, 0], back[:, 1])

    def turned(operation: Operation) -> Operation:
        return replace(into_plane(into_frame(operation, frame), plane), frame=frame)

    return [replace(path, operations=tuple(map(turned, path.operations))) for path in toolpaths]


def carried_notices(program: Path) -> tuple[str, ...]:
    """Comments on how its part is clamped for a program that is made of another one, if that states it."""
    stated = _stated(program)
    return () if stated is None else tuple(_clamped(*stated))


def unlike_head(program: Path, turn: float, tilt: float) -> list[Problem]:
    """A warning where the head of a program says that its part is clamped otherwise, degrees; else none."""
    stated = _stated(program)
    if stated is None:
        return []
    turns, tilts = stated
    off = abs((turns - turn + 180.0) % 360.0 - 180.0)
    if off < _SAME and abs(tilts - tilt) < _SAME:
        return []
    told = f"the turn {number(turns)}" + (f" and the tilt {number(tilts)}" if tilts else "")
    cure = f"give {told}, so that the CL files are turned before they are compared"
    return [Problem(str(program), 0, _said(turns, tilts), cure, Severity.WARNING, code="PLC220")]


def turned_bodies(program: Path) -> list[Problem]:
    """A warning where the head of a program says that its part is turned: bodies must be so, too; else none."""
    stated = _stated(program)
    if stated is None or not any(stated):
        return []
    cure = "give stock, part and fixtures as they are clamped: nothing turns them here"
    return [Problem(str(program), 0, _said(*stated), cure, Severity.WARNING, code="PLC230")]


def _said(turn: float, tilt: float) -> str:
    """What a head says of its part, in words; degrees."""
    tilted = f"tilted by {number(tilt)} degrees about X and " if tilt else ""
    return f"its head says that the part is {tilted}turned by {number(turn)} degrees about Z"


def _stated(program: Path) -> tuple[float, float] | None:
    """Turn and tilt that the head of a program states, degrees; None: it states none."""
    if not program.is_file():  # what a pipe holds can be read once
        return None
    try:
        with program.open("rb") as stream:
            head = stream.read(_HEAD).decode("latin-1").upper()
    except OSError:
        return None
    turn, tilt = (re.search(re.escape(words) + _NUMBER, head) for words in (PLACED_NOTICE, _TILTED))
    return None if turn is None else (float(turn[1]), 0.0 if tilt is None else float(tilt[1]))
