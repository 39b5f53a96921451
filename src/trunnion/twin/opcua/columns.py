"""The values that a twin publishes, by name, from what the machine shows at some times.

In:     ``Snapshots``, and the feed override.
Out:    for each name a list with a value for each time; None where it is not known.

``axis.NAME.WHAT`` are values of the machine's axes, ``tip.AXIS.WHAT`` those of the tool tip in the workpiece frame;
``geo.AXIS.WHAT`` what a control shows of its geometry axes: the tip under TCP, else the slides.
"""

import math
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from asyncua import ua

from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.twin.snapshots import Snapshots, TwinProgram, displayed

#: Axes of the workpiece frame.
FRAME: Final = ("X", "Y", "Z")

#: Derivatives of what axes show.
RATES: Final = ("velocity", "acceleration", "jerk")

#: A switch at the end of the travel is on from here, mm or degrees before it.
AT_LIMIT: Final = 1e-6

Columns = dict[str, Sequence[Any]]

# CncAxisStatus, CncSpindleStatus and CncSpindleTurnDirection of OPC 40502.
_IN_POSITION, _MOVING = 0, 1
_SPINDLE_STOPPED, _SPINDLE_IN_TARGET, _SPINDLE_ACCELERATING, _SPINDLE_DECELERATING = 0, 1, 2, 3
_NO_TURN, _CLOCKWISE, _COUNTER_CLOCKWISE = 0, 1, 2

#: A spindle within this of its programmed speed has reached it, rev/min.
_SPEED_REACHED: Final = 0.5


def machine_axes(machine: Machine) -> tuple[tuple[str, int], ...]:
    """Names and columns of the axes as a control numbers them: slides by their letters, then rotary axes."""
    slides = sorted((machine.names[k], k) for k in machine.linear)
    rotary = sorted((machine.names[k], k) for k in machine.own_rotary)
    return (*slides, *rotary)


def columns_of(program: TwinProgram, snapshots: Snapshots) -> Columns:
    """Return the values of all names at the times of snapshots."""
    found: Columns = {}
    machine = program.machine
    for name, column in machine_axes(machine):
        shown = displayed(machine, column, snapshots.joints[:, column])
        actual, to_go = _known(shown), _known(snapshots.remaining[:, column])
        found |= _position(f"axis.{name}", actual, to_go)
        for what, values in zip(RATES, snapshots.rates[:, :, column].T, strict=True):
            found[f"axis.{name}.{what}"] = _known(values)
        found |= _switches(machine, column, f"axis.{name}", snapshots.joints[:, column])
        found[f"axis.{name}.status"] = [_MOVING if moves else _IN_POSITION for moves in snapshots.moving[:, column]]
    for k, name in enumerate(FRAME):
        found |= _position(f"tip.{name}", _known(snapshots.tip[:, k]), _known(snapshots.to_go[:, k]))
    tcp = np.array([block.tcp for block in snapshots.blocks], np.bool_)
    slides = {machine.names[k]: k for k in machine.linear}
    for k, name in enumerate(FRAME):
        column = slides.get(name, machine.linear[k])
        found[f"geo.{name}.actual"] = _known(np.where(tcp, snapshots.tip[:, k], snapshots.joints[:, column]))
        found[f"geo.{name}.to_go"] = _known(np.where(tcp, snapshots.to_go[:, k], snapshots.remaining[:, column]))
    return found | _spindle(snapshots) | _blocks(program, snapshots)


def _switches(machine: Machine, column: int, name: str, joints: Floats) -> Columns:
    """Whether an axis stands at an end of its travel; nothing where nobody knows where in it the axis stands."""
    axis = machine.axes[column]
    if not axis.has_limits or not machine.is_placed(column):
        return {}
    return {
        f"{name}.at_minus": (joints <= axis.low + AT_LIMIT).tolist(),
        f"{name}.at_plus": (joints >= axis.high - AT_LIMIT).tolist(),
    }


def _known(values: Floats) -> list[float | None]:
    """Numbers of Python; None for those that are not known."""
    return [value if math.isfinite(value) else None for value in values.tolist()]


def _position(name: str, actual: Sequence[float | None], to_go: Sequence[float | None]) -> Columns:
    struct = getattr(ua, "CncPositionDataType")  # noqa: B009 - made when the NodeSet is loaded
    whole = [
        struct(ActPos=act, CmdPos=act, RemDist=left) if act is not None and left is not None else None
        for act, left in zip(actual, to_go, strict=True)
    ]
    return {f"{name}.position": whole, f"{name}.actual": actual, f"{name}.to_go": to_go}


def _spindle(snapshots: Snapshots) -> Columns:
    rpm = snapshots.rpm.tolist()
    wanted = snapshots.told_rpm.tolist()
    status = []
    for actual, target in zip(rpm, wanted, strict=True):
        reached = abs(actual - target) <= _SPEED_REACHED
        faster = abs(actual) < abs(target) and actual * target >= 0.0
        moves = _SPINDLE_ACCELERATING if faster else _SPINDLE_DECELERATING
        still = _SPINDLE_IN_TARGET if target else _SPINDLE_STOPPED
        status.append(still if reached else moves)
    return {
        "spindle.actual": [abs(value) for value in rpm],
        "spindle.commanded": [abs(value) for value in wanted],
        "spindle.turning": [abs(value) > 0.0 for value in rpm],
        "spindle.status": status,
        "spindle.direction": [
            _CLOCKWISE if value > 0.0 else _COUNTER_CLOCKWISE if value < 0.0 else _NO_TURN for value in rpm
        ],
    }


def _blocks(program: TwinProgram, snapshots: Snapshots) -> Columns:
    blocks = snapshots.blocks
    return {
        "program.seconds": snapshots.seconds.tolist(),
        "program.row": snapshots.row.tolist(),
        "program.feed": snapshots.feed.tolist(),
        "block.feed": [block.feed for block in blocks],
        "block.texts": [list(block.blocks) for block in blocks],
        "block.before": [block.blocks[0] for block in blocks],
        "block.this": [block.blocks[1] for block in blocks],
        "block.after": [block.blocks[2] for block in blocks],
        "block.number": [block.number for block in blocks],
        "block.line": [block.line for block in blocks],
        "block.file": [block.file for block in blocks],
        "block.g": [list(block.g) for block in blocks],
        "block.m": [list(block.m) for block in blocks],
        "block.tool": [block.tool for block in blocks],
        "block.has_tool": [bool(block.tool) for block in blocks],
        "block.door": [block.door for block in blocks],
        "block.clamp": [block.clamp for block in blocks],
        "block.tool_number": [program.tool_number(block.tool) for block in blocks],
    }
