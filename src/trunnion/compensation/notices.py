"""What is said of the path of the tool's centre: where it is not known, and where the tool does not fit."""

from collections.abc import Iterator
from typing import Final

from trunnion.compensation.driven_runs import DrivenRun
from trunnion.compensation.offsets import Fault
from trunnion.compensation.stretches import RegisterValue
from trunnion.errors import Problem, Severity
from trunnion.messages import Wording
from trunnion.model.run import Run

#: Where a control cannot compensate, or nobody knows how it does.
_FAULTS: Final = {
    Fault.TIGHT: Wording("SIM164", "tight"),
    Fault.ON_CIRCLE: Wording("SIM164", "on_circle"),
    Fault.SHORT_ENTRY: Wording("SIM164", "short_entry"),
    Fault.NO_CONTOUR: Wording("SIM164", "no_contour"),
    Fault.UNSURE: Wording("SIM164", "unsure"),
}


def compensation_notices(
    run: Run,
    driven: DrivenRun,
    unstated: Severity = Severity.WARNING,
    unsure: Severity = Severity.ERROR,
    faulty: Severity = Severity.ERROR,
) -> Iterator[Problem]:
    """Yield what is not known of the path that a control drives of a run, and what it cannot do.

    unstated  how severe it is that nobody has stated by how much it compensates
    unsure    how severe it is that nobody knows how it goes round corners: the programmed path is taken there
    faulty    how severe it is that the tool does not fit
    """
    programmed = "radius_compensation_programmed" if driven.holds is RegisterValue.UNKNOWN else "radius_not_known"
    for stretches, variant in ((driven.unknown, programmed), (driven.assumed, "taken_for_radius")):
        if stretches:
            yield _problem(run, stretches[0].first, Wording("SIM147", variant), unstated)
    for row, fault in driven.centre.faults:
        yield _problem(run, row, _FAULTS[fault], unsure if fault is Fault.UNSURE else faulty)


def fault_notice(file: str, line: int, fault: Fault, severity: Severity) -> Problem:
    """Return what is said of a place where a control cannot compensate, or nobody knows how it does."""
    return Problem(file, line, _FAULTS[fault], severity=severity)


def unknown_radius(file: str, line: int) -> Problem:
    """Return what is said of a CL file along a contour that does not state the radius of the tool."""
    return Problem(file, line, Wording("SIM147", "contour_radius_not_known"), severity=Severity.WARNING)


def unknown_corners(file: str, line: int) -> Problem:
    """Return what is said where nobody knows how a control goes round corners, and the widest way is taken."""
    return Problem(file, line, Wording("SIM164", "corners_unsure"), severity=Severity.WARNING)


def _problem(run: Run, row: int, wording: Wording, severity: Severity) -> Problem:
    return Problem(run.files[run.state.file[row]], run.lines[row], wording, severity=severity)
