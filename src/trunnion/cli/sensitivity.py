"""``trunnion sensitivity``: which number of a machine's geometry a program depends on."""

from collections.abc import Iterator

from trunnion.capability.sensitivity import ErrorExtent, NumberSensitivity, Sensitivity
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
    wide = max(len(each.number.name) for each in found.numbers)
    yield f"{found.run.files[0]}: {counted(found.motions, 'motion')} at feed; workpiece zero {_zero_words(found)}"
    yield (
        "errors of the tip in mm: the largest, with its block (at), and the root of the mean square over all motions"
        " (rms); axis deg: the largest of the tool axis"
    )
    if found.zero_at is not None:
        yield "zero set: what is on the part after the workpiece zero was set with the same error; as it is: all of it"
    zeroed = f"{'zero set: mm':>12}  {'at':<18} {'rms':>8}  " if found.zero_at is not None else ""
    yield f"{'number':<{wide}} {'off by':>8}  {zeroed}{'as it is: mm':>12}  {'at':<18} {'rms':>8}  axis deg"
    for each in found.numbers:
        yield _line(each, found, wide)
    if found.idle:
        yield "without effect: " + ", ".join(number.name for number in found.idle)


def _zero_words(found: Sensitivity) -> str:
    return "not set" if found.zero_at is None else f"set {zero_text(found.zero_at)}"


def _line(each: NumberSensitivity, found: Sensitivity, wide: int) -> str:
    parts = "".join(_extent(part, found) for part in (each.zeroed, each.tip) if part is not None)
    axis = f"{each.axis_deg:.6f}" if each.axis_deg else "-"
    return f"{each.number.name:<{wide}} {amount_text(each):>8}  {parts}{axis:>8}"


def _extent(extent: ErrorExtent, found: Sensitivity) -> str:
    return f"{extent.largest:>12.5f}  {place_text(extent, found.run):<18} {extent.rms:>8.5f}  "
