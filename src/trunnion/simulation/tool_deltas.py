"""What a program adds to the tool, and a simulation can show or must refuse (``trunnion.model.tool_additions``).

In:     a run, whose positions are those of a tool without it.
Out:    the run as the tool really goes; errors where nobody knows how it goes.
Units:  mm.

The control takes the tool for so much longer: with a positive length its tip stays as far above the programmed path,
along the tool axis. Machine positions stay where they are.
"""

from collections.abc import Iterator
from typing import Final

from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.tool_additions import LENGTHS, SIZES, ToolAddition, tool_additions, with_added_lengths

#: Words that add to the radius, which counts only where the control compensates it.
_RADII: Final = frozenset({"DR", "DR2", "TOFFR", "TOFFLR"})


def as_the_tool_goes(run: Run) -> tuple[Run, list[Problem]]:
    """Return the run with the lengths that its program adds, and what cannot be simulated."""
    additions = list(tool_additions(run))
    return (with_added_lengths(run), list(_refused(run, additions))) if additions else (run, [])


def is_told_of_length(run: Run, line: int, wording: Wording) -> bool:
    """Whether a reader's warning tells of a length that is simulated here, or of sizes that are compared."""
    told = {
        str(event.value[0]) for event in run.events
        if event.kind == "delta" and event.line == line and isinstance(event.value, tuple)
    }  # fmt: skip
    if wording.variant == "tool_delta":
        return wording.parameter("word") in told.intersection(LENGTHS)
    return wording.variant == "tool_def_size" and not told.isdisjoint(SIZES)


def _refused(run: Run, deltas: list[ToolAddition]) -> Iterator[Problem]:
    for each in deltas:
        file = run.files[each.event.file]
        if each.name not in LENGTHS | _RADII:
            yield Problem(file, each.event.line, Wording("SIM162", "moves_tool_mm", name=each.name, name_2=each.value))
        elif each.name in _RADII and _radius_counts(run, each):
            yield Problem(file, each.event.line, Wording("SIM162", "adds_mm_radius", name=each.name, name_2=each.value))


def _radius_counts(run: Run, each: ToolAddition) -> bool:
    compensated = run.state.compensation.part(each.first, each.end).any()
    with_normals = ((run.normals.row >= each.first) & (run.normals.row < each.end)).any()
    return bool(compensated or with_normals)
