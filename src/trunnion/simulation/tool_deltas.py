"""What a program adds to the tool, and a simulation can show or must refuse (``trunnion.model.tool_additions``).

In:     a run, whose positions are those of a tool without it.
Out:    the run as the tool really goes; errors and what is missing where nobody knows how it goes.
Units:  mm.

The control takes the tool for so much longer: with a positive length its tip stays as far above the programmed path,
along the tool axis. Machine positions stay where they are. Where it compensates the radius, the tool's centre goes
beside the programmed path (``trunnion.compensation``).
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

from trunnion.arrays import Ints
from trunnion.compensation.contour_tools import ContourTools
from trunnion.compensation.driven_runs import driven_run
from trunnion.compensation.notices import compensation_notices
from trunnion.compensation.stretches import RegisterValue, Stretch, is_of_compensation
from trunnion.errors import Problem, Severity
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.tool_additions import LENGTHS, SIZES, ToolAddition, tool_additions, with_added_lengths
from trunnion.records import dataclass
from trunnion.simulation.tools.profile import ToolShape, cutting_width

#: Words that add to the radius, which counts only where the control compensates it.
_RADII: Final = frozenset({"DR", "DR2", "TOFFR", "TOFFLR"})


@dataclass(frozen=True, slots=True, eq=False)
class ToolPath:
    """How the tools of a program go.

    run       of the tools' centres, with the lengths that the program adds
    row_of    (n,) int64: the row of it that ends a row of the program
    problems  what of it cannot be simulated
    missing   why what they cut is not known, as nobody has stated by how much the control compensates the radius
    """

    run: Run
    row_of: Ints
    problems: tuple[Problem, ...]
    missing: tuple[Wording, ...]


def as_the_tool_goes(
    run: Run, shapes: Mapping[str, ToolShape], holds: RegisterValue, contours: ContourTools, *, strict: bool = False
) -> ToolPath:
    """Return how the tools of a program go.

    holds     what the registers of the radius hold
    contours  tools that go along a contour
    strict    what nobody has stated is an error
    """
    driven = driven_run(run, holds, lambda row: radius_of(run, shapes, row), contours)
    problems = list(compensation_notices(run, driven, Severity.ERROR if strict else Severity.WARNING))
    problems += _refused(run, list(tool_additions(run)), driven.unknown)
    real = driven.centre.run
    if driven.stretches and not driven.unknown:  # the reader's warnings of the words are answered
        others = tuple(each for each in real.diagnostics if not is_of_compensation(each.wording))
        real = replace(real, diagnostics=others)
    missing = tuple(wording for _, wording in driven.missing())
    return ToolPath(with_added_lengths(real), driven.centre.row_of, tuple(problems), missing)


def radius_of(run: Run, shapes: Mapping[str, ToolShape], row: int) -> float | None:
    """Return the radius of the tool of a row."""
    shape = shapes.get(run.tools[int(run.state.tool[row])])
    return None if shape is None else 0.5 * cutting_width(shape)


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
            yield Problem(file, each.event.line, Wording("SIM162", "moves_tool_mm", name=each.name, delta=each.value))
        elif each.name in _RADII and _radius_counts(run, each, unknown):
            yield Problem(file, each.event.line, Wording("SIM162", "adds_mm_radius", name=each.name, delta=each.value))


def _radius_counts(run: Run, each: ToolAddition, unknown: Sequence[Stretch]) -> bool:
    """Whether an addition to the radius counts where it is not simulated."""
    compensated = any(stretch.first < each.end and each.first < stretch.end for stretch in unknown)
    with_normals = ((run.normals.row >= each.first) & (run.normals.row < each.end)).any()
    return bool(compensated or with_normals)
