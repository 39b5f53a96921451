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
from trunnion.conversion.program_events import COMPENSATION_FINDINGS
from trunnion.errors import InputError, Problem, RefusedError, Severity, argument_problem
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
        what, cure = "is given with to_cl" if given["to_cl"] else "is missing", "give either to_machine or to_cl=True"
        raise InputError(argument_problem("to_machine", what, cure, code="CNV110"))
    if given["to_dialect"] is None and given["dialect"] is not None and given["to_cl"]:
        what = "dialect is what a CL file is read in; to say what it is written in, to_dialect does"
        warnings.warn(what, FutureWarning, stacklevel=4)
        given = {**given, "to_dialect": given["dialect"], "dialect": None}
    if given["to_dialect"] is not None and not given["to_cl"]:
        what, cure = "is given, and no CL file is written", "leave it out, or give to_cl=True"
        raise InputError(argument_problem("to_dialect", what, cure, code="CNV110"))
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
            raise InputError(
                argument_problem(name, "is of CL files, and a program is read", "leave it out", code="ARG130")
            )
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


def _refuse_for_cl(**given: object) -> None:
    """Refuse arguments that are about NC programs."""
    if given["to_machine"] is not None:
        what, cure = "is missing", "give the machine that the NC program is for; post writes the program of a CL file"
        raise InputError(argument_problem("machine", what, cure, code="CNV110"))
    if name := next((name for name, value in given.items() if value), ""):
        what, cure = "has no meaning for a CL file", "leave it out, or give the machine that the NC program is for"
        raise InputError(argument_problem(name, what, cure, code="CNV110"))


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


def _setting_faults(settings: Mapping[str, str], job: PostJob) -> dict[str, str]:
    """Return the settings that the job's control cannot have for all operations or for one of them, each with
    its cure.
    """
    by_operation = _by_operation(settings, job.control)
    faults = [
        fault
        for own in by_operation.values()
        for fault in control_setting_faults({**by_operation[""], **own}, job.control, job.machine)
    ]
    return {key: cure for key, cure in faults if key in settings}


def check_conversion_settings(job: PostJob, to_cl: bool) -> None:
    """Raise ``InputError`` for settings that have no meaning in a conversion."""
    if "dialect" in job.settings:
        what, cure = "dialect has no meaning here", "an NC program is no CL file: leave it out"
        raise InputError(argument_problem("settings", what, cure, code="CNV111"))
    if "cl_units" in job.settings:
        what, cure = "cl_units has no meaning here", "an NC program says its unit itself"
        raise InputError(argument_problem("settings", what, cure, code="CNV111"))
    if "units" in job.settings and to_cl:
        raise InputError(
            argument_problem("settings", "units has no meaning here", "a CL file is written in mm", code="CNV111")
        )
    if "zero" in job.settings and to_cl:
        raise InputError(
            argument_problem("settings", "zero has no meaning in a CL file", "give it to trunnion post", code="CNV111")
        )


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
        found = [Problem(one.file, one.line, one.text, "", one.severity, code=one.code) for one in run.diagnostics]
        errors = [problem for problem in found if problem.severity is Severity.ERROR]
        if errors and not self._force:
            what = f"{counted(len(errors), 'place')} not understood, and nothing is written"
            cure = "force=True converts what was understood"
            raise RefusedError((*errors[:_MOST_NAMED], Problem(self._file, 0, what, cure, code="CNV120")))
        told = [each for each in found if not each.what.startswith(COMPENSATION_FINDINGS) and each.code != _OF_BUILDER]
        self.report(told)
        converted = conversion.convert(run, control)
        toolpath, of_builder = conversion.carry_machine_words(converted.toolpath, run.machine, target)
        converted = replace(converted, toolpath=toolpath)
        lost = [*converted.errors, *(problem for problem in of_builder if problem.severity is Severity.ERROR)]
        self._refuse(lost)
        self.report([problem for problem in of_builder if problem.severity is Severity.WARNING])
        if not converted.toolpath.operations:
            what = "there is no motion at the part in it"
            raise InputError(Problem(self._file, 0, what, "give a program that cuts", code="CNV121"))
        self.report(converted.warnings)
        return converted

    def _refuse(self, lost: Sequence[Problem]) -> None:
        """Refuse what must not be lost, unless it is forced."""
        if lost and not self._force:
            what = f"{counted(len(lost), 'place')} cannot be converted, and nothing is written"
            cure = "force=True converts the rest without them"
            raise RefusedError((*lost[:_MOST_NAMED], Problem(self._file, 0, what, cure, code="CNV130")))
        self.report(lost)

    def warn_of_one_program(self, files: int) -> None:
        """Warn that a program with subprograms becomes one without."""
        cure = "setting programs=operations writes several"
        self.report(
            [Problem(self._file, 0, f"{files} files become one program", cure, Severity.WARNING, code="CNV162")]
        )

    def warn_of_new_offset(self, run: Run, job: PostJob) -> None:
        """Warn where the old program cuts without a work offset of its own, and the new one selects one."""
        offset = {**job.control.settings, **job.settings}.get("work_offset", "")
        rows = np.flatnonzero((run.work_offset == 0) & ~run.machine_frame & (run.kind != Kind.RAPID))
        if not offset or not len(rows):
            return
        what = f"selects no work offset before it cuts; the new program selects work_offset={offset}"
        cure = "put the zero that held before into it, or give the setting work_offset"
        row = int(rows[0])
        self.report(
            [Problem(run.files[int(run.file[row])], int(run.line[row]), what, cure, Severity.WARNING, code="CNV144")]
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
            known = key in target.settings
            cure = f"say it as {target.name} does" if known else f"{target.name} has no such setting"
            what = f"{key} is {stated[key]!r}, which is not carried over"
            self.report([Problem(self._file, 0, what, cure, Severity.WARNING, code="CNV140")])
        for key, cure in _setting_faults(carried, job).items():
            self._not_carried(key, carried.pop(key), f"which {target.name} cannot have", cure, key in given)
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
        found, words = None, ""
        if "work_offset" in target.settings and readers.can_read(job.machine):
            own, others = readers.reader_of(source).work_offsets, readers.reader_of(job.machine).work_offsets
            found = conversion.carry_work_offset(text, own, others, control.family is target.family)
            words = f": it has {others.form}"
        if found is not None:
            return {} if found == default and "work_offset" not in stated else {"work_offset": found}
        if "work_offset" in stated:
            what = f"the work offset is {text}, which {target.name} does not have{words}"
            self._refuse(
                [Problem(self._file, 0, what, "setting work_offset=… says it as the other control does", code="CNV141")]
            )
        return {}

    def _not_carried(self, key: str, text: str, why: str, cure: str, is_given: bool) -> None:
        """Warn of a setting that is not carried over; refuse if it is work offsets that no given setting replaces."""
        if key == "work_offset" and ":" in text and not is_given:
            what = f"operations have different work offsets ({text}), {why}"
            self._refuse(
                [
                    Problem(
                        self._file, 0, what, "setting work_offset=… says them as the other control does", code="CNV143"
                    )
                ]
            )
            return
        what = f"{key} is {text!r}, {why}: it is not carried over"
        self.report([Problem(self._file, 0, what, cure, Severity.WARNING, code="CNV140")])
