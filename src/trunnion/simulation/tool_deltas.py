"""What a program adds to the tool, and a simulation can show or must refuse (``trunnion.model.tool_additions``).

In:     a run, whose positions are those of a tool without it.
Out:    the run as the tool really goes; errors where nobody knows how it goes.
Units:  mm.

The control takes the tool for so much longer: with a positive length its tip stays as far above the programmed path,
along the tool axis. Machine positions stay where they are. Where it compensates the radius, the tool's centre goes
beside the programmed path (``trunnion.compensation``).
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

from trunnion.compensation.centre_runs import run_of_centre
from trunnion.compensation.offsets import Fault
from trunnion.compensation.stretches import (
    RegisterValue,
    Stretch,
    is_of_compensation,
    offsets_of,
)
from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.tool_additions import LENGTHS, SIZES, ToolAddition, tool_additions, with_added_lengths
from trunnion.simulation.findings import file_of_row
from trunnion.simulation.tools.profile import ToolShape, cutting_width

#: Words that add to the radius, which counts only where the control compensates it.
_RADII: Final = frozenset({"DR", "DR2", "TOFFR", "TOFFLR"})

#: Where a control cannot compensate, or nobody knows how it does.
_FAULTS: Final = {
    Fault.TIGHT: Wording("SIM164", "tight"),
    Fault.ON_CIRCLE: Wording("SIM164", "on_circle"),
    Fault.SHORT_ENTRY: Wording("SIM164", "short_entry"),
    Fault.NO_CONTOUR: Wording("SIM164", "no_contour"),
    Fault.UNSURE: Wording("SIM164", "unsure"),
}


def as_the_tool_goes(run: Run, shapes: Mapping[str, ToolShape], holds: RegisterValue) -> tuple[Run, list[Problem]]:
    """Return the run of the tool's centre with the lengths that its program adds, and what cannot be simulated.

    holds  what the registers of the radius hold
    """
    found = offsets_of(run, holds, lambda row: _radius(run, shapes, row))
    known = [(stretch, offset) for stretch, offset in found if offset is not None]
    centre = run_of_centre(run, known)
    problems = list(_compensation_problems(run, found, centre.faults))
    problems += _refused(run, list(tool_additions(run)), [stretch for stretch, offset in found if offset is None])
    real = centre.run
    if found and len(known) == len(found):  # the reader's warnings of the words are answered
        others = tuple(each for each in real.diagnostics if not is_of_compensation(each.wording))
        real = replace(real, diagnostics=others)
    return with_added_lengths(real), problems


def _radius(run: Run, shapes: Mapping[str, ToolShape], row: int) -> float | None:
    """Return the radius of the tool of a row."""
    shape = shapes.get(run.tools[int(run.state.tool[row])])
    return None if shape is None else 0.5 * cutting_width(shape)


def _compensation_problems(
    run: Run, found: Sequence[tuple[Stretch, float | None]], faults: Sequence[tuple[int, Fault]]
) -> Iterator[Problem]:
    """Yield where nobody knows by how much the control compensates, and where the tool does not fit."""
    unknown = [stretch.first for stretch, offset in found if offset is None]
    if unknown:
        row = unknown[0]
        yield warning(file_of_row(run, row), run.lines[row], Wording("SIM147", "radius_compensation_programmed"))
    for row, fault in faults:
        yield Problem(file_of_row(run, row), run.lines[row], _FAULTS[fault])


def is_told_of_length(run: Run, line: int, wording: Wording) -> bool:
    """Whether a reader's warning tells of a length that is simulated here, or of sizes that are compared."""
    told = {
        str(event.value[0]) for event in run.events
        if event.kind == "delta" and event.line == line and isinstance(event.value, tuple)
    }  # fmt: skip
    if wording.variant == "tool_delta":
        return wording.parameter("word") in told.intersection(LENGTHS)
    return wording.variant == "tool_def_size" and not told.isdisjoint(SIZES)


def _refused(run: Run, deltas: list[ToolAddition], unknown: Sequence[Stretch]) -> Iterator[Problem]:
    """Yield what a program adds to the tool that cannot be simulated; ``unknown`` stretches are not either."""
    for each in deltas:
        file = run.files[each.event.file]
        if each.name not in LENGTHS | _RADII:
            yield Problem(file, each.event.line, Wording("SIM162", "moves_tool_mm", name=each.name, name_2=each.value))
        elif each.name in _RADII and _radius_counts(run, each, unknown):
            yield Problem(file, each.event.line, Wording("SIM162", "adds_mm_radius", name=each.name, name_2=each.value))


def _radius_counts(run: Run, each: ToolAddition, unknown: Sequence[Stretch]) -> bool:
    """Whether an addition to the radius counts where it is not simulated."""
    compensated = any(stretch.first < each.end and each.first < stretch.end for stretch in unknown)
    with_normals = ((run.normals.row >= each.first) & (run.normals.row < each.end)).any()
    return bool(compensated or with_normals)
