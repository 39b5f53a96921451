"""The run that the control drives, as far as anybody knows by how much it compensates the radius.

In:     a run; what its registers hold, the radii of its tools, and which of them go along a contour.
Out:    the run of the tool's centre, and the stretches that stay as they are programmed, with why.
Units:  mm.

Where nobody has stated what a register holds, and the points are those of a contour, the tool goes its radius beside
them: that is what the operator is asked to enter. It is reported, for nobody has stated that it is done.
"""

from collections.abc import Iterator

from trunnion.compensation.centre_runs import CentreRun, run_of_centre
from trunnion.compensation.contour_tools import ContourTools
from trunnion.compensation.offsets import Fault
from trunnion.compensation.stretches import RadiusOf, RegisterValue, Stretch, offsets_of
from trunnion.messages import Wording, phrase
from trunnion.model.run import Run
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class DrivenStretch:
    """Rows under compensation.

    offset      how far the control goes beside them, mm; None: nobody knows
    is_assumed  nobody has stated it, and it is the radius because the points are those of a contour
    """

    stretch: Stretch
    offset: float | None
    is_assumed: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class DrivenRun:
    """What a control drives; ``holds`` is what its registers of the radius hold."""

    centre: CentreRun
    stretches: tuple[DrivenStretch, ...]
    holds: RegisterValue

    @property
    def unknown(self) -> tuple[Stretch, ...]:
        """Stretches of which nobody knows how far beside them the control goes: they stay as programmed."""
        return tuple(each.stretch for each in self.stretches if each.offset is None)

    @property
    def assumed(self) -> tuple[Stretch, ...]:
        """Stretches along a contour that are compensated by the radius, though nobody has stated it."""
        return tuple(each.stretch for each in self.stretches if each.is_assumed)

    @property
    def unsure(self) -> tuple[int, ...]:
        """Rows of the program from which on it is not known how the control goes round corners."""
        return tuple(row for row, fault in self.centre.faults if fault is Fault.UNSURE)

    def missing(self) -> Iterator[tuple[int, Wording]]:
        """Yield why the path of the tool's centre is not known, each with the first row of the program where it is."""
        if self.unknown:
            unstated = self.holds is RegisterValue.UNKNOWN
            yield self.unknown[0].first, phrase("no_radius_register") if unstated else phrase("no_tool_radius")
        if self.assumed:
            yield self.assumed[0].first, phrase("radius_assumed")
        if rows := self.unsure:
            line = int(self.centre.run.line[self.centre.row_of[rows[0]]])
            yield rows[0], phrase("compensation_not_known", block=f"line {line}")


def driven_run(run: Run, holds: RegisterValue, radius_of: RadiusOf, contours: ContourTools | None = None) -> DrivenRun:
    """Return what the control drives of a run; ``contours`` are the tools that go along one, as CL files say."""
    found = [DrivenStretch(stretch, offset) for stretch, offset in offsets_of(run, holds, radius_of)]
    if contours is not None and holds is RegisterValue.UNKNOWN and any(each.offset is None for each in found):
        by_radius = offsets_of(run, RegisterValue.RADIUS, radius_of)
        found = [
            DrivenStretch(own.stretch, radius, is_assumed=radius is not None)
            if own.offset is None and contours.has(run, own.stretch.first)
            else own
            for own, (_, radius) in zip(found, by_radius, strict=True)
        ]
    known = [(each.stretch, each.offset) for each in found if each.offset is not None]
    return DrivenRun(run_of_centre(run, known), tuple(found), holds)
