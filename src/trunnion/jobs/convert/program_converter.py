"""A program as a toolpath and settings, with warnings about all that is not carried over."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from trunnion import conversion, readers
from trunnion.controls import Control
from trunnion.conversion import Conversion
from trunnion.conversion.program_events import COMPENSATION_FINDINGS, COMPENSATION_WORDS
from trunnion.errors import InputError, Problem, RefusedError, Severity, warning
from trunnion.jobs.inputs.settings import control_setting_faults
from trunnion.jobs.observer import Observer
from trunnion.jobs.post.post_job import PostJob
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.run import Run

#: Problems of conversions, and those of posts that say the same.
_SAID_FOR = {"CNV146": "CTL230"}

#: The code of words of the machine's builder, of which a conversion says itself what becomes of them.
_OF_BUILDER = "NC225"


class ProgramConverter:
    """Makes a toolpath of a program, and collects the warnings about what is lost."""

    def __init__(self, file: str, observer: Observer, force: bool) -> None:
        self.problems: list[Problem] = []
        self.lost: list[Problem] = []
        self._file, self._observer, self._force = file, observer, force

    def report(self, problems: Sequence[Problem]) -> None:
        """Keep problems and report them."""
        self.problems += problems
        self._observer.problems(problems)

    def read(self, run: Run, control: Control, job: PostJob | None) -> Conversion:
        """Return the toolpath of a run for another machine, None for a CL file; one that was not understood is
        refused.
        """
        found = [Problem(one.file, one.line, one.wording, severity=one.severity) for one in run.diagnostics]
        errors = [problem for problem in found if problem.severity is Severity.ERROR]
        if errors and not self._force:
            raise RefusedError(
                (*errors, Problem(self._file, 0, Wording("CNV120", "not_understood", count=len(errors))))
            )
        self.report([each for each in found if not _is_carried_over(each)])
        converted = conversion.convert(run, control, job.control if job else None)
        target = job.machine if job else None
        toolpath, of_builder = conversion.carry_machine_words(converted.toolpath, run.machine, target)
        converted = replace(converted, toolpath=toolpath)
        lost = [*converted.errors, *(problem for problem in of_builder if problem.severity is Severity.ERROR)]
        self.refuse(lost)
        self.report([problem for problem in of_builder if problem.severity is Severity.WARNING])
        if not converted.toolpath.operations:
            self.refuse_lost()
            raise InputError(Problem(self._file, 0, Wording("CNV121", "no_motion_at_part")))
        self.report(converted.warnings)
        return converted

    def refuse(self, lost: Sequence[Problem]) -> None:
        """Keep what must not be lost, so that all of it is refused at once; only report it if it is forced."""
        if self._force:
            self.report(lost)
        else:
            self.lost += lost

    def refuse_lost(self, more: Sequence[Problem] = ()) -> None:
        """Raise ``RefusedError`` with all that was kept, and with what the new program is refused for."""
        if self.lost:
            said = {_SAID_FOR[each.code] for each in self.lost if each.code in _SAID_FOR}
            every = [*self.lost, *(each for each in more if each.code not in said)]
            count = Problem(self._file, 0, Wording("CNV130", "cannot_be_converted", count=len(every)))
            raise RefusedError((*every, count))

    def warn_of_one_program(self, files: int) -> None:
        """Warn that a program with subprograms becomes one without."""
        self.report([warning(self._file, 0, Wording("CNV162", "becomes_one_program", files=files))])

    def warn_of_new_offset(self, place: tuple[str, int] | None, job: PostJob, *, to_cl: bool) -> None:
        """Warn where the old program cuts without a work offset of its own, and the new one selects one; a CL file
        leaves that to who posts it.

        place   file and line of the first such cut; None: there is none
        job     of the new program; with a CL file, of one for the old machine
        """
        offset = {**job.control.settings, **job.settings}.get("work_offset", "")
        if not offset or place is None:
            return
        wording = (
            Wording("CNV144", "selects_none")
            if to_cl
            else Wording("CNV144", "selects_offset_of_its_own", offset=offset)
        )
        self.report([warning(*place, wording)])

    def carry(self, stated: Mapping[str, str], control: Control, job: PostJob, source: Machine) -> dict[str, str]:
        """Return the settings of the new program: those that the old one states, as far as they mean the same, and the
        job's.

        Warns of each that is not carried over.
        """
        target, given = job.control, {*job.printed, *(key for own in job.own_settings.values() for key in own)}
        carried = conversion.transfer_settings(stated, control, target)
        carried |= self._carried_offset(stated, control, job, source)
        lost = stated.keys() - carried.keys() - job.printed.keys() - {"work_offset"}
        if (carried.keys() | job.printed.keys()) & target.method_defaults.keys():
            lost -= control.method_defaults.keys()  # the modes of both follow from the machining method
        for key in sorted(lost):
            self.report(
                [
                    warning(
                        self._file,
                        0,
                        Wording(
                            "CNV140",
                            "setting_not_carried_over" if key in target.settings else "setting_unknown_there",
                            setting_name=key,
                            value=repr(stated[key]),
                            target=target.name,
                        ),
                    )
                ]
            )
        # What the job states for all operations takes their place, whatever the program has.
        carried = {key: value for key, value in carried.items() if key not in job.printed}
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
            self.refuse(
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
            self.refuse(
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
                warning(
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
                )
            ]
        )


def _is_carried_over(found: Problem) -> bool:
    """Whether the conversion itself carries over, or says, what a reader has noted."""
    wording = found.wording
    is_compensation = wording.variant in COMPENSATION_FINDINGS and wording.parameter("word") in COMPENSATION_WORDS
    return is_compensation or found.code == _OF_BUILDER


def with_settings(job: PostJob, carried: Mapping[str, str]) -> PostJob:
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
