"""Conversion: an NC program back to a toolpath, and out again as a CL file or for another machine; CL to CL."""

import warnings
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO, Final, Unpack

from trunnion import conversion, readers
from trunnion.cl.writers import WRITERS
from trunnion.controls import load_control
from trunnion.controls.vocabulary import INCH, RADIUS_NUMBER_WORD
from trunnion.errors import InputError, RefusedError, argument_problem, setting_problem
from trunnion.files import OutputGroup
from trunnion.jit import compile_ahead
from trunnion.jobs import kernels
from trunnion.jobs.arguments import ConvertArguments, taken
from trunnion.jobs.convert.cl_files import convert_cl, write_and_prove
from trunnion.jobs.convert.program_converter import ProgramConverter, with_settings
from trunnion.jobs.convert.registers import checked_registers
from trunnion.jobs.convert.result import ConvertResult
from trunnion.jobs.inputs.arguments import check_choice, check_observer, check_path, check_paths, is_stream
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import FilePath, as_machine, read_program
from trunnion.jobs.inputs.stated_operations import with_stated_operations
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.jobs.inputs.stated_words import with_stated
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.post.post_job import PostJob, prepare
from trunnion.jobs.post.posting import post_toolpaths
from trunnion.jobs.result_output import open_target
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.options.words import CL_SETTINGS, POSITIONS
from trunnion.placing.program_heads import damaged_notices, placed_notices, stated_place
from trunnion.verification import stated_texts

#: Settings that have a meaning for CL files alone, and that a program does not have otherwise.
_OF_CL_FILES: Final = {*CL_SETTINGS} - {"cl_units", "dialect"}


def convert(
    nc: FilePath | BinaryIO, *, observer: Observer = SILENT, **given: Unpack[ConvertArguments]
) -> ConvertResult:
    """Convert an NC program to a CL file, or post it for another machine and prove it; or a CL file to another dialect.

    Parameters
    ----------
    nc
        The program; without a machine, a CL file or stream of any dialect that ``read_cl`` reads.
    machine
        The machine that it is for: a name, a path or a ``Machine``. None: ``nc`` is a CL file.
    to_machine, to_cl
        One of both: the machine for which it is posted, or True for a CL file.
    to_dialect
        What the CL file is written in: ``"clsf"``, ``"catia"``, ``"ncl"`` or ``"trunnion"``. It is read back and
        compared before it appears.
    units, dialect, strict
        How a CL file is read, as ``trunnion.read_cl`` has it.
    output
        File of the result, or a binary stream; None: the result has the text. Never a file that is read.
    subprograms
        Files of the subprograms that it calls. No others are opened.
    zero : (3,) float, mm
        Workpiece zero on the program's own machine.
    tool_length
        Length of the tool there, gauge point to tip, mm.
    positions
        What positions are while no tool length is in force: those of the ``"tip"``, or of the ``"gauge_line"``, which
        needs ``tool_length``. A program that cuts so is refused until it is stated.
    registers
        What registers of the program are on the other control: ``{"D21": "tool", "H11": "H1"}``.
    settings
        In place of what the program states; for the other machine as ``trunnion.post`` takes them. Between CL files:
        ``units`` of the one that is written. And values of variables that the program reads and does not set, such as
        ``{"R5": 2}``.
    assume
        What words do that the reader does not know, as for ``verify``.
    force
        Convert what was understood, and write a program that must not run; its head says so.
    observer
        Receives the progress, warnings and the proof.

    Returns
    -------
    ConvertResult
        ``toolpath``; ``settings`` that make the same head again; ``text``; ``posted`` with the proof.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or there is no motion at the part.
    RefusedError
        When the program has words that are not understood, or when the new one must not run, or when a CL file would
        read back otherwise; nothing is written.

    Examples
    --------
    >>> import trunnion
    >>> program = "tests/golden/yl569/2_hub_rough.expected.mpf"
    >>> converted = trunnion.convert(program, machine="yl569", to_machine="generic_head_head_ca")
    >>> converted.posted.passed
    True
    """
    return convert_beside(nc, given, observer)


def convert_beside(
    nc: FilePath | BinaryIO, given: ConvertArguments, observer: Observer, group: OutputGroup | None = None
) -> ConvertResult:
    """Convert as ``convert`` does; the result appears with those of the ``group``, if there is one."""
    check_observer(observer)
    arguments = _checked(taken(ConvertArguments, "convert", given))
    if arguments["machine"] is None:
        return _converted_cl(nc, arguments, observer, group)
    return _converted_program(check_path("nc", nc), arguments, observer, group)


def _checked(given: ConvertArguments) -> ConvertArguments:
    """Return the arguments, of which those go together that are about the result."""
    check_paths("subprograms", given["subprograms"])
    if (given["to_machine"] is None) is not given["to_cl"]:
        raise InputError(
            argument_problem("to_machine", Wording("CNV110", "two_targets" if given["to_cl"] else "no_target"))
        )
    if given["to_dialect"] is None and given["dialect"] is not None and given["to_cl"]:
        what = "dialect is what a CL file is read in; to say what it is written in, to_dialect does"
        warnings.warn(what, FutureWarning, stacklevel=4)
        given = {**given, "to_dialect": given["dialect"], "dialect": None}
    if given["to_dialect"] is not None and not given["to_cl"]:
        raise InputError(argument_problem("to_dialect", Wording("CNV110", "dialect_without_cl_file")))
    dialect = given["to_dialect"] or "clsf"
    check_choice("to_dialect", dialect, tuple(WRITERS))
    return {**given, "to_dialect": dialect}


def _converted_cl(
    nc: FilePath | BinaryIO, given: ConvertArguments, observer: Observer, group: OutputGroup | None
) -> ConvertResult:
    """Return a CL file that was written in another dialect."""
    _refuse_for_cl(
        **{
            name: given[name]
            for name in (
                "to_machine",
                "subprograms",
                "zero",
                "tool_length",
                "positions",
                "registers",
                "assume",
                "force",
            )
        }
    )
    source = nc if is_stream(nc) else check_path("nc", nc)
    read = [source] if isinstance(source, Path) else []
    edited = str((given["settings"] or {}).get("edited", ""))
    with open_target(given["output"], inputs=read, group=group, edited=edited) as target:
        toolpath, remarks = convert_cl(source, target, given, observer)
    return ConvertResult(toolpath, {}, remarks, None, target.path, target.memory)


def _converted_program(
    program: Path, given: ConvertArguments, observer: Observer, group: OutputGroup | None
) -> ConvertResult:
    """Return an NC program as a CL file, or as that of another machine."""
    for name in ("units", "dialect"):
        if given.get(name) is not None:
            raise InputError(argument_problem(name, Wording("ARG130", "only_for_cl_files")))
    to_cl, others = given["to_cl"], given["subprograms"]
    machine, to_machine = given["machine"], given["to_machine"]
    assert machine is not None
    source = as_machine(machine)
    target_machine = source if to_machine is None else as_machine(to_machine, "to_machine")
    source, settings = with_stated(source, given["settings"], given["assume"])
    control = load_control(source.control).with_rotary_axes(len(source.own_rotary))
    place = stated_place(program)
    job = prepare(target_machine, settings, force=given["force"])
    if place.clamping is not None:
        job = replace(job, notices=placed_notices(place.clamping), clamping=place.clamping)
    check_conversion_settings(job, to_cl)
    definitions = [*machine_files(machine, source), *machine_files(to_machine or target_machine, target_machine)]
    source, registers = _with_positions(given, source), checked_registers(given["registers"])
    read, edited = [program, *others, *definitions], job.settings.get("edited", "")
    with open_target(given["output"], inputs=read, group=group, edited=edited) as target:
        compile_ahead(readers.KERNELS if to_cl else kernels.CONVERTING)
        divided = job.subprograms(target.files, target.path) is not None
        converter = ProgramConverter(str(program), observer, given["force"])
        converter.report(damaged_notices(program, place))
        run = read_program(program, machine=source, subprograms=others)
        converter.refuse(conversion.unsaid_positions(run, given["positions"]))
        converted = converter.read(run, control, None if to_cl else job)
        known = conversion.with_registers(converted.toolpath, registers)
        (toolpath,) = with_stated_operations([known], job.settings)
        said = [each for each in toolpath.remarks if each not in known.remarks]
        (converter.report if to_cl else observer.problems)(said)  # those of a post are in its result
        converted = replace(converted, toolpath=toolpath)
        if not to_cl and RADIUS_NUMBER_WORD not in job.control.family.WORDS:
            converter.refuse(conversion.unsaid_registers(converted.toolpath, job.control.name))
        if others and not (divided or to_cl):
            converter.warn_of_one_program(1 + len(others))
        carried = converter.carry(converted.settings, control, job, source)
        is_given = "work_offset" in job.printed or any("work_offset" in own for own in job.own_settings.values())
        posted = None
        if to_cl:
            converter.refuse_lost()
            if run.state.inches.values[-1] and control.settings.get("units") != INCH:
                carried["units"] = INCH
            comments = [*job.notices, *(f"--set {key}={value}" for key, value in carried.items())]
            whole = conversion.with_whole_notices(converted.toolpath, control.family)
            converter.report(write_and_prove(whole, target, str(given["to_dialect"]), comments=comments))
            if not is_given:
                converter.warn_of_new_offset(converted.without_offset, job, to_cl=True)
        else:
            toolpath, notices = conversion.take_notices(converted.toolpath, control.family)
            job = replace(with_settings(job, carried), notices=(*notices, *job.notices))
            if not is_given:
                converter.warn_of_new_offset(converted.without_offset, job, to_cl=False)
            try:
                posted = post_toolpaths([toolpath], job, target, SILENT if converter.lost else observer)
            except (InputError, RefusedError) as error:
                converter.refuse_lost(error.problems)
                raise
            converter.refuse_lost()
    problems = (*converter.problems, *(posted.problems if posted else ()))
    return ConvertResult(converted.toolpath, carried, problems, posted, target.path, target.memory, stated_texts(run))


def _with_positions(given: ConvertArguments, source: Machine) -> Machine:
    """Return the program's own machine, set up. Where positions are those of the tip, no tool length counts."""
    machine = set_up_machine(source, given["zero"], given["tool_length"])
    if given["positions"] is None:
        return machine
    check_choice("positions", given["positions"], POSITIONS)
    return machine if given["positions"] != "tip" else replace(machine, tool_length=None, tool_lengths={})


def _refuse_for_cl(**given: object) -> None:
    """Refuse arguments that are about NC programs."""
    if given["to_machine"] is not None:
        raise InputError(argument_problem("machine", Wording("CNV110", "missing_source_machine")))
    if name := next((name for name, value in given.items() if value), ""):
        raise InputError(argument_problem(name, Wording("CNV110", "no_meaning_for_cl_files")))


def check_conversion_settings(job: PostJob, to_cl: bool) -> None:
    """Raise ``InputError`` for settings that have no meaning in a conversion."""
    if "dialect" in job.settings:
        raise InputError(setting_problem("dialect", Wording("CNV111", "no_dialect_of_programs")))
    if "cl_units" in job.settings:
        raise InputError(setting_problem("cl_units", Wording("CNV111", "program_states_unit")))
    for name in sorted(_OF_CL_FILES & {*job.settings}):
        raise InputError(setting_problem(name, Wording("CNV111", "only_of_cl_files")))
    if "units" in job.settings and to_cl:
        raise InputError(setting_problem("units", Wording("CNV111", "cl_file_in_mm")))
    if "zero" in job.settings and to_cl:
        raise InputError(setting_problem("zero", Wording("CNV111", "no_zero_in_cl_files")))
