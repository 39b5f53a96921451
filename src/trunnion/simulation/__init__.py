"""Simulation: stock, tools and machine as bodies, and what a program cuts and hits with them."""

from trunnion.simulation.simulator import simulate
from trunnion.simulation.stock.solids import check_cell

__all__ = ["check_cell", "simulate"]
