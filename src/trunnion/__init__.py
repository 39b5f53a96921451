"""Trunnion: cutter-location files to proven NC programs for five-axis machine tools."""

__version__ = "0.1.0"
