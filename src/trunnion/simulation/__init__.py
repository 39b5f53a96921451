"""Simulation: stock, tools and machine as bodies, and what a program cuts and hits with them."""

from trunnion.simulation.cutting.cut_kernel import bin_sweeps, cut_tile
from trunnion.simulation.meshes.picture import draw_triangles
from trunnion.simulation.simulator import simulate
from trunnion.simulation.stock.differences import common_stretches, difference_stretches, thinner_here
from trunnion.simulation.stock.solids import check_cell
from trunnion.simulation.stock.spans import mesh_crossings, pair_crossings
from trunnion.simulation.stock.surface import fill_centres, nearest_ends

#: The kernels that every simulation needs, in the order in which it needs them; the last one is by far the largest.
KERNELS = (bin_sweeps, cut_tile)

#: Those that a design needs besides.
DESIGN_KERNELS = (mesh_crossings, pair_crossings, common_stretches, difference_stretches, thinner_here)

#: Those that a mesh or a picture of the finished stock needs besides.
SURFACE_KERNELS = (fill_centres, nearest_ends, draw_triangles)

__all__ = ["DESIGN_KERNELS", "KERNELS", "SURFACE_KERNELS", "check_cell", "simulate"]
