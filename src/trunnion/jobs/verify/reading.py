"""Reading what is verified: the run of a program, and its CL files as it was posted from them.

In:     a program, the machine that runs it, and the arguments of the verification.
Out:    the run and the toolpaths; warnings about them have been reported.
"""

from dataclasses import replace
from pathlib import Path

from trunnion.controls import Control
from trunnion.jobs.arguments import VerifyArguments
from trunnion.jobs.inputs.cl_statements import replace_unknown_statements
from trunnion.jobs.inputs.hooked import hooked_toolpaths
from trunnion.jobs.inputs.reading import FilePath, as_run, as_toolpaths, stated_reading
from trunnion.jobs.inputs.settings import as_texts
from trunnion.jobs.inputs.stated_operations import with_stated_operations
from trunnion.jobs.inputs.tool_lengths import with_lengths_of_tools
from trunnion.jobs.observer import Observer
from trunnion.jobs.verify.arguments import angles_of
from trunnion.jobs.verify.program_warnings import program_warnings
from trunnion.machines import Machine
from trunnion.model.clamped_toolpaths import clamped_after, stated_clamping, turned_toolpaths
from trunnion.model.clamping import Clamping
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.options.words import CL_SETTINGS
from trunnion.placing.program_heads import stated_place, unlike_cl_files, unlike_zero
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class VerifiedMachine:
    """The machine that runs a program, set up; its control is None where programs can be read but not written."""

    machine: Machine
    control: Control | None


@dataclass(frozen=True, slots=True, eq=False)
class ReadProgram:
    """What is compared.

    toolpaths  of the part as it is clamped; none: the program is checked by itself
    clamping   None: nothing says how the part is clamped
    """

    run: Run
    toolpaths: list[Toolpath]
    clamping: Clamping | None


def read_program(nc: FilePath | Run, on: VerifiedMachine, given: VerifyArguments, observer: Observer) -> ReadProgram:
    """Read a program and its CL files.

    Raises ``InputError`` if a file cannot be used, or a CL file states that its part is clamped otherwise.
    """
    settings = as_texts(given["settings"])
    of_reading = {key: text for key, text in settings.items() if key in CL_SETTINGS}
    how = stated_reading(
        of_reading, given["strict"], cl_units=given["units"], dialect=given["dialect"], cutcom=given["cutcom"]
    )
    toolpaths = as_toolpaths(given["cl"], observer, how)
    on = replace(on, machine=with_lengths_of_tools(on.machine, toolpaths))
    run = as_run(nc, on.machine, given["subprograms"])
    observer.problems(program_warnings(run))
    if len(run.normals):
        from trunnion.cl.surface_normals import with_normals

        toolpaths = [with_normals(toolpath) for toolpath in toolpaths]
    if given["hooks"]:
        toolpaths = _changed_by_hooks(toolpaths, on, given)
    toolpaths = replace_unknown_statements(toolpaths, on.control, on.machine)
    toolpaths = with_stated_operations(toolpaths, settings)
    stated, clamping = stated_clamping(toolpaths), None
    if toolpaths:
        clamping = clamped_after(stated, angles_of(given), toolpaths[0].file)
        toolpaths = turned_toolpaths(toolpaths, *angles_of(given), absolute=given["frame"] == "absolute")
    if not isinstance(nc, Run):
        program = Path(nc)
        observer.problems(
            unlike_zero(program, on.machine)
            if clamping is None
            else unlike_cl_files(program, Clamping(*angles_of(given)), clamping, stated, on.machine)
        )
        clamping = clamping or stated_place(program).clamping
    for toolpath in toolpaths:
        observer.problems(toolpath.remarks)
    return ReadProgram(run, toolpaths, clamping)


def _changed_by_hooks(toolpaths: list[Toolpath], on: VerifiedMachine, given: VerifyArguments) -> list[Toolpath]:
    """Return what hooks make of toolpaths; they see the settings that are given."""
    settings = {
        "tool": given["tool"], "work_offset": given["work_offset"], "edge": given["edge"], "cl_units": given["units"],
        "dialect": given["dialect"],
    }  # fmt: skip
    texts = {name: str(value) for name, value in settings.items() if value not in (None, "")}
    return hooked_toolpaths(toolpaths, on.machine, given["hooks"], texts)
