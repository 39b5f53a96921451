"""Simulation: stock, tools and machine as bodies, and what a program cuts and hits with them."""

from trunnion.simulation.cutting.cut_kernel import bin_sweeps, cut_tile
from trunnion.simulation.simulator import simulate
from trunnion.simulation.stock.solids import check_cell

#: The kernels that every simulation needs, in the order in which it needs them.
KERNELS = (bin_sweeps, cut_tile)

__all__ = ["KERNELS", "check_cell", "simulate"]
