"""Hole-making cycles as blocks."""
