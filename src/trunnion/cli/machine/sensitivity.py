"""``trunnion sensitivity``: which number of a machine's geometry a program depends on."""

import sys
from collections.abc import Iterator
from itertools import chain

from trunnion.capability.sensitivity import ErrorExtent, NumberSensitivity, Sensitivity
from trunnion.cli.columns import table, width_of
from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import spoken
from trunnion.jobs.capability.sensitivity import sensitivity
from trunnion.jobs.capability.sensitivity_report import (
    amount_text,
    place_text,
    write_sensitivity_report,
    zero_text,
)
from trunnion.jobs.job import Given
from trunnion.wording import counted


def run(given: Given) -> int:
    """Rank the numbers, print and draw them."""
    terminal = Terminal()
    found = sensitivity(**given.arguments(), observer=terminal)
    terminal.problems(found.remarks)
    if given.report is not None:
        write_sensitivity_report(found, given.report, given.read, spoken())
    show(given, lambda: found, sensitivity_lines(found))
    return 0


def sensitivity_lines(found: Sensitivity) -> Iterator[str]:
    """Yield a sensitivity as a table."""
    yield f"{found.run.files[0]}: {counted(found.motions, 'motion')} at feed; workpiece zero {_zero_words(found)}"
    yield (
        "errors of the tip in mm: the largest, with its block (at), and the root of the mean square over all motions"
        " (rms); axis deg: the largest of the tool axis"
    )
    if found.zero_at is not None:
        yield "zero set: what is on the part after the workpiece zero was set with the same error; as it is: all of it"
    zeroed = ("zero set: mm", "at", "rms") if found.zero_at is not None else ()
    heads = ("number", "off by", *zeroed, "as it is: mm", "at", "rms", "axis deg")
    numbers = frozenset(column for column, head in enumerate(heads) if head not in ("number", "at"))
    yield from table([heads, *(_cells(each, found) for each in found.numbers)], width_of(sys.stdout), numbers)
    if found.idle:
        yield "without effect: " + ", ".join(number.name for number in found.idle)


def _zero_words(found: Sensitivity) -> str:
    return "not set" if found.zero_at is None else f"set {zero_text(found.zero_at)}"


def _cells(each: NumberSensitivity, found: Sensitivity) -> tuple[str, ...]:
    extents = (_extent(part, found) for part in (each.zeroed, each.tip) if part is not None)
    axis = f"{each.axis_deg:.6f}" if each.axis_deg else "-"
    return (each.number.name, amount_text(each), *chain.from_iterable(extents), axis)


def _extent(extent: ErrorExtent, found: Sensitivity) -> tuple[str, str, str]:
    return f"{extent.largest:.5f}", place_text(extent, found.run), f"{extent.rms:.5f}"
