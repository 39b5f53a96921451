"""``trunnion convert``: an NC program back to a toolpath, and out again as a CL file or for another machine."""

import argparse
import shlex
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from trunnion.cl.write import write_cl
from trunnion.cli.output import whole
from trunnion.cli.post import _check_settings, _point, _program, _wishes
from trunnion.cli.progress import progress
from trunnion.control import Control, load_control, write_program
from trunnion.convert import Converted, convert
from trunnion.convert.timeline import COMPENSATION
from trunnion.errors import InputError, Problem, Refused, Severity
from trunnion.machine import Machine, load_machine
from trunnion.reader import run_program

#: Warnings that are printed one by one.
_PRINTED = 20


def run(arguments: argparse.Namespace) -> int:
    """Convert one program."""
    machine = load_machine(arguments.machine)
    control = load_control(machine.control)
    target_machine = load_machine(arguments.to_machine) if arguments.to_machine else machine
    target_control = load_control(target_machine.control) if arguments.to_machine else control
    settings = dict(arguments.settings)
    _check_settings(settings, target_control)
    if "units" in settings:
        raise InputError(Problem("--set", 0, "units has no meaning here", "an NC program says its units itself"))
    if "zero" in settings:
        target_machine = replace(target_machine, workpiece_zero=_point(settings.pop("zero")))
    wishes = _wishes(settings, explain=False)
    settings = {key: value for key, value in settings.items() if key not in ("rewind", "clearance")}
    target = _target(arguments, target_control)
    with whole(target) as sink:
        converted = _read(arguments.file, machine, control, arguments.force)
        carried = {k: v for k, v in converted.settings.items() if k in target_control.settings} | settings
        operations = converted.toolpath.operations
        rows = sum(len(operation.moves) for operation in operations)
        if arguments.to_cl:
            remarks = write_cl(
                converted.toolpath, sink, comments=[f"--set {key}={value}" for key, value in carried.items()]
            )
            _say(remarks)
        else:
            program = _program([converted.toolpath], target_machine, target_control, carried, arguments.force, wishes)
            with progress("writing", rows, "points") as advance:
                write_program(program, sink, advance)
    if arguments.to_cl and carried:
        print(_hint(target, arguments.machine, carried), file=sys.stderr)
    if target != "-":
        print(f"{target}: {rows} points, {len(operations)} operations", file=sys.stderr)
    return 0


def _read(file: str, machine: Machine, control: Control, force: bool) -> Converted:
    """The program as a toolpath; refuses one that was not understood."""
    run = run_program(Path(file), machine)
    problems = [Problem(finding.file, finding.line, finding.text, "", finding.severity) for finding in run.findings]
    errors = [problem for problem in problems if problem.severity is Severity.ERROR]
    if errors and not force:
        raise Refused((*errors, Problem(file, 0, "nothing is written", "--force converts what was understood")))
    _say([problem for problem in problems if not problem.what.startswith(COMPENSATION)])
    converted = convert(run, control)
    if not converted.toolpath.operations:
        raise InputError(Problem(file, 0, "there is no motion at the part in it", "give a program that cuts"))
    _say(converted.remarks)
    return converted


def _say(problems: Sequence[Problem]) -> None:
    for problem in problems[:_PRINTED]:
        print(problem, file=sys.stderr)
    if len(problems) > _PRINTED:
        print(f"and {len(problems) - _PRINTED} more", file=sys.stderr)


def _hint(target: str, machine: str, settings: Mapping[str, str]) -> str:
    """How to post the CL file such that the program's head becomes the same."""
    name = "FILE.cls" if target == "-" else target
    words = [f"--set={key}={value}" for key, value in settings.items()]
    return "to post it with the same head: " + shlex.join(["trunnion", "post", name, "--machine", machine, *words])


def _target(arguments: argparse.Namespace, control: Control) -> str:
    """Where the result goes: never onto the program itself."""
    source = Path(arguments.file)
    extension = ".cls" if arguments.to_cl else control.extension
    output: str = arguments.output or source.stem + extension
    if output != "-" and Path(output).is_dir():
        output = str(Path(output) / (source.stem + extension))
    if output != "-" and Path(output).exists() and source.exists() and Path(output).samefile(source):
        raise InputError(Problem(output, 0, "is the program itself", "name another --output"))
    return output
