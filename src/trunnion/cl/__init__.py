"""Readers of cutter-location files: an NX CLSF becomes a ``trunnion.model.toolpath.Toolpath``."""

from trunnion.cl.read import read_cl
from trunnion.cl.scan import fill_modal_axes, scan
from trunnion.cl.unknown import statement_words, unknown_statement_problems

#: Kernels that every file needs.
KERNELS = (scan, fill_modal_axes)

__all__ = ["KERNELS", "read_cl", "statement_words", "unknown_statement_problems"]
