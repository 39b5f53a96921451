"""Figures of a program for the summary: plain numbers and texts, as JSON has them.

Units:  seconds, mm, degrees; margins as in ``reporting.extents``.
"""

import math
from collections.abc import Iterable, Sequence
from typing import Any, Final

import numpy as np

from trunnion.arrays import distinct
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.model.arc_extremes import RunArcs
from trunnion.model.toolpath import Toolpath
from trunnion.reporting.extents import axis_extent
from trunnion.results import to_data
from trunnion.verification import Check, Verification

#: Digits behind the point, of mm, degrees and seconds.
_DECIMALS: Final = 6

#: What is said of an axis.
_OF_AXIS: Final = ("unit", "low", "high", "margin", "zero_known")


def point_count(toolpaths: Iterable[Toolpath]) -> int:
    """CL points of toolpaths."""
    return sum(len(operation.moves) for toolpath in toolpaths for operation in toolpath.operations)


def block_count(programs: Iterable[bytes]) -> int:
    """Lines of programs that are not blank."""
    return sum(1 for each in programs for line in each.splitlines() if line.strip())


def verification_figures(found: Verification) -> dict[str, Any]:
    """Of a program that was run and checked, with the columns of the verification."""
    run = found.run
    arcs = RunArcs.of(run)
    axes = [axis_extent(run, k, axis, arcs) for k, axis in run.machine.own_columns]
    return {
        "motions": len(run),
        "tools": sorted({run.tools[int(index)] for index in distinct(run.tool)} - {""}),
        "seconds": _rounded(float(np.nansum(found.seconds))) if len(found.seconds) else None,
        "axes": {each.name: to_data(each, decimals=_DECIMALS, only=_OF_AXIS) for each in axes},
        "margin_mm": _least(each.margin for each in axes if each.unit == "mm" and each.zero_known),
        "margin_deg": _least(each.margin for each in axes if each.unit != "mm"),
        "tip_deviation_mm": _worst_of(found.checks, "tip"),
        "axis_deviation_deg": _worst_of(found.checks, "axis"),
        "failed_checks": [check.key for check in found.checks if not check.passed],
    }


def simulation_figures(found: SimulationResult) -> dict[str, Any]:
    """Of a program that cut stock."""
    return {
        "seconds": _rounded(sum(each.seconds for each in found.operations)),
        "tools": sorted({each.tool for each in found.operations}),
        "removed_mm3": _rounded(found.removed),
        "findings": len(found.findings),
        "gouge_mm": None if found.gouge is None else _rounded(found.gouge.largest),
    }


def _worst_of(checks: Sequence[Check], key: str) -> float | None:
    return next((_rounded(check.worst) for check in checks if check.key == key), None)


def _least(values: Iterable[float | None]) -> float | None:
    return _rounded(min((value for value in values if value is not None), default=None))


def _rounded(value: float | None) -> float | None:
    if value is None or not math.isfinite(value):
        return None
    return round(value, _DECIMALS) + 0.0
