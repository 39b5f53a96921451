"""Cures of messages about CL files."""
