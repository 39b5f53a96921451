"""Trunnion: cutter-location files to proven NC programs for five-axis machine tools."""

from pathlib import Path

from trunnion.compiled import keep_kernels

__version__ = "0.1.0"

keep_kernels(Path(__file__).parent)
