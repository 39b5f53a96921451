"""A program of its own for each operation: what one leaves for the next, it has to say itself.

In:     toolpaths of one program, and its job.
Out:    the toolpath, the settings and the file of each operation's program.
"""

import re
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Final

from trunnion import readers
from trunnion.errors import InputError, Problem, RefusedError, Severity, setting_problem
from trunnion.jobs.inputs.settings import check_operation_names
from trunnion.jobs.post.post_job import PostJob
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import (
    BlockSkip,
    CutterComp,
    CycleOff,
    CycleOn,
    Event,
    LoadTool,
    Operation,
    SpindleOff,
    SpindleOn,
    Toolpath,
)
from trunnion.output.program import Program
from trunnion.output.validation.tools import tool_conflicts
from trunnion.records import dataclass

#: Letters of an operation that the name of its file repeats.
_MOST_LETTERS: Final = 40

_OTHER_CHARACTERS: Final = re.compile(r"[^A-Za-z0-9]+")


@dataclass(frozen=True, slots=True, eq=False)
class OperationProgram:
    """What the program of one operation is made from, and its file."""

    toolpath: Toolpath
    settings: dict[str, str]
    output: Path


def operation_programs(toolpaths: Sequence[Toolpath], job: PostJob, output: Path) -> list[OperationProgram]:
    """Return the programs of the operations that move, in their order, numbered from 1.

    toolpaths  of one program, in their order
    job        of that program
    output     ``top.mpf`` gives ``top_1_ROUGH.mpf``, ``top_2_FINISH.mpf`` and so on

    Raises ``InputError`` if a setting is for an operation that there is none of, or nothing moves.

    Raises ``RefusedError`` if an operation leaves something on that the next one goes on with, or is in a coordinate
    system of its own.
    """
    moving = [(path, own) for path in toolpaths for own in path.operations if len(own.moves)]
    if not moving:
        raise InputError(Problem(toolpaths[0].file, 0, Wording("CL140", "nothing_moves")))
    names = [operation.name for _, operation in moving]
    check_operation_names(job.own_settings, job.settings, names)
    _check_modes(job.settings.get("mode", ""), names)
    _check_apart(moving, is_absolute=job.options.absolute_frame)
    found = []
    with_remarks = set[int]()
    for number, (toolpath, operation) in enumerate(_with_what_is_on(moving), 1):
        settings = _settings_of(operation.name, number, job)
        remarks = () if id(toolpath) in with_remarks else toolpath.remarks  # told once
        with_remarks.add(id(toolpath))
        name = f"{output.stem}_{number}_{_plain(operation.name)}".rstrip("_") + output.suffix
        own = replace(toolpath, operations=(operation,), remarks=remarks)
        found.append(OperationProgram(own, settings, output.with_name(name)))
    return found


def check_tools(motions: Sequence[Motion], job: PostJob, file: str) -> list[Problem]:
    """Hold the tools of operations against each other as in one program: the operator puts them into one magazine.

    list  warnings of tools that have several names

    Raises ``RefusedError`` if operations call one tool and state different ones.
    """
    program = Program(job.machine, job.control, motions, job.printed, file, own_settings=job.own_settings)
    by_register = readers.can_read(job.machine) and readers.reader_of(job.machine).uses_length_numbers
    found = tool_conflicts(program, uses_length_numbers=by_register)
    if errors := [problem for problem in found if problem.severity is Severity.ERROR]:
        raise RefusedError(errors)
    return found


def programs_of_operations(output: Path) -> list[Path]:
    """Return the files that are called as programs of operations would be, whatever they hold, sorted."""
    beginning, end = re.escape(output.stem), re.escape(output.suffix)
    form = re.compile(rf"{beginning}_[0-9]{{1,5}}(_[A-Za-z0-9_]*)?{end}")
    return sorted(file for file in output.parent.glob("*") if form.fullmatch(file.name))


def _plain(name: str) -> str:
    letters = unicodedata.normalize("NFKD", name)
    plain = "".join(one for one in letters if not unicodedata.combining(one))
    return _OTHER_CHARACTERS.sub("_", plain).strip("_")[:_MOST_LETTERS].strip("_")


def _settings_of(name: str, number: int, job: PostJob) -> dict[str, str]:
    """Return the settings of an operation as those of a program; programs count on from the number or name
    that is set.
    """
    settings = {**job.settings, **job.own_settings.get(name, {})}
    if "mode" in settings:
        entries = [entry.rpartition(":") for entry in settings["mode"].split(",")]
        own = [word for operation, _, word in entries if operation == name]
        every = [word for operation, _, word in entries if not operation]
        settings["mode"] = (own or every or ["auto"])[-1]
    program = settings.get("program") or job.control.settings.get("program", "")
    if program and job.control.has_effect("program"):
        is_number = program.isascii() and program.isdecimal()
        settings["program"] = f"{int(program) + number - 1:0{len(program)}d}" if is_number else f"{program}_{number}"
    return settings


def _check_modes(text: str, names: Iterable[str]) -> None:
    """Raise ``InputError`` for a mode of an operation that there is none of."""
    known = dict.fromkeys(names)
    for name in (entry.rpartition(":")[0] for entry in text.split(",")):
        if name and name not in known:
            raise InputError(setting_problem("mode", Wording("ARG230", "no_operation", name=name, known=tuple(known))))


def _check_apart(moving: Sequence[tuple[Toolpath, Operation]], *, is_absolute: bool) -> None:
    """Raise ``RefusedError`` where an operation does not stand alone."""
    problems = []
    for (toolpath, operation), (_, following) in pairwise(moving):
        left = _left_on(operation)
        if left is not None:
            problems.append(
                Problem(
                    operation.file or toolpath.file,
                    left.line,
                    Wording(
                        "PRJ140",
                        "leaves_something_on",
                        operation=operation.name,
                        line=left.line,
                        following=following.name,
                    ),
                )
            )
    first = moving[0][1].frame
    for toolpath, operation in moving:
        if operation.frame != first and not is_absolute:
            problems.append(
                Problem(
                    operation.file or toolpath.file,
                    operation.line,
                    Wording("PRJ140", "other_coordinate_system", operation=operation.name, first=moving[0][1].name),
                )
            )
    if problems:
        raise RefusedError(problems)


def _left_on(operation: Operation) -> Event | None:
    """Return what goes on when an operation ends."""
    on = dict[str, Event]()
    for event in operation.events:
        match event:
            case CutterComp():
                on["compensation"] = event
                if event.side == "OFF":
                    del on["compensation"]
            case CycleOn():
                on["cycle"] = event
            case CycleOff():
                on.pop("cycle", None)
            case BlockSkip():
                on["skip"] = event
                if not event.on:
                    del on["skip"]
    return next(iter(on.values()), None)


def _with_what_is_on(moving: Sequence[tuple[Toolpath, Operation]]) -> Iterator[tuple[Toolpath, Operation]]:
    """Yield the operations with tool and spindle as the one before has left them, where they do not say them first."""
    tool: LoadTool | None = None
    spindle: SpindleOn | None = None
    for toolpath, operation in moving:
        at_start = [event for event in operation.events if event.row == 0]
        missing: list[Event] = []
        line = operation.line
        if tool is not None and not any(isinstance(event, LoadTool) for event in at_start):
            missing.append(replace(tool, row=0, line=line))
            if spindle is not None and not any(isinstance(event, SpindleOn | SpindleOff) for event in at_start):
                missing.append(replace(spindle, row=0, line=line))
        for event in operation.events:
            tool = event if isinstance(event, LoadTool) else tool
            spindle = event if isinstance(event, SpindleOn) else None if isinstance(event, SpindleOff) else spindle
        yield toolpath, replace(operation, events=(*missing, *operation.events)) if missing else operation
