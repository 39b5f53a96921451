"""Verification: a program, read back and run by itself, against what was wanted of it."""

from trunnion.machine.chain import axis_rows
from trunnion.verify.case import Settings
from trunnion.verify.compare import Comparison, Difference, compare
from trunnion.verify.model import Check, Place, Share, Verification
from trunnion.verify.points import compare_rows
from trunnion.verify.rapids import with_rapids
from trunnion.verify.text import check_lines, failures, place_line, place_lines, time_lines
from trunnion.verify.verify import verify
from trunnion.verify.walk import walk_rows
from trunnion.verify.wanted import Agreed, Allowed

#: Kernels that every program needs.
KERNELS = (axis_rows, walk_rows, compare_rows)

__all__ = [
    "KERNELS",
    "Agreed",
    "Allowed",
    "Check",
    "Comparison",
    "Difference",
    "Place",
    "Settings",
    "Share",
    "Verification",
    "check_lines",
    "compare",
    "failures",
    "place_line",
    "place_lines",
    "time_lines",
    "verify",
    "with_rapids",
]
