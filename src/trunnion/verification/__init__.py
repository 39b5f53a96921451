"""Verification: a program, read back and run by itself, against what was wanted of it."""

from trunnion.machines.forward import axis_rows
from trunnion.verification.comparison import Comparison, Difference, compare
from trunnion.verification.context import Settings
from trunnion.verification.kinematics.axis_motion import walk_rows
from trunnion.verification.kinematics.point_deviations import compare_rows
from trunnion.verification.kinematics.rapid_feeds import with_rapids
from trunnion.verification.matching.expected_path import Agreed, Allowed
from trunnion.verification.results import Check, Place, Share, Verification
from trunnion.verification.text import check_lines, failures, place_line, place_lines, time_lines
from trunnion.verification.verifier import verify

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
