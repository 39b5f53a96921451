"""Verification: a program that was read back and run, against the CL files that it was made from."""

from trunnion import timing
from trunnion.machines.forward import tool_axis_rows
from trunnion.verification.basis import stated_texts
from trunnion.verification.context import ExpectedValues
from trunnion.verification.deviations.linearization import write_linearization_errors
from trunnion.verification.deviations.point_deviations import compare_rows
from trunnion.verification.expected.path import OperationSettings
from trunnion.verification.expected.printed_planes import PrintedDigits, tolerances_in_planes
from trunnion.verification.expected.tolerances import Tolerances
from trunnion.verification.kinematics.axis_motion_kernel import axis_motion_rows
from trunnion.verification.kinematics.rapid_feeds import restore_rapids
from trunnion.verification.results import (
    Check,
    OperationRows,
    Place,
    State,
    Verification,
    durations,
    rows_from_starts,
    without_columns,
)
from trunnion.verification.standing import Standing, Verdict
from trunnion.verification.text import check_lines, failures, place_line, place_lines, stand_lines, time_lines
from trunnion.verification.verifier import reachable_feeds, verify, with_recording

#: Kernels that every program needs.
KERNELS = (tool_axis_rows, axis_motion_rows, compare_rows, write_linearization_errors, *timing.KERNELS)

__all__ = [
    "KERNELS",
    "Check",
    "ExpectedValues",
    "OperationRows",
    "OperationSettings",
    "Place",
    "PrintedDigits",
    "Standing",
    "State",
    "Tolerances",
    "Verdict",
    "Verification",
    "check_lines",
    "durations",
    "failures",
    "place_line",
    "place_lines",
    "reachable_feeds",
    "restore_rapids",
    "rows_from_starts",
    "stand_lines",
    "stated_texts",
    "time_lines",
    "tolerances_in_planes",
    "verify",
    "with_recording",
    "without_columns",
]
