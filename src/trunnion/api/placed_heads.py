"""What the head of a program says of a part that is clamped otherwise than it is drawn, and of its zero.

Comments state the tilt, the turn, the workpiece zero on the machine and the tool length for which that zero holds. They
are read again wherever the program is compared or simulated, and held against what is given there.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from trunnion.controls.vocabulary import DRAWN_NOTICE, LENGTH_NOTICE, TILTED_NOTICE, TURNED_NOTICE, ZERO_NOTICE
from trunnion.errors import Problem, Severity
from trunnion.machines import Machine
from trunnion.machines.machine import Vector

_VALUE: Final = r"(-?[0-9]+(?:\.[0-9]+)?)"

#: So much of a program is its head, bytes.
_HEAD: Final = 1 << 16

#: Angles in degrees and lengths in mm that differ by less are the same: they are printed in thousandths.
_SAME: Final = 2e-3


@dataclass(frozen=True, slots=True)
class StatedPlace:
    """What the head of a program states.

    turn, tilt   of the part, degrees
    zero         on the machine, with all axes at zero, mm; None: it is not stated
    tool_length  for which the zero holds, mm; None: it is not stated
    """

    turn: float
    tilt: float
    zero: Vector | None = None
    tool_length: float | None = None


def placed_notices(
    turn: float, tilt: float, zero: Vector | None = None, tool_length: float | None = None
) -> tuple[str, ...]:
    """Comments for the head of a program: how the part is clamped, degrees, and where its zero (3,) is, mm.

    ``tool_length`` is the one that the slides are planned with, mm; None: none was stated, and 0 was taken.
    """
    return (*_clamped(turn, tilt), *([] if zero is None else _zero(zero, tool_length)))


def _clamped(turn: float, tilt: float) -> Iterator[str]:
    turn %= 360.0
    if tilt:
        side = "UP" if tilt > 0.0 else "DOWN"
        yield f"{TILTED_NOTICE} {number(tilt)} DEG FIRST, ABOUT ITS X, RIGHT-HANDED, ITS +Y SIDE {side}"
    if turn or tilt:
        yield f"{TURNED_NOTICE} {number(turn)} DEG ABOUT Z, COUNTER-CLOCKWISE SEEN FROM ABOVE, FROM +Z"
    else:
        yield f"{DRAWN_NOTICE}, NOT TURNED"


def _zero(zero: Vector, tool_length: float | None) -> Iterator[str]:
    x, y, z = zero
    yield f"{ZERO_NOTICE}{x:.3f} Y{y:.3f} Z{z:.3f} MM ON THE MACHINE, AXES AT 0"
    if tool_length is None:
        yield f"{LENGTH_NOTICE} 0 MM: NONE WAS STATED"
    else:
        yield f"{LENGTH_NOTICE} {number(tool_length)} MM, FROM GAUGE POINT TO TIP"


def number(value: float) -> str:
    """Degrees or mm in thousandths, as short as they can be written."""
    return f"{round(value, 3) + 0.0:.3f}".rstrip("0").removesuffix(".")


def carried_notices(program: Path) -> tuple[str, ...]:
    """Comments on how its part is clamped for a program that is made of another one, if that states it."""
    stated = stated_place(program)
    return () if stated is None else tuple(_clamped(stated.turn, stated.tilt))


def unlike_head(program: Path, turn: float, tilt: float, machine: Machine | None = None) -> list[Problem]:
    """Warnings where a head says otherwise how its part is clamped, degrees, for who compares it with CL files.

    With a ``machine`` also where zero and tool length are others than those of the machine.
    """
    stated = stated_place(program)
    if stated is None:
        return []
    found = [] if machine is None else _other_zero(program, stated, machine)
    if not _is_clamped_so(stated, turn, tilt):
        cure = f"give {_told(stated)}, so that the CL files are turned before they are compared"
        found.insert(0, Problem(str(program), 0, _said(stated), cure, Severity.WARNING, code="PLC220"))
    return found


def unlike_bodies(program: Path, turn: float, tilt: float, machine: Machine) -> list[Problem]:
    """As ``unlike_head``, for who simulates the program with bodies that are turned so."""
    stated = stated_place(program)
    if stated is None:
        return []
    found = _other_zero(program, stated, machine)
    if not _is_clamped_so(stated, turn, tilt):
        cure = f"give {_told(stated)}, so that stock, part and fixtures are turned; or give them as they are clamped"
        found.insert(0, Problem(str(program), 0, _said(stated), cure, Severity.WARNING, code="PLC230"))
    return found


def _is_clamped_so(stated: StatedPlace, turn: float, tilt: float) -> bool:
    off = abs((stated.turn - turn + 180.0) % 360.0 - 180.0)
    return off < _SAME and abs(stated.tilt - tilt) < _SAME


def _other_zero(program: Path, stated: StatedPlace, machine: Machine) -> list[Problem]:
    """A warning where zero or tool length of the machine are known, and the head states others."""
    said = []
    zero, length = machine.workpiece_zero, machine.tool_length
    if stated.zero is not None and zero is not None and math.dist(stated.zero, zero) >= _SAME:
        said.append(f"the workpiece zero is at {','.join(map(number, stated.zero))}")
    if stated.tool_length is not None and length is not None and abs(stated.tool_length - length) >= _SAME:
        said.append(f"its zero holds for a tool length of {number(stated.tool_length)} mm")
    if not said:
        return []
    given = [*([] if zero is None else [f"zero {','.join(map(number, zero))}"])]
    given += [] if length is None else [f"tool length {number(length)}"]
    what = f"its head says that {' and that '.join(said)}, and the slides are judged with {' and '.join(given)}"
    cure = "give those of the head, or make sure that the program keeps the limits there as well"
    return [Problem(str(program), 0, what, cure, Severity.WARNING, code="PLC240")]


def _told(stated: StatedPlace) -> str:
    """The angles, as somebody is told to give them."""
    if stated.turn == stated.tilt == 0.0:
        return "no turn and no tilt"
    return f"the turn {number(stated.turn)}" + (f" and the tilt {number(stated.tilt)}" if stated.tilt else "")


def _said(stated: StatedPlace) -> str:
    """What a head says of its part, in words."""
    if stated.turn == stated.tilt == 0.0:
        return "its head says that the part is clamped as it is drawn"
    tilted = f"tilted by {number(stated.tilt)} degrees about X and " if stated.tilt else ""
    return f"its head says that the part is {tilted}turned by {number(stated.turn)} degrees about Z"


def stated_place(program: Path) -> StatedPlace | None:
    """What the head of a program states of its part; None: nothing."""
    if not program.is_file():  # what a pipe holds can be read once
        return None
    try:
        with program.open("rb") as stream:
            head = stream.read(_HEAD).decode("latin-1").upper()
    except OSError:
        return None
    turn, tilt = (re.search(rf"{words}\s+{_VALUE}\s+DEG", head) for words in (TURNED_NOTICE, TILTED_NOTICE))
    if turn is None and DRAWN_NOTICE not in head:
        return None
    zero = re.search(rf"{ZERO_NOTICE}{_VALUE}\s+Y{_VALUE}\s+Z{_VALUE}\s+MM", head)
    length = re.search(rf"{LENGTH_NOTICE}\s+{_VALUE}\s+MM,", head)
    return StatedPlace(
        turn=0.0 if turn is None else float(turn[1]),
        tilt=0.0 if tilt is None else float(tilt[1]),
        zero=None if zero is None else (float(zero[1]), float(zero[2]), float(zero[3])),
        tool_length=None if length is None else float(length[1]),
    )
