"""Simulation: stock, tools and machine as bodies, and what a program cuts and hits with them."""
