"""Tolerances within which the control may round off the path (CYCLE832, cycle 32, G64 P), against the CAM's."""

import math
from bisect import bisect_right
from collections.abc import Iterator
from typing import Final

from trunnion.messages import Wording, phrase
from trunnion.verification.context import ComparedContext, Context
from trunnion.verification.results import Place

#: Nothing is cut within a wider tolerance, mm.
WIDEST: Final = 0.5

#: Words by which programs state such a tolerance.
_WORDS: Final = ("CYCLE832", "CYCL DEF 32", "G64 P")

#: With a CL file: so many times INTOL and OUTTOL together, or this much, mm.
CAM_TOLERANCES: Final = 3.0
LEAST: Final = 0.05


def wide_tolerances(context: Context) -> Iterator[Place]:
    """Places that let the control leave the path farther than the work can want."""
    for event in context.run.events:
        if event.kind != "tolerance" or not isinstance(event.value, float):
            continue
        limit = _limit(context, event.before_row)
        if math.isinf(event.value) and not isinstance(context, ComparedContext):
            continue  # a program's own choice, which nothing contradicts
        if event.value > limit:
            said = Wording("modal", "rounds_off", tolerance=event.value, limit=limit)
            if math.isinf(event.value):
                said = Wording("modal", "rounds_off_freely", limit=limit)
            yield context.place_of_event(event, event.value, said)


def unset_tolerances(context: ComparedContext) -> Iterator[Wording]:
    """Yield the operations that state INTOL or OUTTOL and run without a tolerance of the control, where the programs
    of the definition have a word for it.
    """
    word = next((word for word in _WORDS if any(word in text for text in context.settings.texts)), "")
    if not word:
        return
    events = [event for event in context.run.events if event.kind == "tolerance"]
    rows = [event.before_row for event in events]
    for section in context.expected.sections:
        first, end = context.matching.pair_range(section.first, section.end)
        if first == end or not (section.operation.intol or section.operation.outtol):
            continue
        k = bisect_right(rows, int(context.matching.nc[end - 1]))
        if not k or not events[k - 1].value:
            yield phrase("unset_tolerance", word=word, operation=section.operation.name)


def _limit(context: Context, row: int) -> float:
    """Return the widest tolerance for the motions from a row on, mm."""
    if not isinstance(context, ComparedContext):
        return WIDEST
    asked = context.settings.smoothing or 0.0
    matching = context.matching
    k = matching.nc.count_before(row)
    if k >= len(matching.nc):
        return max(WIDEST, asked)
    operation = context.expected.section_at(matching.cl[k]).operation
    # An operation without them is held to what any work wants.
    stated = (operation.intol or 0.0) + (operation.outtol or 0.0)
    return max(CAM_TOLERANCES * stated, LEAST, asked)
