"""The path that the control drives under radius compensation, as far as it is known what its registers hold."""

from trunnion.compensation.centre_runs import CentreRun, run_of_centre
from trunnion.compensation.offsets import Fault
from trunnion.compensation.stretches import RegisterValue, Stretch, offsets_of
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.verification.context import ComparedContext, Context
from trunnion.verification.expected.states import compensation_states


@dataclass(frozen=True, slots=True, eq=False)
class DrivenStretch:
    """Rows under compensation.

    offset  how far the control goes beside what they program, mm; None: nobody knows
    wanted  how far it has to go: not at all beside a centre line, the radius beside a contour; None: nobody knows
    """

    stretch: Stretch
    offset: float | None
    wanted: float | None = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class DrivenPath:
    """What the control drives.

    stretches  where the program compensates
    centre     the run of the tool's centre, where the offset is not known as it has to go
    """

    stretches: tuple[DrivenStretch, ...]
    centre: CentreRun

    def is_unsure(self, stretch: Stretch) -> bool:
        """Whether it is not known how the control goes on from one element of a stretch to the next."""
        return any(fault is Fault.UNSURE and stretch.first <= row < stretch.end for row, fault in self.centre.faults)

    def missing(self, context: Context) -> tuple[Wording, ...]:
        """Return what nobody has stated, or what is not simulated, of the path."""
        found = list[Wording]()
        if any(each.offset is None or each.wanted is None for each in self.stretches):
            unstated = context.settings.register_holds is RegisterValue.UNKNOWN
            found.append(phrase("no_radius_register") if unstated else phrase("no_tool_radius"))
        if unsure := [row for row, fault in self.centre.faults if fault is Fault.UNSURE]:
            found.append(phrase("compensation_not_known", block=context.block_name(unsure[0])))
        return tuple(found)


def driven_path(context: Context) -> DrivenPath:
    """Return what the control drives; the radius of a tool is that of its CL file."""
    run, holds = context.run, context.settings.register_holds
    offsets = offsets_of(run, holds, lambda row: cl_radius(context, row))
    stretches = tuple(
        DrivenStretch(stretch, offset, cl_radius(context, stretch.first) if of_contour else 0.0)
        for (stretch, offset), of_contour in zip(offsets, _are_of_contour(context, offsets), strict=True)
    )
    ways = [(each.stretch, each.wanted if each.offset is None else each.offset) for each in stretches]
    return DrivenPath(stretches, run_of_centre(run, [(stretch, way) for stretch, way in ways if way is not None]))


def _are_of_contour(context: Context, offsets: tuple[tuple[Stretch, float | None], ...]) -> list[bool]:
    """Return whether the CL points of each stretch are those of the contour."""
    if not isinstance(context, ComparedContext) or not offsets:
        return [False] * len(offsets)
    ranges = [(state.first, state.end) for state in compensation_states(context.expected) if state.value.contour]
    rows = [_cl_row(context, stretch.first) for stretch, _ in offsets]
    return [row is not None and any(first <= row < end for first, end in ranges) for row in rows]


def _cl_row(context: Context, row: int) -> int | None:
    """Return the CL row of the first motion from a row on that has one."""
    if not isinstance(context, ComparedContext):
        return None
    pairs = context.matching.nc.count_before(row)
    return int(context.matching.cl[pairs]) if pairs < len(context.matching.nc) else None


def cl_radius(context: Context, row: int) -> float | None:
    """Return the radius of the tool of the CL file at a row."""
    cl = _cl_row(context, row)
    if cl is None or not isinstance(context, ComparedContext):
        return None
    diameter = context.expected.section_at(cl).operation.tool.diameter
    return 0.5 * diameter if diameter else None
