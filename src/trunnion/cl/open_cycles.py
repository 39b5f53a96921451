"""Cycles that are still on where another operation begins: a line is lost, or the CAM takes them for granted.

In:     operations, of which the reader has noted the cycle that was on before them; what the user says of them.
Out:    operations that drill on, and those before which the cycle has ended; an error where nobody says which.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from typing import Final

from trunnion.cl.builder import OperationBuilder
from trunnion.cl.diagnostics import Diagnostics
from trunnion.messages import Wording
from trunnion.model.toolpath import CutterComp, CycleOff, CycleOn


class OpenCycle(StrEnum):
    """What becomes of a cycle that is on where an operation begins.

    ENDS     it has ended: all points before are holes, and none behind
    GOES_ON  the points of the operation are holes of it
    """

    ENDS = "ends"
    GOES_ON = "goes_on"


#: The message of an operation of which nobody says it, by what it looks like.
_ASKED: Final = {OpenCycle.ENDS: "cycle_line_still_where", OpenCycle.GOES_ON: "cycle_line_still_holes"}

#: The remark where somebody does.
_SETTLED: Final = {OpenCycle.ENDS: "cycle_ends_as_stated", OpenCycle.GOES_ON: "cycle_goes_on_as_stated"}


def open_cycles(text: str) -> dict[str, OpenCycle]:
    """Return what the setting ``open_cycle`` states, by operation; that of all others has no name. What is no value is
    left out: the check of the settings refuses it.
    """
    entries = [entry.rpartition(":") for entry in text.split(",")]
    return {name: OpenCycle(value) for name, _, value in entries if value in [*OpenCycle]}


def settle_open_cycles(
    builders: Sequence[OperationBuilder], stated: Mapping[str, OpenCycle], diagnostics: Diagnostics
) -> None:
    """Let operations drill on in the cycle before them, or not, as is stated of them.

    One of which nothing is stated is an error, and what it looks like counts for those behind it.
    """
    ended: CycleOn | None = None
    for builder in builders:
        cycle = builder.open_cycle
        if cycle is None or cycle is ended:
            continue
        said = stated.get(builder.name, stated.get(""))
        becomes = said or _looks_like(builder)
        variant = _SETTLED[said] if said else _ASKED[becomes]
        wording = Wording("CL840", variant, cycle_line=cycle.line, operation=builder.name)
        (diagnostics.remark if said else diagnostics.error)(builder.line, wording)
        if becomes is OpenCycle.GOES_ON:
            _drill_on(builder, cycle, diagnostics)
        else:
            ended = cycle


def _looks_like(builder: OperationBuilder) -> OpenCycle:
    """Return what an operation looks like: one that drills on has nothing that cuts otherwise, and no other cycle."""
    cuts = builder.circles or builder.splines or any(not feed.is_kept for feed in builder.feeds)
    others = any(isinstance(event, CycleOn | CutterComp) for event in builder.events)
    drills_on = _first_hole(builder) < _length(builder) and not cuts and not others
    return OpenCycle.GOES_ON if drills_on else OpenCycle.ENDS


def _drill_on(builder: OperationBuilder, cycle: CycleOn, diagnostics: Diagnostics) -> None:
    """Begin a cycle again at the first point that is not approached at rapid; refuse curves within it."""
    at, events = _first_hole(builder), builder.events
    own = next((k for k, event in enumerate(events) if isinstance(event, CycleOn | CycleOff)), len(events))
    end = events[own].row if own < len(events) else _length(builder)
    if at >= end:
        return
    place = next((k for k, event in enumerate(events) if event.row > at), len(events))
    events.insert(min(place, own), replace(cycle, row=at))
    for kind, curves in (("circle_within_cycle", builder.circles), ("nurbs_within_cycle", builder.splines)):
        for curve in [each for each in curves if at <= each.row < end][:1]:
            diagnostics.error(curve.line, Wording("CL620", kind, cycle_line=cycle.line))


def _length(builder: OperationBuilder) -> int:
    return builder.stop - builder.first


def _first_hole(builder: OperationBuilder) -> int:
    """Return the row of the first point that is not approached at rapid; the number of rows if there is none."""
    rapids = set(builder.rapids)
    return next((row for row in range(_length(builder)) if row not in rapids), _length(builder))
