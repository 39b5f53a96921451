"""Machines: the chain of axes from the workpiece to the tool, as data, and its mathematics, which is one for all.

``load_machine`` reads a definition, ``forward`` says where the tool is, ``inverse`` where the axes must be. Kernels of
other rooms use ``trunnion.machines.inverse.pack`` with ``solve_point`` and ``solve_slides``.
"""

from trunnion.machines.forward import forward, tool_axes
from trunnion.machines.inverse import Packed, Solutions, inverse, pack, slide_positions
from trunnion.machines.loading import load_machine, shipped
from trunnion.machines.machine import Axis, AxisKind, Carries, Facts, Machine, Output, Positive, Prefer

__all__ = [
    "Axis",
    "AxisKind",
    "Carries",
    "Facts",
    "Machine",
    "Output",
    "Packed",
    "Positive",
    "Prefer",
    "Solutions",
    "forward",
    "inverse",
    "load_machine",
    "pack",
    "shipped",
    "slide_positions",
    "tool_axes",
]
