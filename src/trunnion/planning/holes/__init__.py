"""Hole-making cycles: what they ask for, and holes as motion."""
