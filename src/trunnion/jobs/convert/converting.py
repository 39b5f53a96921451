"""Conversion: an NC program back to a toolpath, and out again as a CL file or for another machine; CL to CL."""

import io
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, BinaryIO, ClassVar, Unpack

import numpy as np

from trunnion import conversion, readers
from trunnion.cl.writers import WRITERS
from trunnion.controls import Control, load_control
from trunnion.controls.vocabulary import INCH
from trunnion.conversion import Conversion
from trunnion.conversion.program_events import COMPENSATION_FINDINGS, COMPENSATION_WORDS
from trunnion.errors import InputError, Problem, RefusedError, Severity, argument_problem, setting_problem
from trunnion.files import OutputGroup
from trunnion.jit import compile_ahead
from trunnion.jobs import kernels
from trunnion.jobs.arguments import ConvertArguments, taken
from trunnion.jobs.convert.cl_files import convert_cl, write_and_prove
from trunnion.jobs.inputs.arguments import check_choice, check_observer, check_path, check_paths, is_stream
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import FilePath, as_machine, read_program
from trunnion.jobs.inputs.settings import control_setting_faults, set_up_machine
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.post.post_job import PostJob, prepare
from trunnion.jobs.post.posting import post_toolpaths
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.result_output import open_target, written_text
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind, Toolpath
from trunnion.placing.program_heads import damaged_notices, placed_notices, stated_place
from trunnion.results import FIRST, Figure
from trunnion.wording import counted

#: Places that are not understood which an error names one by one.
_MOST_NAMED = 20

#: The code of words of the machine's builder, of which a conversion says itself what becomes of them.
_OF_BUILDER = "NC225"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ConvertResult:
    """A program, or a CL file, that was converted.

    toolpath  what it makes the tool do
    settings  what it states and a toolpath has no place for, as ``trunnion.post`` takes it
    problems  warnings: what is not carried over; errors: what was not understood and ``force`` overruled
    posted    the program for the other machine with its proof; None: the result is a CL file
    output    file of the result; None: it was not written to a file
    """

    SCHEMA: ClassVar[int] = 2

    toolpath: Annotated[
        Toolpath,
        Figure("operations", take=lambda toolpath: len(toolpath.operations), after="output"),
        Figure("points", take=lambda toolpath: sum(len(each.moves) for each in toolpath.operations)),
    ]
    settings: Annotated[Mapping[str, str], Figure(after="points")]
    problems: Annotated[tuple[Problem, ...], Figure("remarks", after="posted")]
    posted: Annotated[PostResult | None, Figure(after="settings")]
    output: Path | None
    _memory: io.BytesIO | None

    def __repr__(self) -> str:
        """Return what matters in a notebook."""
        result = counted(len(self.toolpath.operations), "operation") if self.posted is None else repr(self.posted)
        return f"ConvertResult({result})"

    @property
    @Figure(after=FIRST)
    def passed(self) -> bool:
        """Whether all was understood and, with another machine, the program is proven and may run there."""
        understood = all(problem.severity is not Severity.ERROR for problem in self.problems)
        return understood and (self.posted is None or self.posted.passed)

    @property
    def text(self) -> str | None:
        """The CL file or the program; None where it went to a stream."""
        return written_text(self.output, self._memory)


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
        What the CL file is written in: ``"clsf"``, ``"catia"`` or ``"ncl"``. It is read back and compared before it
        appears.
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
    settings
        In place of what the program states; for the other machine as ``trunnion.post`` takes them. Between CL files:
        ``units`` of the one that is written.
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
    _refuse_for_cl(**{name: given[name] for name in ("to_machine", "subprograms", "zero", "tool_length", "force")})
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
    control = load_control(source.control)
    place = stated_place(program)
    job = prepare(target_machine, given["settings"], force=given["force"])
    if place.clamping is not None:
        job = replace(job, notices=placed_notices(place.clamping), clamping=place.clamping)
    check_conversion_settings(job, to_cl)
    definitions = [*machine_files(machine, source), *machine_files(to_machine or target_machine, target_machine)]
    source = set_up_machine(source, given["zero"], given["tool_length"])
    read, edited = [program, *others, *definitions], job.settings.get("edited", "")
    with open_target(given["output"], inputs=read, group=group, edited=edited) as target:
        compile_ahead(readers.KERNELS if to_cl else kernels.CONVERTING)
        divided = job.subprograms(target.files, target.path) is not None
        converter = _ProgramConverter(str(program), observer, given["force"])
        converter.report(damaged_notices(program, place))
        run = read_program(program, machine=source, subprograms=others)
        converted = converter.read(run, control, None if to_cl else job.machine)
        if others and not (divided or to_cl):
            converter.warn_of_one_program(1 + len(others))
        carried = converter.carry(converted.settings, control, job, source)
        posted = None
        if to_cl:
            if run.state.inches.values[-1] and control.settings.get("units") != INCH:
                carried["units"] = INCH
            comments = [*job.notices, *(f"--set {key}={value}" for key, value in carried.items())]
            whole = conversion.with_whole_notices(converted.toolpath, control.family)
            converter.report(write_and_prove(whole, target, str(given["to_dialect"]), comments=comments))
        else:
            is_given = "work_offset" in job.printed or any("work_offset" in own for own in job.own_settings.values())
            toolpath, notices = conversion.take_notices(converted.toolpath, control.family)
            job = replace(_with_settings(job, carried), notices=(*notices, *job.notices))
            if not is_given:
                converter.warn_of_new_offset(run, job)
            posted = post_toolpaths([toolpath], job, target, observer)
    problems = (*converter.problems, *(posted.problems if posted else ()))
    return ConvertResult(converted.toolpath, carried, problems, posted, target.path, target.memory)


def _is_carried_over(found: Problem) -> bool:
    """Whether the conversion itself carries over, or says, what a reader has noted."""
    wording = found.wording
    is_compensation = wording.variant in COMPENSATION_FINDINGS and wording.parameter("word") in COMPENSATION_WORDS
    return is_compensation or found.code == _OF_BUILDER


def _refuse_for_cl(**given: object) -> None:
    """Refuse arguments that are about NC programs."""
    if given["to_machine"] is not None:
        raise InputError(argument_problem("machine", Wording("CNV110", "missing_source_machine")))
    if name := next((name for name, value in given.items() if value), ""):
        raise InputError(argument_problem(name, Wording("CNV110", "no_meaning_for_cl_files")))


def _with_settings(job: PostJob, carried: Mapping[str, str]) -> PostJob:
    """Return a job with settings of which some are those of single operations; they have been judged."""
    own = _by_operation(carried, job.control)
    return replace(job, settings={**job.settings, **own.pop("")}, own_settings=own)


def _by_operation(settings: Mapping[str, str], control: Control) -> dict[str, dict[str, str]]:
    """Return settings by the names of their operations, at least those of all operations, which have no name."""
    found: dict[str, dict[str, str]] = {"": {}}
    for key, text in settings.items():
        for operation, value in control.values_by_operation(key, text):
            found.setdefault(operation, {})[key] = value
    return found


def _with_own(settings: Mapping[str, str], job: PostJob) -> dict[str, str]:
    """Return settings with those that the job has for single operations in place of theirs."""
    found = dict(settings)
    for operation, values in job.own_settings.items():
        for key, value in values.items():
            entries = dict(job.control.values_by_operation(key, found.get(key, ""))) | {operation: value}
            found[key] = ",".join(f"{name}:{text}" if name else text for name, text in entries.items() if text)
    return found


def _setting_faults(settings: Mapping[str, str], job: PostJob) -> dict[str, Wording]:
    """Return the settings that the job's control cannot have for all operations or for one of them, each with
    what to do.
    """
    by_operation = _by_operation(settings, job.control)
    faults = [
        fault
        for own in by_operation.values()
        for fault in control_setting_faults({**by_operation[""], **own}, job.control, job.machine)
    ]
    return {key: remedy for key, remedy in faults if key in settings}


def check_conversion_settings(job: PostJob, to_cl: bool) -> None:
    """Raise ``InputError`` for settings that have no meaning in a conversion."""
    if "dialect" in job.settings:
        raise InputError(setting_problem("dialect", Wording("CNV111", "no_dialect_of_programs")))
    if "cl_units" in job.settings:
        raise InputError(setting_problem("cl_units", Wording("CNV111", "program_states_unit")))
    if "units" in job.settings and to_cl:
        raise InputError(setting_problem("units", Wording("CNV111", "cl_file_in_mm")))
    if "zero" in job.settings and to_cl:
        raise InputError(setting_problem("zero", Wording("CNV111", "no_zero_in_cl_files")))


class _ProgramConverter:
    """Makes a toolpath of a program, and collects the warnings about what is lost."""

    def __init__(self, file: str, observer: Observer, force: bool) -> None:
        self.problems: list[Problem] = []
        self._file, self._observer, self._force = file, observer, force

    def report(self, problems: Sequence[Problem]) -> None:
        """Keep problems and report them."""
        self.problems += problems
        self._observer.problems(problems)

    def read(self, run: Run, control: Control, target: Machine | None) -> Conversion:
        """Return the toolpath of a run for another machine, None for a CL file; one that was not understood is
        refused.
        """
        found = [Problem(one.file, one.line, one.wording, severity=one.severity) for one in run.diagnostics]
        errors = [problem for problem in found if problem.severity is Severity.ERROR]
        if errors and not self._force:
            raise RefusedError(
                (*errors[:_MOST_NAMED], Problem(self._file, 0, Wording("CNV120", "not_understood", count=len(errors))))
            )
        self.report([each for each in found if not _is_carried_over(each)])
        converted = conversion.convert(run, control)
        toolpath, of_builder = conversion.carry_machine_words(converted.toolpath, run.machine, target)
        converted = replace(converted, toolpath=toolpath)
        lost = [*converted.errors, *(problem for problem in of_builder if problem.severity is Severity.ERROR)]
        self._refuse(lost)
        self.report([problem for problem in of_builder if problem.severity is Severity.WARNING])
        if not converted.toolpath.operations:
            raise InputError(Problem(self._file, 0, Wording("CNV121", "no_motion_at_part")))
        self.report(converted.warnings)
        return converted

    def _refuse(self, lost: Sequence[Problem]) -> None:
        """Refuse what must not be lost, unless it is forced."""
        if lost and not self._force:
            raise RefusedError(
                (*lost[:_MOST_NAMED], Problem(self._file, 0, Wording("CNV130", "cannot_be_converted", count=len(lost))))
            )
        self.report(lost)

    def warn_of_one_program(self, files: int) -> None:
        """Warn that a program with subprograms becomes one without."""
        self.report(
            [Problem(self._file, 0, Wording("CNV162", "becomes_one_program", files=files), severity=Severity.WARNING)]
        )

    def warn_of_new_offset(self, run: Run, job: PostJob) -> None:
        """Warn where the old program cuts without a work offset of its own, and the new one selects one."""
        offset = {**job.control.settings, **job.settings}.get("work_offset", "")
        rows = np.flatnonzero((run.work_offset == 0) & ~run.machine_frame & (run.kind != Kind.RAPID))
        if not offset or not len(rows):
            return
        row = int(rows[0])
        self.report(
            [
                Problem(
                    run.files[int(run.file[row])],
                    int(run.line[row]),
                    Wording("CNV144", "selects_offset_of_its_own", offset=offset),
                    severity=Severity.WARNING,
                )
            ]
        )

    def carry(self, stated: Mapping[str, str], control: Control, job: PostJob, source: Machine) -> dict[str, str]:
        """Return the settings of the new program: those that the old one states, as far as they mean the same, and the
        job's.

        Warns of each that is not carried over.
        """
        target, given = job.control, {*job.printed, *(key for own in job.own_settings.values() for key in own)}
        carried = conversion.transfer_settings(stated, control, target)
        if "work_offset" in job.settings:
            carried.pop("work_offset", None)
        carried |= self._carried_offset(stated, control, job, source)
        lost = stated.keys() - carried.keys() - {"work_offset"}
        if carried.keys() & target.method_defaults.keys():
            lost -= control.method_defaults.keys()  # the modes of both follow from the machining method
        for key in sorted(lost):
            self.report(
                [
                    Problem(
                        self._file,
                        0,
                        Wording(
                            "CNV140",
                            "setting_not_carried_over" if key in target.settings else "setting_unknown_there",
                            setting_name=key,
                            value=repr(stated[key]),
                            target=target.name,
                        ),
                        severity=Severity.WARNING,
                    )
                ]
            )
        for key, remedy in _setting_faults(carried, job).items():
            self._not_carried(key, carried.pop(key), target.name, remedy, key in given)
        carried = _with_own(carried | job.printed, job)
        if "tool" in job.printed and "tool_call" not in job.printed:
            carried.pop("tool_call", None)
        return carried

    def _carried_offset(
        self, stated: Mapping[str, str], control: Control, job: PostJob, source: Machine
    ) -> dict[str, str]:
        """Return the work offset as the other control says it, unless that is its default; one that it lacks is
        refused.
        """
        target = job.control
        if control.name == target.name or "work_offset" in job.settings or "work_offset" not in control.settings:
            return {}
        default = target.settings.get("work_offset", "")
        text = stated.get("work_offset", control.settings["work_offset"])
        found, form = None, ""
        if "work_offset" in target.settings and readers.can_read(job.machine):
            own, others = readers.reader_of(source).work_offsets, readers.reader_of(job.machine).work_offsets
            found = conversion.carry_work_offset(text, own, others, control.family is target.family)
            form = others.form
        if found is not None:
            return {} if found == default and "work_offset" not in stated else {"work_offset": found}
        if "work_offset" in stated:
            self._refuse(
                [
                    Problem(
                        self._file,
                        0,
                        Wording("CNV141", "no_such_offset_but", offset=text, target=target.name, form=form)
                        if form
                        else Wording("CNV141", "no_such_offset", offset=text, target=target.name),
                    )
                ]
            )
        return {}

    def _not_carried(self, key: str, text: str, target: str, remedy: Wording, is_given: bool) -> None:
        """Warn of a setting that is not carried over; refuse if it is work offsets that no given setting replaces."""
        if key == "work_offset" and ":" in text and not is_given:
            self._refuse(
                [
                    Problem(
                        self._file,
                        0,
                        Wording("CNV143", "offsets_of_operations_impossible", offsets=text, target=target),
                    )
                ]
            )
            return
        self.report(
            [
                Problem(
                    self._file,
                    0,
                    Wording(
                        "CNV140",
                        "setting_impossible_there",
                        setting_name=key,
                        value=repr(text),
                        target=target,
                        remedy=remedy,
                    ),
                    severity=Severity.WARNING,
                )
            ]
        )
