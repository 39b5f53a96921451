"""What the head of a program says of a part that is clamped otherwise than it is drawn, and of its zero.

The head is what stands before the first block that does something. What it says is held against what is given wherever
the program is compared or simulated.
"""

import math
from pathlib import Path
from typing import Final

from trunnion.errors import Problem, warning
from trunnion.machines import Machine
from trunnion.machines.machine import Vector
from trunnion.messages import Wording, phrase
from trunnion.model.clamping import SAME, Clamping, are_one_angle, number
from trunnion.model.clamping_notices import (
    HeadNotices,
    clamped_notices,
    head_comments,
    read_place,
    read_places_without_tcp,
    zero_notices,
)

#: So much of a program is its head at most, bytes.
_HEAD: Final = 1 << 16


def placed_notices(clamping: Clamping, zero: Vector | None = None, tool_length: float | None = None) -> tuple[str, ...]:
    """Comments for the head of a program: how the part is clamped, and where its zero (3,) is, mm.

    ``tool_length`` is the one that the slides are planned with, mm; None: none was stated, and 0 was taken.
    """
    return (*clamped_notices(clamping), *([] if zero is None else zero_notices(zero, tool_length)))


def stated_place(program: Path) -> HeadNotices:
    """Return what the head of a program states of its part; nothing where it cannot be read twice, as what a pipe
    holds.
    """
    if not program.is_file():
        return HeadNotices()
    try:
        with program.open("rb") as stream:
            head = stream.read(_HEAD).decode("latin-1")
    except OSError:
        return HeadNotices()
    return read_place(list(head_comments(enumerate(head.splitlines(), 1))))


def place_without_tcp(program: Path) -> tuple[Vector, float] | None:
    """Return the workpiece zero and the tool length, mm, for which a program without TCP was written; None: it states
    none, or several.
    """
    if not program.is_file():
        return None
    with program.open("rb") as stream:
        found = read_places_without_tcp(line.decode("latin-1").rstrip() for line in stream)
    if len(found) != 1:
        return None
    x, y, z, length = found.pop()
    return (x, y, z), length


def damaged_notices(program: Path, stated: HeadNotices) -> list[Problem]:
    """Warnings of notices that are not as they were written, or that contradict each other."""
    return [
        warning(str(program), line, Wording("PLC250", "damaged_in_program", fault=fault))
        for line, fault in stated.faults
    ]


def unlike_cl_files(
    program: Path, given: Clamping, clamped: Clamping, of_cl: Clamping | None, machine: Machine
) -> list[Problem]:
    """Warnings for who compares a program with CL files where its head says otherwise how its part is clamped.

    given    turn and tilt by which the CL files are turned before they are compared
    clamped  how the part is clamped then: as the CL files state, and turned by what is given
    of_cl    what the CL files state; None: nothing
    machine  where its zero and tool length are known, those of the head are held against them
    """
    stated = stated_place(program)
    found = _unlike_zero(program, stated, machine)
    if stated.clamping is not None and not stated.clamping.is_like(clamped):
        remedy = _remedy_of_comparison(stated.clamping, of_cl or Clamping())
        own = stated.clamping
        if of_cl is None:
            wording = Wording("PLC220", "clamped_otherwise", own=own, remedy=remedy)
        elif are_one_angle(given.turn, 0.0) and are_one_angle(given.tilt, 0.0):
            wording = Wording("PLC220", "clamped_otherwise_than_cl_file", own=own, of_cl=of_cl, remedy=remedy)
        else:
            wording = Wording(
                "PLC220", "clamped_otherwise_than_given", own=own, of_cl=of_cl, given=clamped, remedy=remedy
            )
        found.insert(0, warning(str(program), 0, wording))
    return found


def _remedy_of_comparison(stated: Clamping, of_cl: Clamping) -> Wording:
    """Which angles bring the CL files to how the part is clamped, if any do: a phrase."""
    turn, tilt = (stated.turn - of_cl.turn) % 360.0, stated.tilt - of_cl.tilt
    reached = of_cl.then(turn, tilt)
    if reached is None or not reached.is_like(stated):
        turn = stated.turn
        reached = of_cl.then(turn, tilt)
    if reached is None or not reached.is_like(stated):
        return phrase("no_angles_between")
    return phrase("give_angles", angles=_told(turn, tilt))


def unlike_bodies(program: Path, given: Clamping, machine: Machine) -> list[Problem]:
    """Warnings for who simulates a program with bodies as they are drawn, which are clamped as it is ``given``."""
    stated = stated_place(program)
    found = _unlike_zero(program, stated, machine)
    if stated.clamping is not None and not stated.clamping.is_like(given):
        told = _told(stated.clamping.turn, stated.clamping.tilt)
        found.insert(
            0,
            warning(str(program), 0, Wording("PLC230", "head_says_part", clamping=stated.clamping, told=told)),
        )
    return found


def unlike_zero(program: Path, machine: Machine) -> list[Problem]:
    """Warnings where a head is damaged, or where the machine has another zero or tool length than it states."""
    return _unlike_zero(program, stated_place(program), machine)


def _unlike_zero(program: Path, stated: HeadNotices, machine: Machine) -> list[Problem]:
    found, said = damaged_notices(program, stated), []
    zero, length = machine.workpiece_zero, machine.tool_length
    if stated.zero is not None and zero is not None and math.dist(stated.zero, zero) >= SAME:
        said.append(f"the workpiece zero is at {','.join(map(number, stated.zero))}")
    if stated.tool_length is not None and length is not None and abs(stated.tool_length - length) >= SAME:
        said.append(f"its zero holds for a tool length of {number(stated.tool_length)} mm")
    if not said:
        return found
    given = [*([] if zero is None else [f"zero {','.join(map(number, zero))}"])]
    given += [] if length is None else [f"tool length {number(length)}"]
    return [
        *found,
        warning(str(program), 0, Wording("PLC240", "head_says_slides", said=tuple(said), given=tuple(given))),
    ]


def _told(turn: float, tilt: float) -> Wording:
    """Return the angles, as somebody is told to give them: a phrase."""
    if are_one_angle(turn, 0.0) and are_one_angle(tilt, 0.0):
        return phrase("no_turn_and_no_tilt")
    if are_one_angle(tilt, 0.0):
        return phrase("turn_alone", turn=number(turn % 360.0))
    return phrase("turn_and_tilt", turn=number(turn % 360.0), tilt=number(tilt))
