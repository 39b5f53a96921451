"""Readers of cutter-location files: a file of any dialect becomes a ``trunnion.model.toolpath.Toolpath``."""

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialects import DIALECTS
from trunnion.cl.read import ClReading, read_cl, read_cl_files
from trunnion.cl.scan import fill_modal_axes, scan
from trunnion.cl.sources import is_cl_file, not_one_file
from trunnion.cl.systems import other_system
from trunnion.cl.unknown import (
    shop_statement,
    statement_words,
    unknown_statement_errors,
    unknown_statement_remarks,
    unknown_statements,
)
from trunnion.cl.word_events import can_be_unknown, events_of

#: Kernels that every file needs.
KERNELS = (scan, fill_modal_axes)

__all__ = [
    "DIALECTS",
    "KERNELS",
    "ClReading",
    "StatementError",
    "can_be_unknown",
    "events_of",
    "is_cl_file",
    "not_one_file",
    "other_system",
    "read_cl",
    "read_cl_files",
    "shop_statement",
    "statement_words",
    "unknown_statement_errors",
    "unknown_statement_remarks",
    "unknown_statements",
]
