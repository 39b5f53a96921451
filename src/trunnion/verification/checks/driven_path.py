"""The path that the control drives under radius compensation, as far as it is known what its registers hold."""

from dataclasses import dataclass

from trunnion.compensation.centre_runs import CentreRun, run_of_centre
from trunnion.compensation.offsets import Fault
from trunnion.compensation.stretches import RegisterValue, Stretch, offsets_of
from trunnion.messages import Wording, phrase
from trunnion.verification.context import ComparedContext, Context


@dataclass(frozen=True, slots=True, eq=False)
class DrivenPath:
    """What the control drives.

    offsets  how far it goes beside what each stretch programs, mm; None: nobody knows
    centre   the run of the tool's centre, along the programmed path where the offset is not known
    """

    offsets: tuple[tuple[Stretch, float | None], ...]
    centre: CentreRun

    def missing(self, context: Context) -> tuple[Wording, ...]:
        """Return what nobody has stated, or what is not simulated, of the path."""
        found = list[Wording]()
        if any(offset is None for _, offset in self.offsets):
            unstated = context.settings.register_holds is RegisterValue.UNKNOWN
            found.append(phrase("no_radius_register") if unstated else phrase("no_tool_radius"))
        if unsure := [row for row, fault in self.centre.faults if fault is Fault.UNSURE]:
            found.append(phrase("compensation_not_known", block=context.block_name(unsure[0])))
        return tuple(found)


def driven_path(context: Context) -> DrivenPath:
    """Return what the control drives; the radius of a tool is that of its CL file."""
    run, holds = context.run, context.settings.register_holds
    found = offsets_of(run, holds, lambda row: _cl_radius(context, row))
    return DrivenPath(found, run_of_centre(run, [(stretch, offset) for stretch, offset in found if offset is not None]))


def _cl_radius(context: Context, row: int) -> float | None:
    """Return the radius of the tool of the CL file at the first motion from a row on that has a CL point."""
    if not isinstance(context, ComparedContext) or not len(context.matching.nc):
        return None
    pairs = context.matching.nc.count_before(row)
    if pairs >= len(context.matching.nc):
        return None
    diameter = context.expected.section_at(context.matching.cl[pairs]).operation.tool.diameter
    return 0.5 * diameter if diameter else None
