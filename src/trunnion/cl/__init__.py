"""Readers of cutter-location files: an NX CLSF becomes a ``trunnion.model.toolpath.Toolpath``."""

from trunnion.cl.read import read_cl

__all__ = ["read_cl"]
