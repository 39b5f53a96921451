"""Planning: toolpaths to motions on a machine, before any text is written."""

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from trunnion import planning, readers
from trunnion.controls.vocabulary import INCH, MM
from trunnion.errors import InputError, Problem, RefusedError, Severity, argument_problem, merge_repeated, warning
from trunnion.files.places import file_identity, file_on_disk
from trunnion.jobs.inputs.arguments import check_observer
from trunnion.jobs.inputs.cl_statements import replace_unknown_statements
from trunnion.jobs.inputs.reading import MachineLike, ToolpathLike, as_machine, as_toolpaths, cl_reading
from trunnion.jobs.inputs.settings import Settings, check_operation_names, number_setting
from trunnion.jobs.inputs.stated_offsets import with_stated_offsets
from trunnion.jobs.inputs.stated_operations import with_stated_operations
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.post.forced_program import forced_notices
from trunnion.jobs.post.inserts import insert_problems
from trunnion.jobs.post.operation_setups import planned_machines, with_operation_setups
from trunnion.jobs.post.post_job import PostJob, prepare
from trunnion.jobs.post.settings_to_fill import settings_to_fill, with_operations
from trunnion.jobs.post.stages import PlannedProgram
from trunnion.messages import Wording
from trunnion.model.motion import MachiningMode, Plan
from trunnion.model.toolpath import Toolpath
from trunnion.output.compensation_entries import unknown_radii, with_radius_taken_off
from trunnion.output.place_texts import with_place_texts
from trunnion.output.program import Program
from trunnion.output.validation import check_program
from trunnion.output.validation.tools import tool_conflicts
from trunnion.output.validation.ways import way_problems
from trunnion.planning.holes.sideways import sideways_problems
from trunnion.planning.retracts.tool_retract import with_tool_retract

_MM_PER_INCH: Final = 25.4

#: Tilts that differ by less are one, degrees.
_SAME_ANGLE: Final = 1e-6


def plan(
    cl: ToolpathLike | Iterable[ToolpathLike],
    *,
    machine: MachineLike,
    settings: Settings | None = None,
    strict: bool = False,
    explain: bool = True,
    observer: Observer = SILENT,
) -> Plan:
    """Plan the motion of a machine for one or more CL files.

    Parameters
    ----------
    cl
        CL files in the order in which they are cut: paths (of archives too), binary streams, or toolpaths that are
        already read.
    machine
        A name, a path or a ``Machine``.
    settings
        As ``trunnion.post`` takes them.
    strict
        Raise an error for unknown CL statements even if the definition says what becomes of them.
    explain
        Record why the axes are planned as they are (``Plan.decisions``).
    observer
        Receives the progress and warnings about the CL files.

    Returns
    -------
    Plan
        ``motions``, one for each operation or part of one: ``rotary`` (n, 2) float64, positions of the rotary axes in
        degrees in the order of ``machine.rotary``; ``operation.moves.tip`` (n, 3) float64, mm, in the program's
        coordinate system. ``problems`` of severity error mean that the program must not run.

    Raises
    ------
    InputError
        When a file or a setting cannot be used.
    RefusedError
        When no plan is possible: no pose of the machine gives a tool axis, or an operation cannot be made in its mode.

    Notes
    -----
    Poses are chosen for a whole operation by dynamic programming over branches and turns; docs/planning.md.

    Examples
    --------
    >>> import trunnion
    >>> planned = trunnion.plan("tests/golden/yl569/2_hub_rough.cls", machine="yl569")
    >>> planned.motions[0].rotary.shape
    (23, 2)
    """
    check_observer(observer)
    job = prepare(as_machine(machine), settings, explain=explain)
    toolpaths = load_toolpaths(cl, job, strict, observer)
    return _planned(toolpaths, with_operation_setups(toolpaths, job))


def load_toolpaths(
    cl: ToolpathLike | Iterable[ToolpathLike],
    job: PostJob,
    strict: bool,
    observer: Observer,
    changed: Callable[[list[Toolpath]], list[Toolpath]] = list,
) -> list[Toolpath]:
    """Return the toolpaths of a post, with surface normals if the program has them; their remarks are reported.

    ``changed`` returns what becomes of them once they are read.

    Raises ``InputError`` if a file cannot be used, or there is none.
    """
    toolpaths = as_toolpaths(cl, observer, cl_reading(job.settings, strict))
    if job.control.units == INCH:
        _check_units_of(toolpaths)
    toolpaths = [_with_remark_on_units(toolpath, job) for toolpath in toolpaths]
    if not toolpaths:
        raise InputError(argument_problem("cl", Wording("ARG130", "no_cl_file")))
    if job.has_normals:
        from trunnion.cl.surface_normals import with_normals

        toolpaths = [with_normals(toolpath) for toolpath in toolpaths]
    toolpaths = replace_unknown_statements(changed(_with_repeated(toolpaths)), job.control, job.machine)
    toolpaths = with_stated_operations(toolpaths, job.settings)
    toolpaths, _ = with_stated_offsets(toolpaths, (job.machine, job.control), job.settings, job.own_settings)
    for toolpath in toolpaths:
        observer.problems(toolpath.remarks)
    return toolpaths


def _with_repeated(toolpaths: Iterable[Toolpath]) -> list[Toolpath]:
    """Return the toolpaths, with a remark on each file that is there already: it is cut again."""
    found, known = list[Toolpath](), set[Hashable]()
    for toolpath in toolpaths:
        file = file_on_disk(toolpath.file)
        of_archive = toolpath.file.removeprefix(file)
        whole = tuple((operation.name, len(operation.moves)) for operation in toolpath.operations)
        same = (file_identity(file), of_archive, whole)  # parts of a file are posted one after the other
        if same in known:
            remark = warning(toolpath.file, 0, Wording("CL190", "named_twice"))
            found.append(replace(toolpath, remarks=(*toolpath.remarks, remark)))
            continue
        if Path(file).is_file():
            known.add(same)
        found.append(toolpath)
    return found


def _with_remark_on_units(toolpath: Toolpath, job: PostJob) -> Toolpath:
    """Return a toolpath with a remark where its file counts otherwise than the program, and no setting says so."""
    units = {MM: 1.0, INCH: _MM_PER_INCH}
    if "units" in job.settings or not toolpath.states_unit or toolpath.unit == units[job.control.units]:
        return toolpath
    of_file = next((name for name, unit in units.items() if unit == toolpath.unit), f"{toolpath.unit:g} mm")
    wording = Wording("CL415", "other_unit_than_program", units=of_file, program=job.control.units)
    remark = warning(toolpath.file, 0, wording)
    return replace(toolpath, remarks=(*toolpath.remarks, remark))


def _check_units_of(toolpaths: Iterable[Toolpath]) -> None:
    """Raise ``InputError`` for a CL file that would be taken for one in mm while the program counts in inches."""
    unknown = [
        Problem(toolpath.file, 0, Wording("CL410", "unit_not_stated"))
        for toolpath in toolpaths
        if not toolpath.states_unit
    ]
    if unknown:
        raise InputError(unknown)


def _planned(toolpaths: Sequence[Toolpath], job: PostJob) -> Plan:
    """Return the plan, with the margin to limits and the retracts that the job asks for."""
    machine, chord_tolerance = job.planned_machine, job.control.arcs.chord_tolerance
    # Without TCP the positions of slides are those of the tool itself: the control adds the rest.
    slides = job.options.simultaneous_mode is MachiningMode.WITHOUT_TCP
    machine_of = planned_machines(job, with_delta=not (slides and machine.has_rotary_head))
    found = planning.plan(toolpaths, machine, chord_tolerance, job.options, job.capabilities, machine_of)
    distance = number_setting(job.settings, "tool_retract")
    if not distance:
        return found
    return replace(found, motions=tuple(with_tool_retract(motion, distance) for motion in found.motions))


def _settings_of_twins(own: Mapping[str, object], cut: Sequence[tuple[str, str]]) -> list[Problem]:
    """Warnings of settings for one operation by a name that several have."""
    names = [name for _, name in cut]
    return [
        warning(file, 0, Wording("ARG270", "operations_of_one_name", count=names.count(name), operation=name))
        for name, file in {name: file for file, name in reversed(cut) if name in own}.items()
        if names.count(name) > 1
    ]


def plan_program(toolpaths: Sequence[Toolpath], job: PostJob, observer: Observer = SILENT) -> PlannedProgram:
    """Plan a program and check that it can be written, and may.

    Raises ``InputError`` when the control cannot be told what the toolpaths ask for.

    Raises ``RefusedError`` when the program must not run and ``force`` is off.
    """
    cut = [
        (toolpath.file, operation.name)
        for toolpath in toolpaths
        for operation in toolpath.operations
        if len(operation.moves)
    ]
    check_operation_names(job.own_settings, job.settings, [name for _, name in cut])
    stated = {operation.name for each in toolpaths for operation in each.operations if operation.work_offset}
    given = {name: own for name, own in job.own_settings.items() if name not in stated or set(own) != {"work_offset"}}
    observer.problems(_settings_of_twins(given, cut))
    planned = _planned(toolpaths, job)
    planned = replace(planned, decisions=(*job.decisions, *planned.decisions))
    observer.planned(planned)
    file = toolpaths[0].file
    program = Program(
        job.machine, job.control, planned.motions, job.printed, file, own_settings=job.own_settings, setups=job.setups
    )
    program = with_radius_taken_off(with_place_texts(program))
    problems, errors = _of_program(program, observer)
    unproven = _missing_reader(job)
    conflicts = _tool_conflicts(program, errors)
    leaning = _leaning_operations(planned, number_setting(job.settings, "max_tilt"))
    sideways = sideways_problems(toolpaths) if job.settings.get("drills_sideways") != "allowed" else []
    remarks = merge_repeated((*planned.problems, *unknown_radii(program)))
    found = [*remarks, *conflicts, *leaning, *sideways]
    if errors:  # with all else that is wrong, so that one round of answers does
        raise InputError(_with_settings([*errors, *_errors_of(found), *unproven], program))
    ways = way_problems(program, subprograms=job.settings.get("programs") == "operations")
    found = [*remarks, *ways, *conflicts, *insert_problems(program), *leaning, *sideways]
    blocking = _errors_of(found) + unproven
    if blocking and not job.force:
        refused = Problem(file, 0, Wording("CTL940", "can_be_forced" if job.can_force else "nothing_written"))
        known = with_operations((*found, *unproven), program)
        raise RefusedError((*known, refused, *settings_to_fill(_errors_of(known), file)))
    observer.problems(found)
    notices = forced_notices(problem.what for problem in blocking)
    return PlannedProgram(replace(program, notices=[*job.notices, *notices]), planned, [*problems, *found])


def _tool_conflicts(program: Program, errors: list[Problem]) -> list[Problem]:
    """Return operations that call one tool and state different ones.

    Where one has nothing to call its tool by, that joins the ``errors``, and nothing is known of the others.
    """
    by_register = readers.can_read(program.machine) and readers.reader_of(program.machine).uses_length_numbers
    try:
        return tool_conflicts(program, uses_length_numbers=by_register)
    except InputError as error:
        errors += [problem for problem in error.problems if problem not in errors]
        return []


def _leaning_operations(planned: Plan, most: float | None) -> list[Problem]:
    """Return an error for each operation whose tool axis leans more from Z of the program than the setting allows,
    degrees.
    """
    if most is None:
        return []
    found: dict[tuple[str, int], Problem] = {}
    for operation in (motion.operation for motion in planned.motions if len(motion.operation.moves)):
        tilt = np.degrees(np.arccos(np.clip(operation.moves.axis[:, 2], -1.0, 1.0)))
        worst = int(tilt.argmax())
        if tilt[worst] > most + _SAME_ANGLE:
            line = int(operation.moves.line[worst])
            found.setdefault(
                (operation.file, operation.line),
                Problem(
                    operation.file,
                    line,
                    Wording("PLN340", "leans_too_far", operation=operation.name, tilt=float(tilt[worst]), most=most),
                ),
            )
    return list(found.values())


def new_problems(program: Program, observer: Observer, known: Sequence[Problem] = ()) -> list[Problem]:
    """Warnings about a program that are not known yet; they have been reported, also where there are errors.

    Raises ``InputError`` when the control cannot be told what the program says.
    """
    found, errors = _of_program(program, observer, known)
    if errors:
        raise InputError(_with_settings(errors, program))
    return found


def _of_program(
    program: Program, observer: Observer, known: Sequence[Problem] = ()
) -> tuple[list[Problem], list[Problem]]:
    """Return warnings about a program that are not known yet, which have been reported, and errors."""
    problems = [
        problem for problem in merge_repeated(with_operations(check_program(program), program)) if problem not in known
    ]
    found = [problem for problem in problems if problem.severity is not Severity.ERROR]
    observer.problems(found)
    return found, _errors_of(problems)


def _errors_of(problems: Iterable[Problem]) -> list[Problem]:
    return [problem for problem in problems if problem.severity is Severity.ERROR]


def _with_settings(errors: Iterable[Problem], program: Program) -> list[Problem]:
    """Return errors in the order of their lines, and the settings that end them."""
    ordered = with_operations(sorted(errors, key=lambda problem: (problem.file, problem.line)), program)
    return [*ordered, *settings_to_fill(ordered, program.file)]


def _missing_reader(job: PostJob) -> list[Problem]:
    """Why nothing can prove a program for this machine; empty where its control has a reader."""
    if readers.can_read(job.machine):
        return []
    return [Problem(job.machine.key, 0, Wording("CTL920", "program_not_read_back", control=job.control.name))]
