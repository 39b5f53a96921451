"""Inputs of the public API: CL files, machines and programs, by their names or already read."""

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import BinaryIO, Final, TypeAlias

from trunnion import machines, readers
from trunnion.cl import DIALECTS, is_cl_file, not_one_file, other_system
from trunnion.cl.read import AS_IT_SAYS, ClReading
from trunnion.controls.definition_files import is_control_file
from trunnion.controls.loading import control_library
from trunnion.definitions import resolve_extends
from trunnion.errors import InputError, Problem, argument_problem, setting_problem, unusable_file
from trunnion.jobs.inputs.arguments import (
    check_choice,
    check_observer,
    check_path,
    check_paths,
    is_stream,
    wrong_argument,
)
from trunnion.jobs.inputs.cl_or_program import read_cl_file
from trunnion.jobs.inputs.cl_statements import check_statements
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.jobs.inputs.settings import Settings, as_texts, number_setting
from trunnion.jobs.inputs.stated_cycles import stated_cycles
from trunnion.jobs.observer import SILENT, Observer
from trunnion.machines import Machine
from trunnion.messages import Wording, phrase
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.options.words import CL_SETTINGS

#: A path as text or as a ``Path``.
FilePath: TypeAlias = str | os.PathLike[str]

#: A shipped machine by its name, a definition by its path, or a machine that is already loaded.
MachineLike: TypeAlias = str | os.PathLike[str] | Machine

#: A CL file by its path, packed or not; a binary stream of one; or a CL file that is already read.
ToolpathLike: TypeAlias = FilePath | BinaryIO | Toolpath

#: Fields of a ``Machine`` that do not say how it moves: its names, its setup, and its control, which is a table.
_NO_CONTENT: Final = {
    "key",
    "name",
    "description",
    "files",
    "workpiece_zero",
    "tool_length",
    "inherited",
    "zeros",
    "tool_lengths",
    "length_sources",
    "control",
    "cl_words",
    "cl_word_places",
    "bodies",
}


def read_cl(
    path: FilePath | BinaryIO,
    *,
    units: str | None = None,
    dialect: str | None = None,
    strict: bool = False,
    spline_tolerance: float | None = None,
    observer: Observer = SILENT,
) -> Toolpath:
    """Read a CL file: NX CLSF, CATIA APTSOURCE, Creo NCL, SolidWorks CAM APT or other APT CL data.

    Parameters
    ----------
    path
        The file; it may be packed by gzip or bzip2, be the only CL file of a ZIP archive, or be a binary stream.
    units
        Length unit of the file, ``"mm"`` or ``"inch"``; by default the file decides.
    dialect
        ``"clsf"``, ``"catia"``, ``"ncl"``, ``"solidworks"``, ``"clt"``, ``"fusion"``,
        ``"apt"``, ``"nci"`` or ``"trunnion"``; by default the content of the file decides.
    strict
        Raise an error for an unknown statement instead of keeping it with a remark.
    spline_tolerance
        How far the points that splines (NURBS) become may leave them between each other, 0.0001 to 1 mm; by default
        the smaller of INTOL and OUTTOL, at most 0.01 mm, and 0.001 mm without them.
    observer
        Receives the progress, in bytes, and as what the file was read.

    Returns
    -------
    Toolpath
        Operations with their points as columns, mm and unit vectors, each in its own coordinate system. ``remarks`` has
        the warnings.

    Raises
    ------
    InputError
        With every problem found, if the file cannot be used, or is an archive of several.

    Examples
    --------
    >>> import trunnion
    >>> toolpath = trunnion.read_cl("tests/golden/yl569/2_hub_rough.cls")
    >>> toolpath.operations[0].moves.tip.shape
    (23, 3)
    """
    toolpaths = _read(path, ClReading(units, dialect, strict, spline_tolerance), observer, "path")
    if len(toolpaths) > 1:
        raise not_one_file(toolpaths[0].file, len(toolpaths))
    return toolpaths[0]


def _read(cl: object, how: ClReading, observer: Observer, argument: str) -> list[Toolpath]:
    """Return the toolpaths of a CL file, a stream or an archive; errors name the argument."""
    path = cl if is_stream(cl) else check_path(argument, cl)
    check_observer(observer)
    units, within = how.units, how.spline_tolerance
    if units is not None:
        check_choice("units", units.lower() if isinstance(units, str) else units, ("mm", "inch"))
    if how.dialect is not None:
        check_choice("dialect", how.dialect, tuple(DIALECTS))
    if within is not None and not _is_spline_tolerance(within):
        raise wrong_argument("spline_tolerance", within, phrase("give_fine_tolerance"))
    found = read_cl_file(path, observer.progress, how)
    observer.read(found)
    return found


def stated_reading(settings: Settings | None, strict: bool = False, **arguments: str | None) -> ClReading:
    """Return how settings that say nothing else, and arguments that stand for some of them, say that CL files are read.

    arguments  by the names of the settings

    Raises ``InputError`` for other settings, for what is stated twice, and as ``cl_reading`` does.
    """
    texts, given = as_texts(settings), {key: value for key, value in arguments.items() if value is not None}
    wording = Wording("ARG210", "not_of_reading", allowed=CL_SETTINGS)
    problems = [setting_problem(key, wording) for key in texts if key not in CL_SETTINGS]
    names = {"cl_units": "units"}
    problems += [
        argument_problem(names.get(key, key), Wording("ARG130", "setting_too", key=key))
        for key in given
        if key in texts
    ]
    problems += [
        setting_problem(key, RUN_SETTINGS[key].fault(key, value))
        for key, value in texts.items()
        if key in CL_SETTINGS and RUN_SETTINGS[key].choices and value not in RUN_SETTINGS[key].choices
    ]
    if problems:
        raise InputError(problems)
    return cl_reading({**texts, **given}, strict)


def cl_reading(settings: Mapping[str, str], strict: bool = False) -> ClReading:
    """Return how settings say that CL files are read.

    Raises ``InputError`` if the tolerance of splines is no number, or out of range, or no such value is stated of a
    cycle.
    """
    within = number_setting(settings, "spline_tolerance")
    return ClReading(
        settings.get("cl_units"), settings.get("dialect"), strict, within, settings.get("cutcom"),
        stated_cycles(settings),
    )  # fmt: skip


def _is_spline_tolerance(value: object) -> bool:
    """Whether splines may become points within this, mm."""
    return isinstance(value, int | float) and not isinstance(value, bool) and 1e-4 <= value <= 1.0


def load_machine(machine: FilePath) -> Machine:
    """Load the definition of a machine.

    Parameters
    ----------
    machine
        The name of a shipped machine, such as ``"yl569"`` (``trunnion machines`` lists them), or the path of a
        ``.toml`` file.

    Returns
    -------
    Machine
        Its axes from the workpiece to the tool, with their limits in mm and degrees.

    Raises
    ------
    InputError
        With every mistake of the definition, each at its file and line.

    Examples
    --------
    >>> import trunnion
    >>> [axis.name for axis in trunnion.load_machine("yl569").axes]
    ['C', 'B', 'X', 'Y', 'Z']
    """
    path = str(check_path("machine", machine))
    try:
        return machines.load_machine(path)
    except InputError:
        if not (path.endswith(".toml") and is_control_file(Path(path))):
            raise
        raise InputError(Problem(path, 0, Wording("DEF140", "control_for_machine"))) from None


def read_program(nc: FilePath, *, machine: MachineLike, subprograms: Sequence[FilePath] = ()) -> Run:
    """Read an NC program as the control of a machine does, and run it.

    Parameters
    ----------
    nc
        The program.
    machine
        The machine that runs it: a name, a path or a ``Machine``.
    subprograms
        Files of the subprograms that it calls. No others are opened.

    Returns
    -------
    Run
        One row a motion, in columns: ``tip`` (n, 3) mm and ``axis`` (n, 3) unit vectors in the workpiece frame,
        ``joints`` (n, 5) mm and degrees, ``feed``, ``tool``, ``spindle`` and more; ``events`` between the rows, and
        ``diagnostics``: words that are unknown or not acted upon.

    Raises
    ------
    InputError
        If a file cannot be read, is empty or a CL file, or if no reader knows the control.

    Notes
    -----
    The readers are written from the manuals of the controls and share no code with the writers.

    Examples
    --------
    >>> import trunnion
    >>> run = trunnion.read_program("tests/golden/yl569/2_hub_rough.expected.mpf", machine="yl569")
    >>> run.tip.shape, run.diagnostics
    ((30, 3), ())
    """
    program, others = check_path("nc", nc), check_paths("subprograms", subprograms)
    on = as_machine(machine)
    if unusable := unusable_file(program, phrase("file_of_program")):
        raise InputError(unusable)
    if not program.stat().st_size:
        raise InputError(Problem(str(program), 0, Wording("NC112", "file_empty")))
    try:
        run = readers.run_program(program, on, readers.RunOptions(subprograms=others))
    except InputError as error:
        _refuse_cl_file(program)
        if doubt := readers.kind_problem(program, on):
            raise InputError((doubt, *error.problems)) from None
        raise
    run = readers.with_role(run, program, on)
    if not run.errors:
        return run
    _refuse_cl_file(program)
    return readers.with_kind(run, program)


def _refuse_cl_file(program: Path) -> None:
    """Refuse a CL file in place of a program, by what moves in it: words of a program may look like those of one."""
    if not is_cl_file(program):
        return
    try:
        found = read_toolpaths(program, SILENT)
    except InputError:
        return
    if any(len(operation.moves) for toolpath in found for operation in toolpath.operations):
        raise InputError(Problem(str(program), 0, Wording("NC112", "cl_file_for_program")))


def as_run(
    nc: FilePath | Run,
    machine: Machine,
    subprograms: Sequence[FilePath] = (),
    names: tuple[str, str] = ("nc", "subprograms"),
) -> Run:
    """Return the run of a program; one that has already been read must have been read for this machine, set up as it
    is.

    Raises ``InputError`` if the file cannot be read, or a run is of another machine, workpiece zero or tool length: its
    positions were computed with those that it has.
    """
    others = check_paths(names[1], subprograms)
    if not isinstance(nc, Run):
        return read_program(check_path(names[0], nc), machine=machine, subprograms=others)
    if subprograms:
        raise InputError(Problem(nc.files[0], 0, Wording("ARG170", "subprograms_after_reading")))
    own = nc.machine
    if not _are_defined_alike(own, machine):
        raise InputError(
            Problem(nc.files[0], 0, Wording("ARG170", "read_for_other_machine", machine=own.key, asked=machine.key))
        )
    if not _is_set_up_so(nc, machine):
        raise InputError(Problem(nc.files[0], 0, Wording("ARG170", "read_with_other_setup")))
    return nc


def _is_set_up_so(run: Run, machine: Machine) -> bool:
    """Whether a run was read with the zeros and lengths that a machine states; those that it does not state may be any.

    A length that the program gives is none of the machine. The machine of a run is its own, whatever its tools.
    """
    if machine is run.machine:
        return True
    setups = () if run.setups is None else run.setups.each
    pairs = [
        (machine.set_up_for(each.tool, each.work_offset), each.machine, bool(each.length_source)) for each in setups
    ] or [(machine, run.machine, False)]
    return (run.setups is not None or not machine.has_single_values) and all(
        new.workpiece_zero in (None, old.workpiece_zero) and (is_given or new.tool_length in (None, old.tool_length))
        for new, old, is_given in pairs
    )


def _are_defined_alike(one: Machine, other: Machine) -> bool:
    """Whether two definitions say the same of machine and control; names and setup may differ."""
    content = (field.name for field in fields(Machine) if field.name not in _NO_CONTENT)
    return all(getattr(one, name) == getattr(other, name) for name in content) and _control(one) == _control(other)


def _control(machine: Machine) -> dict[str, object]:
    return resolve_extends(machine.control.unread_copy(), control_library()).to_dict()


def as_machine(machine: MachineLike, argument: str = "machine") -> Machine:
    """Return the machine itself, loaded if it is named; errors name the argument."""
    loaded = machine if isinstance(machine, Machine) else load_machine(check_path(argument, machine))
    readers.check_reading(loaded)
    check_statements(loaded)
    return loaded


def as_toolpaths(
    cl: ToolpathLike | Iterable[ToolpathLike], observer: Observer, how: ClReading = AS_IT_SAYS
) -> list[Toolpath]:
    """Return the toolpaths of one program, as ``read_toolpaths`` has them.

    Raises ``InputError`` if a file cannot be used, or the points of two files are in different coordinate systems.
    """
    toolpaths = read_toolpaths(cl, observer, how)
    if problem := other_system(toolpaths):
        raise InputError(problem)
    return toolpaths


def read_toolpaths(
    cl: ToolpathLike | Iterable[ToolpathLike], observer: Observer, how: ClReading = AS_IT_SAYS
) -> list[Toolpath]:
    """Toolpaths in their order, read if they are named.

    Raises ``InputError`` if a file cannot be used.
    """
    if isinstance(cl, str | os.PathLike | Toolpath) or is_stream(cl):
        cl = [cl]
    if isinstance(cl, bytes | Mapping) or not isinstance(cl, Iterable):
        raise wrong_argument("cl", cl, phrase("give_cl"))
    check_observer(observer)
    return [
        toolpath
        for each in cl
        for toolpath in ([each] if isinstance(each, Toolpath) else _read(each, how, observer, "cl"))
    ]
