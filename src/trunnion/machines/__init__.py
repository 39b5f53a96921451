"""Machines: the chain of axes from the workpiece to the tool, as data, and its mathematics, which is one for all.

``load_machine`` reads a definition, ``forward`` says where the tool is, ``inverse`` where the axes must be. Kernels of
other rooms use ``trunnion.machines.inverse.kinematic_parameters`` with ``solve_point`` and ``solve_slides``.
"""

from trunnion.machines.forward import forward, tool_axes
from trunnion.machines.inverse import (
    InverseSolutions,
    KinematicParameters,
    inverse,
    kinematic_parameters,
    slide_positions,
)
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

__all__ = [
    "AngleOutput",
    "Axis",
    "AxisKind",
    "InverseSolutions",
    "KinematicParameters",
    "Machine",
    "MachineFacts",
    "Mount",
    "PositiveDirection",
    "PreferredSign",
    "forward",
    "inverse",
    "kinematic_parameters",
    "load_machine",
    "shipped_machines",
    "slide_positions",
    "tool_axes",
]
