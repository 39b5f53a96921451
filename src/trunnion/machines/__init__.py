"""Machines: the chain of axes from the workpiece to the tool as data, and the same kinematics for all of them.

``load_machine`` reads a definition. ``forward`` gives the tool for axis values, ``inverse`` the axis values for a tool.
Kernels of other packages use ``kinematic_parameters`` with the kernels of ``trunnion.machines.inverse``.
"""

from trunnion.machines.bodies import BodyBox, BodyCylinder, BodyFile, MachineBody
from trunnion.machines.forward import forward, tool_axes
from trunnion.machines.inverse import (
    InverseSolutions,
    KinematicParameters,
    inverse,
    kinematic_parameters,
    slide_positions,
)
from trunnion.machines.links import link_transforms
from trunnion.machines.loading import load_machine, shipped_machines
from trunnion.machines.machine import (
    AngleOutput,
    Axis,
    AxisKind,
    Machine,
    MachineFacts,
    Mount,
    PositiveDirection,
    PreferredSign,
)
from trunnion.machines.spindle_range import spindle_speed_fault, states_spindle_range
from trunnion.machines.turn_clearance import SAFE_DISTANCE, SweptPart, turn_clearance, turns_part_alone

__all__ = [
    "SAFE_DISTANCE",
    "AngleOutput",
    "Axis",
    "AxisKind",
    "BodyBox",
    "BodyCylinder",
    "BodyFile",
    "InverseSolutions",
    "KinematicParameters",
    "Machine",
    "MachineBody",
    "MachineFacts",
    "Mount",
    "PositiveDirection",
    "PreferredSign",
    "SweptPart",
    "forward",
    "inverse",
    "kinematic_parameters",
    "link_transforms",
    "load_machine",
    "shipped_machines",
    "slide_positions",
    "spindle_speed_fault",
    "states_spindle_range",
    "tool_axes",
    "turn_clearance",
    "turns_part_alone",
]
