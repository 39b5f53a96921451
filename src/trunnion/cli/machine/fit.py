"""``trunnion fit``: which machines can run CL files or an NC program."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

from trunnion.cli.columns import columns_of, padded
from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import in_words, line, together
from trunnion.jobs.capability.fitting import AxisMargin, FitStatus, MachineFit, fit
from trunnion.jobs.job import Given
from trunnion.messages import phrase, word_said
from trunnion.wording import format_duration

#: Columns that a status has at least.
_OF_STATUS: Final = 12


def run(given: Given) -> int:
    """Ask the machines; 0 if one of them can run it, else 1."""
    found = fit(**given.arguments(), observer=Terminal())
    show(given, lambda: {"schema": 1, "machines": found}, fit_lines(found))
    return 0 if any(each.status is not FitStatus.NOT for each in found) else 1


def fit_lines(found: Sequence[MachineFit]) -> Iterator[str]:
    """Yield the machines in their order, each with what it makes of it."""
    wide = max(len(each.key) for each in found)
    words = {status: in_words(word_said(status)) for status in FitStatus}
    of_status = max(_OF_STATUS, *map(columns_of, words.values()))
    if any(each.zero_mm is not None and each.status is not FitStatus.NOT for each in found):
        yield line("fit_legend")
    for each in found:
        yield f"{each.key:<{wide}}  {padded(words[each.status], of_status)}  {_facts(each)}".rstrip()
        for reason in each.why:
            yield f"{'':<{wide}}  {in_words(reason)}"
        if each.unmeasured:
            yield f"{'':<{wide}}  {in_words(phrase('stands_on', values=each.unmeasured))}"


def _facts(each: MachineFit) -> str:
    """Time, place and margins, as far as there are any."""
    facts = [] if each.seconds is None else [format_duration(each.seconds)]
    if each.zero_mm is not None and each.status is not FitStatus.NOT:
        zero = ",".join(f"{part:.3f}" for part in each.zero_mm)
        facts.append(
            line("fit_zero_turned", zero=zero, turn=each.turn_deg) if each.turn_deg else line("fit_zero", zero=zero)
        )
    if each.status is not FitStatus.NOT:
        left = tuple(_margin(margin) for margin in each.margins if math.isfinite(margin.margin))
        facts += [line("fit_left", margins=left)] if left else []
    return together(*facts, line("fit_example") if each.is_example else "")


def _margin(margin: AxisMargin) -> str:
    unit = "°" if margin.unit == "deg" else " mm"
    return f"{margin.axis} {margin.margin:.1f}{unit}"
