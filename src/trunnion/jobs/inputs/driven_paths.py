"""Where tools go under radius compensation: the paths of their centres, of programs and of CL files along a contour."""

from collections.abc import Iterable

from trunnion import readers
from trunnion.compensation.centre_toolpaths import toolpaths_of_centre
from trunnion.compensation.driven_runs import driven_run
from trunnion.compensation.notices import compensation_notices
from trunnion.compensation.stretches import RegisterValue
from trunnion.compensation.styles import UNKNOWN_STYLE
from trunnion.errors import Problem, Severity
from trunnion.jobs.inputs.bodies import KnownTools
from trunnion.machines import Machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.simulation.tool_deltas import radius_of
from trunnion.simulation.tools.choice import NO_CALL


def driven_by_tools(run: Run, known: KnownTools, holds: RegisterValue) -> tuple[Run, list[Problem]]:
    """Return the run of the tools' centres, and warnings where it is that of the program.

    A tool that does not fit is an error.
    """
    shapes = {name: shape for name in run.tools if (shape := known.find(name or NO_CALL)) is not None}
    driven = driven_run(run, holds, lambda row: radius_of(run, shapes, row))
    return driven.centre.run, list(compensation_notices(run, driven, unsure=Severity.WARNING))


def centres_of(toolpaths: Iterable[Toolpath], machine: Machine) -> tuple[list[Toolpath], list[Problem]]:
    """Return CL files along a contour as the paths of the tools' centres, and warnings where these are not known."""
    style = readers.reader_of(machine).compensation_style(machine) if readers.can_read(machine) else UNKNOWN_STYLE
    return toolpaths_of_centre(toolpaths, style)
