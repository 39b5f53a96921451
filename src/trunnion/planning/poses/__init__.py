"""Poses for a whole operation: states, dynamic programming, positions, and the decision log."""
