"""The work on one file for one machine: step after step up to the first that fails, all in memory and temporary files.

Nothing is written beside the file, and nothing comes back but what is wrong.
"""

import sys
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import field, replace
from enum import StrEnum
from functools import cache
from pathlib import Path, PurePosixPath
from typing import Any, Final

from trunnion.batch.processing import work
from trunnion.batch.result_keys import program_version
from trunnion.batch.worker_task import FILES, Action, Outcome, Status, Task
from trunnion.batch.workers import hindered, hindrance
from trunnion.controls import load_control
from trunnion.errors import Severity, TrunnionError
from trunnion.jobs.arguments import ReadingArguments
from trunnion.jobs.describe.cl_files import describe_cl
from trunnion.jobs.describe.reading_keys import Value, proposed_reading
from trunnion.jobs.inputs.reading import as_machine
from trunnion.machines import Machine
from trunnion.options.words import PROOF_SETTINGS
from trunnion.readers import reader_of, with_reading
from trunnion.records import dataclass
from trunnion.survey.found_files import MOST_BYTES, is_touchable
from trunnion.survey.stand_ins import stand_ins

#: Memory that a worker may take, bytes; beyond it the file is given up, and not the computer.
_MEMORY: Final = 4 << 30

#: Name of what is posted or converted, within the folder of the work.
_NAME: Final = "survey"

#: The code of a call of a file that is not known, and bytes of files beside a program that are given to it then.
_CALLS_FILE: Final = "NC132"
_MOST_BESIDE: Final = 50_000_000

#: A setting of a post that ``verify`` has as an argument alone.
_FRAME: Final = "frame"

#: Of an outcome: the step that it is of, and the settings or keys without which it would not have passed.
STEP: Final = "step"
SETTINGS: Final = "filled_in"
KEYS: Final = "reading_keys"


class Step(StrEnum):
    """What is tried."""

    INFO = "info"
    POST = "post"
    SETTINGS = "settings"
    VERIFY = "verify"
    KEYS = "keys"
    CONVERT = "convert"


@dataclass(frozen=True, slots=True)
class Trial:
    """What is tried with a file.

    file     its name from the folder on
    machine  name of a shipped one, or an absolute path
    steps    in their order; ``SETTINGS`` posts again where errors ask for settings, with stand-ins for them;
             ``KEYS`` reads a program again with the keys under which it reads best, if it fails without;
             ``VERIFY`` and ``CONVERT`` of a CL file are of the program that was posted
    reading  how CL files are read
    """

    file: str
    path: Path
    machine: str
    steps: tuple[Step, ...]
    reading: ReadingArguments = field(default_factory=ReadingArguments)


@dataclass(slots=True)
class _Subject:
    """What the steps work on: files by their logical names, the CL file, and the program with its subprograms.

    settings  stand-ins with which it was posted
    keys      keys of ``[control.reading]`` with which it was read
    asked     the outcome without either
    """

    trial: Trial
    files: dict[str, bytes]
    cl: str = ""
    program: str = ""
    subprograms: tuple[str, ...] = ()
    settings: Mapping[str, str] = field(default_factory=dict)
    keys: Mapping[str, Value] = field(default_factory=dict)
    asked: Outcome | None = None


def try_in_worker(trial: Trial) -> Outcome:
    """Do the steps in a process whose memory is limited."""
    _limit_memory()
    return try_steps(trial)


def try_steps(trial: Trial) -> Outcome:
    """Do the steps; return what came of the last one that was begun, without its files."""
    try:
        with trial.path.open("rb") as stream:
            content = stream.read(MOST_BYTES)
    except OSError as error:
        return Outcome(Status.HINDERED, (hindered(trial.file, error.strerror or str(error)),))
    name = FILES + trial.file
    subject = _Subject(trial, {name: content})
    if Step.POST in trial.steps:
        subject.cl = name
    else:
        subject.program = name
    outcome, warnings = Outcome(Status.PASSED), 0
    for step in trial.steps:
        if step in _AGAIN:
            continue
        outcome = _DOING[step](subject)
        if step is Step.POST and Step.SETTINGS in trial.steps and outcome.status is not Status.PASSED:
            outcome = _with_settings(subject, outcome)
        if step is Step.VERIFY and Step.KEYS in trial.steps and outcome.status is Status.FAILED:
            outcome = _with_keys(subject, outcome)
        warnings += outcome.warnings
        outcome = replace(outcome, figures={**outcome.figures, STEP: str(step)})
        if outcome.status is not Status.PASSED and not _is_asked_for_settings(step, trial, outcome):
            break
    if subject.keys:
        outcome = replace(outcome, figures={**outcome.figures, KEYS: dict(subject.keys)})
    if subject.asked is not None and outcome.status is Status.PASSED:
        filled = {SETTINGS: dict(subject.settings)} if subject.settings else {}
        figures = {**subject.asked.figures, **outcome.figures, **filled}
        outcome = replace(outcome, problems=subject.asked.problems, figures=figures)
    told = tuple(replace(each, file=_shown(each.file, trial)) for each in outcome.problems)
    return replace(outcome, files={}, warnings=warnings, problems=told)


def _is_asked_for_settings(step: Step, trial: Trial, outcome: Outcome) -> bool:
    """Whether a CL file cannot even be described without settings, and is posted with stand-ins for them."""
    return step is Step.INFO and Step.SETTINGS in trial.steps and bool(stand_ins(outcome.problems))


def _shown(file: str, trial: Trial) -> str:
    """Return a file as the survey names it: the program that was posted has no place of its own."""
    return f"{trial.file} (its program)" if Path(file).stem == _NAME and file != trial.file else file


@cache
def _limit_memory() -> None:
    """Limit the memory of this process, where the system can."""
    if sys.platform == "win32":
        return
    import resource

    _, most = resource.getrlimit(resource.RLIMIT_DATA)
    least = _MEMORY if most == resource.RLIM_INFINITY else min(_MEMORY, most)
    resource.setrlimit(resource.RLIMIT_DATA, (least, most))


def _info(subject: _Subject) -> Outcome:
    trial = subject.trial
    try:
        describe_cl(trial.path, **trial.reading)
    except TrunnionError as error:
        if (why := hindrance(error)) is not None:
            return Outcome(Status.HINDERED, (hindered(trial.file, why),))
        errors = [each for each in error.problems if each.severity is Severity.ERROR]
        told = tuple(replace(each, file=each.file.replace(str(trial.path), trial.file)) for each in errors)
        return Outcome(Status.UNUSABLE, told, figures={"error_codes": dict(Counter(each.code for each in told))})
    return Outcome(Status.PASSED)


def _with_settings(subject: _Subject, outcome: Outcome) -> Outcome:
    """Return what comes of a post with stand-ins for the settings that its errors ask for."""
    subject.settings, subject.asked = stand_ins(outcome.problems), outcome
    return _post(subject) if subject.settings else outcome


def _with_keys(subject: _Subject, outcome: Outcome) -> Outcome:
    """Return what comes of a program with the keys under which it reads best."""
    with suppress(TrunnionError):  # of a file that cannot be read, which its outcome says
        subject.keys = proposed_reading(subject.trial.path, as_machine(subject.trial.machine)).keys
    if not subject.keys:
        return outcome
    subject.asked = outcome
    return _verified(subject)


def _post(subject: _Subject) -> Outcome:
    machine = subject.trial.machine
    # ``strict`` would ask for all that a proof stands on as well; unknown statements were refused by ``INFO``.
    reading = subject.trial.reading
    stated = {"cl_units": reading.get("units"), "dialect": reading.get("dialect")}
    settings = {**subject.settings, **{name: value for name, value in stated.items() if value is not None}}
    arguments: dict[str, Any] = {"machine": machine, "settings": settings}
    outcome = _worked(subject, Action.POST, subject.cl, arguments, _NAME + _extension(machine))
    programs = {FILES + name: data for name, data in outcome.files.items()}
    if programs:
        subject.files |= programs
        subject.program = FILES + _NAME + _extension(machine)
        subject.subprograms = tuple(name for name in programs if name != subject.program)
    return outcome


def _verify(subject: _Subject) -> Outcome:
    outcome = _verified(subject)
    if not subject.cl and _CALLS_FILE in outcome.figures.get("error_codes", ()) and _take_beside(subject):
        return _verified(subject)
    return outcome


def _take_beside(subject: _Subject) -> bool:
    """Give a program the files beside it that it can call; return whether there are any."""
    trial = subject.trial
    beside = sorted(each for each in trial.path.parent.iterdir() if each != trial.path and is_touchable(each))
    room = _MOST_BESIDE
    for path in reader_of(as_machine(trial.machine)).callable_files(beside):
        with suppress(OSError):
            content = path.read_bytes()
            if (room := room - len(content)) < 0:
                break
            subject.files[FILES + PurePosixPath(trial.file).with_name(path.name).as_posix()] = content
    subject.subprograms = tuple(name for name in subject.files if name != subject.program)
    return bool(subject.subprograms)


def _verified(subject: _Subject) -> Outcome:
    arguments: dict[str, Any] = {"machine": _reading(subject), "subprograms": list(subject.subprograms)}
    if subject.cl:
        proven = {name: value for name, value in subject.settings.items() if name in PROOF_SETTINGS}
        arguments |= {"cl": [subject.cl], "settings": proven}
        arguments |= {name: value for name, value in subject.trial.reading.items() if name != "strict"}
        arguments |= {_FRAME: subject.settings[_FRAME]} if _FRAME in subject.settings else {}
    return _worked(subject, Action.VERIFY, subject.program, arguments, "")


def _reading(subject: _Subject) -> Machine | str:
    """Return the machine, with the keys of the program."""
    name = subject.trial.machine
    return with_reading(as_machine(name), subject.keys) if subject.keys else name


def _convert(subject: _Subject) -> Outcome:
    arguments = {"machine": _reading(subject), "to_cl": True, "subprograms": list(subject.subprograms)}
    return _worked(subject, Action.CONVERT, subject.program, arguments, f"{_NAME}.cls")


def _worked(subject: _Subject, action: Action, file: str, arguments: Mapping[str, Any], result: str) -> Outcome:
    files = {name: subject.files[name] for name in (file, subject.cl, *subject.subprograms) if name}
    return work(Task(program_version(), action, arguments, file, files, {}, result, ""))


@cache
def _extension(machine: str) -> str:
    return load_control(as_machine(machine).control).extension


#: Steps that do the one before them again.
_AGAIN: Final = frozenset({Step.SETTINGS, Step.KEYS})

_DOING: Final[Mapping[Step, Callable[[_Subject], Outcome]]] = {
    Step.INFO: _info,
    Step.POST: _post,
    Step.VERIFY: _verify,
    Step.CONVERT: _convert,
}
