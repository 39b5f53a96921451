"""Reading what is simulated.

In:     ``SetupInput``: names of files, texts and numbers.
Out:    ``PreparedSetup``: runs, bodies of tools, meshes.
Units:  mm, degrees.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from trunnion import readers
from trunnion.compensation.stretches import RegisterValue
from trunnion.errors import InputError, Problem, Severity, argument_problem, warning
from trunnion.jobs.inputs.arguments import check_paths, checked_angles, wrong_argument
from trunnion.jobs.inputs.bodies import KnownTools, fixture_meshes, known_tools, listed, read_mesh
from trunnion.jobs.inputs.control_settings import rapid_feed_of, register_value_of
from trunnion.jobs.inputs.hooked import hooked_toolpaths
from trunnion.jobs.inputs.reading import FilePath, as_machine, as_run, as_toolpaths, stated_reading
from trunnion.jobs.inputs.settings import work_offset_setting
from trunnion.jobs.inputs.simulation_input import SetupInput
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.jobs.inputs.stated_words import refuse_settings, with_stated
from trunnion.jobs.observer import Observer
from trunnion.machines import Machine
from trunnion.messages import Wording, phrase
from trunnion.model.clamped_toolpaths import toolpaths_clamped
from trunnion.model.clamping import Clamping
from trunnion.model.one_frame import WorkpieceFrame, frame_of_offset
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.model.unknown_setups import tools_without_length
from trunnion.options.words import CL_SETTINGS, FRAME_SETTING
from trunnion.placing.program_heads import unlike_bodies
from trunnion.simulation.meshes import DEVIATION
from trunnion.simulation.offset_places import cuts_at_unknown_places
from trunnion.simulation.prepared_setup import PreparedSetup
from trunnion.simulation.stock.turning import Pose
from trunnion.simulation.tools.choice import NO_CALL
from trunnion.simulation.tools.profile import ToolShape
from trunnion.verification import restore_rapids
from trunnion.verification.kinematics.unknown_cuts import cuts_from_unknown_places

#: Fewer errors do not say that a file is no program of the machine.
_FEW_ERRORS: Final = 5


def prepare_setup(
    given: SetupInput, remarks: list[Problem], observer: Observer, deviation: float = DEVIATION
) -> PreparedSetup:
    """Read all that a set-up needs; facets of exact surfaces are off them by ``deviation`` at most, mm.

    Raises ``InputError`` when a file or an argument cannot be used, or nothing says the form of a tool.
    """
    machine, left = with_stated(as_machine(given.machine), given.settings, given.assume)
    of_reading = {key: value for key, value in left.items() if key in CL_SETTINGS and given.cl}
    refuse_settings(left.keys() - of_reading.keys() - {FRAME_SETTING}, machine)
    readers.reader_of(machine)
    machine = set_up_machine(machine, given.zero, given.tool_length)
    angles = checked_angles(given.turn, given.tilt)
    part = None if given.part is None else read_mesh(given.part, "part", remarks, deviation)
    fixtures = fixture_meshes(given.fixtures, remarks, deviation)
    programs: list[FilePath | Run] = listed("nc", given.programs, Run)
    if not programs:
        raise wrong_argument("nc", given.programs, phrase("give_nc"))
    others, rapid_feed = check_paths("subprograms", given.subprograms), rapid_feed_of(machine)
    runs = tuple(restore_rapids(as_run(program, machine, others), rapid_feed) for program in programs)
    _check_programs(runs, machine)
    remarks += _without_motion(runs)
    frame = _frame_of_stock(runs, given, machine)
    runs = frame.runs(runs)
    remarks += cuts_at_unknown_places(frame, runs)
    remarks += _lengths_missing(runs)
    remarks += _cuts_from_unknown_places(runs)
    for program in programs:
        if not isinstance(program, Run):
            remarks += unlike_bodies(Path(program), Clamping(*angles), machine)
    read = as_toolpaths(given.cl, observer, stated_reading(of_reading, given.strict))
    toolpaths = hooked_toolpaths(read, machine, given.hooks)
    if not given.cl_is_turned:  # else the post has told what its reader remarks
        remarks += (remark for toolpath in read for remark in toolpath.remarks)
        toolpaths = toolpaths_clamped(toolpaths, *angles)
    tools = _tools(runs, known_tools(given.tools, given.tool_libraries, given.unit, toolpaths))
    if given.work_offset is not None:
        remarks += _other_offsets(runs, given.work_offset, machine)
    return PreparedSetup(
        machine, runs, tools, part, fixtures, toolpaths, Clamping(*angles), given.name, given.pose or Pose(),
        given.until, RegisterValue(given.radius_register or register_value_of(machine)), strict=given.strict,
        drawn=read,
    )  # fmt: skip


def skipping_setup(
    own: PreparedSetup, given: SetupInput, levels: frozenset[int], remarks: list[Problem]
) -> PreparedSetup:
    """Return a set-up that was read as it is while some switches of block skip are on.

    Raises ``InputError`` if its programs cut with no tool that is known then.
    """
    rapid_feed = rapid_feed_of(own.machine)
    runs = tuple(restore_rapids(run.with_skips(levels), rapid_feed) for run in own.runs)
    remarks += _without_motion(runs)
    frame = _frame_of_stock(own.runs, given, own.machine)
    runs = frame.runs(runs)
    remarks += cuts_at_unknown_places(frame, runs)
    remarks += _cuts_from_unknown_places(runs)
    if given.work_offset is not None:
        remarks += _other_offsets(runs, given.work_offset, own.machine)
    if NO_CALL not in own.tools and any(_cuts_without_call(run) for run in runs):
        raise InputError(argument_problem("tools", Wording("SIM150", "cuts_before_first_tool")))
    return replace(own, runs=runs, until_line=own.line_of_end(), until=None)


def _frame_of_stock(runs: Sequence[Run], given: SetupInput, machine: Machine) -> WorkpieceFrame:
    """Return the frame of the set-up's own work offset, or of the first that its programs use."""
    stated = None if given.work_offset is None else work_offset_setting(given.work_offset, machine)
    return frame_of_offset(runs, stated)


def _tools(runs: Sequence[Run], known: KnownTools) -> dict[str, ToolShape]:
    """Return the bodies of the tools with which the programs move at feed or at rapid."""
    called = [run.tools[int(index)] for run in runs for index in run.state.tool.distinct()]
    in_spindle = any(tool.number == int(NO_CALL) for tool in known.stated)
    if in_spindle or any(_cuts_without_call(run) for run in runs):
        called.append(NO_CALL)
        if not in_spindle:
            raise InputError(argument_problem("tools", Wording("SIM150", "cuts_before_first_tool")))
    found = known.choose(called)
    return found | ({"": found[NO_CALL]} if NO_CALL in found else {})


def _cuts_without_call(run: Run) -> bool:
    """Whether a program moves at feed before it calls a tool: the operator has put one in."""
    rows = np.concatenate([run.state.tool.rows_with(index) for index, name in enumerate(run.tools) if not name])
    return bool((run.kind[rows] != Kind.RAPID).any())


def _check_programs(runs: Sequence[Run], machine: Machine) -> None:
    """Refuse what is no program of the machine: more lines of it are not understood than it has motions."""
    for run in runs:
        wrong = sorted({(each.file, each.line): each for each in run.errors}.items())
        if len(wrong) > max(_FEW_ERRORS, len(run)):
            (file, line), first = wrong[0]
            raise InputError(
                Problem(
                    file,
                    line,
                    Wording(
                        "SIM140", "no_program_of_machine", first=first.wording, count=len(wrong), machine=machine.key
                    ),
                )
            )


def _without_motion(runs: Sequence[Run]) -> list[Problem]:
    """Programs that move nothing: an error where none of a set-up does, for then nothing was simulated."""
    severity = Severity.WARNING if any(len(run) for run in runs) else Severity.ERROR
    return [
        Problem(run.files[0], 0, Wording("SIM148", "nothing_moves"), severity=severity) for run in runs if not len(run)
    ]


def _lengths_missing(runs: Sequence[Run]) -> Iterator[Problem]:
    """Yield a warning of each program that works with a tool without a length, and with others that have one."""
    for run in runs:
        if names := tools_without_length(run):
            yield warning(run.files[0], 0, Wording("SIM310", "length_of_some_tools", names=names))


def _cuts_from_unknown_places(runs: Sequence[Run]) -> Iterator[Problem]:
    """Yield an error of each program that cuts from where nobody knows how far the tool has gone."""
    for run in runs:
        rows = cuts_from_unknown_places(run)
        if len(rows):
            wording = Wording("SIM143", "cuts_from_unknown", count=len(rows))
            yield Problem(run.files[0], int(run.lines[int(rows[0])]), wording, severity=Severity.ERROR)


def _other_offsets(runs: Sequence[Run], wanted: str, machine: Machine) -> list[Problem]:
    """Errors where programs cut in another work offset than that of their set-up."""
    offset = work_offset_setting(wanted, machine)
    found = []
    for run in runs:
        rows = np.flatnonzero((run.kind != Kind.RAPID) & ~run.machine_frame & (run.work_offset != offset))
        if len(rows):
            row = int(rows[0])
            other = int(run.work_offset[row])
            found.append(
                Problem(
                    run.files[int(run.file[row])],
                    int(run.line[row]),
                    Wording("SIM141", "cuts_in_other_offset", offset=run.work_offset_name(other), wanted=wanted)
                    if other
                    else Wording("SIM141", "cuts_in_no_offset", wanted=wanted),
                )
            )
    return found
