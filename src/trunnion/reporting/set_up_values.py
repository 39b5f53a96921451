"""What a machine was set up with while a program was judged: each work offset with its zero, each tool with its length.

In:     a run.
Out:    the work offsets and the tools that it works with, with what is stated of them.
Units:  mm.
"""

from collections.abc import Iterator, Sequence
from typing import Annotated

import numpy as np

from trunnion.machines.machine import Vector
from trunnion.model.run import NO_OFFSET, Run
from trunnion.model.run_setups import Setup
from trunnion.records import dataclass
from trunnion.reporting.html_text import format_fixed
from trunnion.reporting.page_words import label
from trunnion.reporting.text import clean
from trunnion.results import Figure


@dataclass(frozen=True, slots=True)
class OffsetZero:
    """A work offset in which the program works, and its zero on the machine; None: nobody has stated it."""

    name: str
    zero: Annotated[Vector | None, Figure(unit="mm")]

    def __str__(self) -> str:
        place = label("not_stated") if self.zero is None else place_text(self.zero)
        return f"{self.name} {place}" if self.name else place


@dataclass(frozen=True, slots=True)
class ToolLength:
    """A tool of the program and its length from the gauge point; None: it is not known.

    source  what gives the length where nobody has stated it; empty: it is stated
    """

    tool: str
    length: Annotated[float | None, Figure(unit="mm")]
    source: Annotated[str, Figure(none="")] = ""

    def __str__(self) -> str:
        known = label("not_stated") if self.length is None else f"{self.length:g}"
        return f"{self.tool or label('no_call')}: {known}{f' ({self.source})' if self.source else ''}"


def zeros_of(run: Run) -> tuple[OffsetZero, ...]:
    """Return the work offsets in which a program works, in the order in which it selects them."""
    values = run.state.work_offset.at(_at_workpiece(run))
    used = [int(value) for value in dict.fromkeys(values.tolist()) if value not in (0, NO_OFFSET)]
    found = {setup.work_offset: setup.machine.workpiece_zero for setup in _setups(run)}
    return tuple(
        OffsetZero(clean(run.work_offset_name(value)), found.get(value, run.machine.workpiece_zero)) for value in used
    ) or ((OffsetZero("", run.machine.workpiece_zero),) if run.machine.workpiece_zero is not None else ())


def lengths_of(run: Run) -> tuple[ToolLength, ...]:
    """Return the tools with which a program works, in the order of their calls; each length that it has."""
    setups = list(_setups(run))
    if setups:
        found = [ToolLength(clean(each.tool), each.machine.tool_length, clean(each.length_source)) for each in setups]
        return tuple(dict.fromkeys(found))
    names = [run.tools[int(value)] for value in dict.fromkeys(run.state.tool.at(_at_workpiece(run)).tolist())]
    return tuple(ToolLength(clean(name), run.machine.tool_length) for name in names)


def zeros_text(zeros: Sequence[OffsetZero]) -> str:
    """Return zeros in one line: a single one without its name where all have it, "not stated" where nobody has."""
    places = dict.fromkeys(each.zero for each in zeros)
    if len(places) == 1:
        (zero,) = places
        return label("not_stated") if zero is None else place_text(zero)
    return "; ".join(map(str, zeros)) or label("not_stated")


def lengths_text(lengths: Sequence[ToolLength]) -> str:
    """Return lengths in one line; empty where nobody has stated any."""
    values = dict.fromkeys((each.length, each.source) for each in lengths)
    if all(length is None for length, _ in values):
        return ""
    if len(values) == 1:
        ((length, source),) = values
        return f"{format_fixed(length or 0.0)}{f' ({source})' if source else ''}"
    return "; ".join(map(str, lengths))


def place_text(place: Vector) -> str:
    """Return a place by the letters of its coordinates."""
    return " ".join(f"{name}{format_fixed(value)}" for name, value in zip("XYZ", place, strict=True))


def _setups(run: Run) -> Iterator[Setup]:
    """Yield the set-ups in which a program works."""
    if run.setups is not None:
        numbers = run.setups.number.at(_at_workpiece(run))
        yield from (run.setups.each[number] for number in dict.fromkeys(numbers.tolist()))


def _at_workpiece(run: Run) -> "np.ndarray[tuple[int], np.dtype[np.int64]]":
    return np.flatnonzero(~run.machine_frame & (run.programmed != 0))
