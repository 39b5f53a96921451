"""``trunnion fit``: which machines can run CL files or an NC program."""

import math
from collections.abc import Iterator, Sequence

from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import in_command_words
from trunnion.jobs.capability.fitting import AxisMargin, FitStatus, MachineFit, fit
from trunnion.jobs.job import Given
from trunnion.messages import phrase
from trunnion.wording import format_duration


def run(given: Given) -> int:
    """Ask the machines; 0 if one of them can run it, else 1."""
    found = fit(**given.arguments(), observer=Terminal())
    show(given, lambda: {"schema": 1, "machines": found}, fit_lines(found))
    return 0 if any(each.status is not FitStatus.NOT for each in found) else 1


def fit_lines(found: Sequence[MachineFit]) -> Iterator[str]:
    """Yield the machines in their order, each with what it makes of it."""
    wide = max(len(each.key) for each in found)
    if any(each.zero_mm is not None and each.status is not FitStatus.NOT for each in found):
        yield "zero: of the workpiece in the machine frame, X,Y,Z in mm with all axes at zero; left: to the limits"
    for each in found:
        yield f"{each.key:<{wide}}  {each.status:<12}  {_facts(each)}".rstrip()
        for reason in each.reasons:
            yield f"{'':<{wide}}  {in_command_words(reason)}"
        if each.not_measured:
            yield f"{'':<{wide}}  {phrase('stands_on', values=each.not_measured)}"


def _facts(each: MachineFit) -> str:
    """Time, place and margins, as far as there are any."""
    facts = [] if each.seconds is None else [format_duration(each.seconds)]
    if each.zero_mm is not None and each.status is not FitStatus.NOT:
        zero = ",".join(f"{part:.3f}" for part in each.zero_mm)
        facts.append(f"zero {zero}" + (f" turned {each.turn_deg:g}°" if each.turn_deg else ""))
    if each.status is not FitStatus.NOT:
        left = [_margin(margin) for margin in each.margins if math.isfinite(margin.margin)]
        facts += [f"left {', '.join(left)}"] if left else []
    return "; ".join([*facts, *(["an example, no builder's machine"] if each.is_example else [])])


def _margin(margin: AxisMargin) -> str:
    unit = "°" if margin.unit == "deg" else " mm"
    return f"{margin.axis} {margin.margin:.1f}{unit}"
