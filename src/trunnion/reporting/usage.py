"""Times, speeds and feeds of the tools and operations of a program.

Units:  seconds, rev/min, mm/min.
"""

import math
from collections.abc import Iterator

import numpy as np

from trunnion.arrays import Flags, Floats
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.reporting.extents import BlockReference, block_reference
from trunnion.reporting.text import clean
from trunnion.results import OptionalText
from trunnion.verification.results import OperationRows


@dataclass(frozen=True, slots=True)
class ToolUsage:
    """What one tool does; ``rpm`` and ``feed`` (mm/min) are lowest and highest in cuts, None if not programmed."""

    name: str
    motions: int
    seconds: float
    cutting_seconds: float
    rapid_seconds: float
    rpm: tuple[float, float] | None
    feed: tuple[float, float] | None
    first: BlockReference


@dataclass(frozen=True, slots=True)
class OperationUsage:
    """What one operation of a CL file takes, its approach included; ``first`` is None if it has no motion."""

    name: str
    tool: str
    cl_file: OptionalText
    motions: int
    seconds: float
    cutting_seconds: float
    rapid_seconds: float
    first: BlockReference | None


def tool_usages(run: Run, seconds: Floats, moving: Floats, cutting: Flags) -> Iterator[ToolUsage]:
    """Yield the tools in the order of their first motion.

    ``seconds``, those of them in which the axes are ``moving``, and ``cutting``, (n,) each, are those of the rows.
    """
    indices, first = np.unique(run.tool, return_index=True)
    for k in np.argsort(first):
        used = run.tool == indices[k]
        cuts = used & cutting
        per_minute = cuts & (run.feed_mode == 94)
        yield ToolUsage(
            name=clean(run.tools[indices[k]]),
            motions=int(np.count_nonzero(used)),
            seconds=math.fsum(seconds[used]),
            cutting_seconds=math.fsum(moving[cuts]),
            rapid_seconds=math.fsum(moving[used & ~cutting]),
            rpm=_range(run.rpm[cuts & (run.spindle != 0)]),
            feed=_range(run.feed[per_minute]),
            first=block_reference(run, int(first[k])),
        )


def operation_usage(
    run: Run, operation: OperationRows, seconds: Floats, moving: Floats, cutting: Flags
) -> OperationUsage:
    """Return the usage of one operation; the columns, (n,) each, are those of all rows as ``tool_usages`` has them."""
    rows = slice(operation.first, operation.end)
    return OperationUsage(
        name=clean(operation.name),
        tool=clean(operation.tool),
        cl_file=clean(operation.cl_file),
        motions=operation.end - operation.first,
        seconds=math.fsum(seconds[rows]),
        cutting_seconds=math.fsum(moving[rows][cutting[rows]]),
        rapid_seconds=math.fsum(moving[rows][~cutting[rows]]),
        first=block_reference(run, _first_row(run, operation)) if operation.end > operation.first else None,
    )


def _range(values: Floats) -> tuple[float, float] | None:
    finite = values[np.isfinite(values)]
    return (float(finite.min()), float(finite.max())) if len(finite) else None


def _first_row(run: Run, operation: OperationRows) -> int:
    """Return the first row of an operation, in its own file where it has one: what ends the file before it leads to it
    too.
    """
    if operation.first == 0:
        return 0
    others = np.flatnonzero(run.file[operation.first : operation.end] != run.file[operation.first - 1])
    return operation.first + (int(others[0]) if len(others) else 0)
