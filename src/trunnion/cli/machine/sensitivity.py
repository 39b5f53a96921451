"""``trunnion sensitivity``: which number of a machine's geometry a program depends on."""

import sys
from collections.abc import Iterator
from itertools import chain

from trunnion.capability.sensitivity import ErrorExtent, NumberSensitivity, Sensitivity
from trunnion.cli.columns import table, width_of
from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import in_words, line, part, spoken
from trunnion.jobs.capability.sensitivity import sensitivity
from trunnion.jobs.capability.sensitivity_report import (
    amount_text,
    place_said,
    pose_text,
    write_sensitivity_report,
)
from trunnion.jobs.job import Given
from trunnion.messages import joined


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
    zero = part("zero_not_set") if found.zero_at is None else part("zero_set_at", place=pose_text(found.zero_at))
    yield line("sensitivity_of", file=found.run.files[0], count=found.motions, zero=zero)
    yield line("error_heads")
    if found.zero_at is not None:
        yield line("zero_set_heads")
    zeroed = ("zero_set", "at", "rms") if found.zero_at is not None else ()
    heads = ("number", "off_by", *zeroed, "as_it_is", "at", "rms", "axis")
    numbers = frozenset(column for column, head in enumerate(heads) if head not in ("number", "at"))
    titles = tuple(line(f"column_{head}") for head in heads)
    yield from table([titles, *(_cells(each, found) for each in found.numbers)], width_of(sys.stdout), numbers)
    if found.idle:
        yield line("without_effect", names=tuple(number.said for number in found.idle))
    if grounds := joined(found.grounds.wordings(named=True), spoken()):
        yield grounds


def _cells(each: NumberSensitivity, found: Sensitivity) -> tuple[str, ...]:
    extents = (_extent(part, found) for part in (each.zeroed, each.tip) if part is not None)
    axis = f"{each.axis_deg:.6f}" if each.axis_deg else "-"
    return (in_words(each.number.said), amount_text(each), *chain.from_iterable(extents), axis)


def _extent(extent: ErrorExtent, found: Sensitivity) -> tuple[str, str, str]:
    return f"{extent.largest:.5f}", in_words(place_said(extent, found.run)), f"{extent.rms:.5f}"
