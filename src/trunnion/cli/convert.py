"""``trunnion convert``: an NC program back to a toolpath, and out again as a CL file or for another machine."""

import argparse
import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.cli.post import plan_program, print_problems, prove_program, run_while_writing, write_for_proof
from trunnion.cli.settings import RUN_SETTINGS, apply_setup, check_settings, parse_plan_options, program_division
from trunnion.controls import Control, load_control
from trunnion.errors import InputError, Problem, RefusedError, Severity
from trunnion.files import atomic_output
from trunnion.machines import Machine, load_machine
from trunnion.output.capabilities import control_capabilities

if TYPE_CHECKING:
    from trunnion.conversion import Conversion

#: Warnings that are printed one by one.
_MOST_PRINTED = 20


def run(arguments: argparse.Namespace) -> int:
    """Convert one program."""
    from trunnion.cl.write import write_cl

    machine = load_machine(arguments.machine)
    control = load_control(machine.control)
    target_machine = load_machine(arguments.to_machine) if arguments.to_machine else machine
    target_control = load_control(target_machine.control) if arguments.to_machine else control
    settings = dict(arguments.settings)
    _check_settings(settings, target_control, arguments.to_cl)
    target_machine = apply_setup(target_machine, settings)
    given = {"zero": arguments.zero, "tool_length": arguments.tool_length}
    machine = apply_setup(machine, {key: value for key, value in given.items() if value})
    options = parse_plan_options(settings, target_control)
    capabilities = control_capabilities(target_control, settings)
    target = _target_file(arguments, target_control)
    with atomic_output(target) as output_files:
        division = program_division(settings, target_control, target, output_files)
        settings = {key: value for key, value in settings.items() if key not in RUN_SETTINGS}
        converted = _read_toolpath(arguments, machine, control)
        if arguments.subprograms and division is None and not arguments.to_cl:
            what = f"{1 + len(arguments.subprograms)} files become one program"
            print_problems(
                [Problem(arguments.file, 0, what, "--set programs=operations writes several", Severity.WARNING)]
            )
        carried = _carried_settings(converted.settings, control, target_control, arguments.file) | settings
        if "tool" in settings and "tool_call" not in settings:
            carried.pop("tool_call", None)
        operations = converted.toolpath.operations
        rows = sum(len(operation.moves) for operation in operations)
        if arguments.to_cl:
            comments = [f"--set {key}={value}" for key, value in carried.items()]
            _print_first(write_cl(converted.toolpath, output_files.main, comments=comments))
        else:
            paths = [converted.toolpath]
            with run_while_writing(output_files, target_machine, division) as (write_progress, run):
                program, _ = plan_program(
                    paths, target_machine, target_control, carried, arguments.force, options, capabilities
                )
                written = write_for_proof(program, output_files.main, options, write_progress, division)
            prove_program(written, run.result(), paths, output_files, target, program if arguments.force else None)
    if arguments.to_cl and carried:
        print(_post_hint(target, arguments.machine, carried), file=sys.stderr)
    if target != "-":
        print(f"{target}: {rows} points, {len(operations)} operations", file=sys.stderr)
    return 0


def _check_settings(settings: Mapping[str, str], control: Control, to_cl: bool) -> None:
    """Raise ``InputError`` for settings that ``post`` would not take, and for those without a meaning here."""
    check_settings(settings, control)
    if "units" in settings:
        raise InputError(Problem("--set", 0, "units has no meaning here", "an NC program says its units itself"))
    if "zero" in settings and to_cl:
        raise InputError(Problem("--set", 0, "zero has no meaning in a CL file", "give it to trunnion post"))


def _read_toolpath(arguments: argparse.Namespace, machine: Machine, control: Control) -> "Conversion":
    """The program as a toolpath; refuses one that was not understood."""
    from trunnion.conversion import convert
    from trunnion.conversion.program_events import COMPENSATION_FINDINGS
    from trunnion.readers import run_program

    file = arguments.file
    run = run_program(Path(file), machine, subprograms=[Path(each) for each in arguments.subprograms])
    problems = [Problem(finding.file, finding.line, finding.text, "", finding.severity) for finding in run.diagnostics]
    errors = [problem for problem in problems if problem.severity is Severity.ERROR]
    if errors and not arguments.force:
        count = f"{len(errors)} places are not understood, and nothing is written"
        raise RefusedError((*errors[:_MOST_PRINTED], Problem(file, 0, count, "--force converts what was understood")))
    _print_first([problem for problem in problems if not problem.what.startswith(COMPENSATION_FINDINGS)])
    converted = convert(run, control)
    if not converted.toolpath.operations:
        raise InputError(Problem(file, 0, "there is no motion at the part in it", "give a program that cuts"))
    _print_first(converted.warnings)
    return converted


def _carried_settings(settings: Mapping[str, str], control: Control, target: Control, file: str) -> dict[str, str]:
    """The program's settings that mean the same on the other control; the others are named."""
    from trunnion.conversion import transfer_settings

    carried = transfer_settings(settings, control, target)
    for key in sorted(settings.keys() - carried.keys()):
        what = f"{key} is {settings[key]!r}, which is not carried over"
        why = f"{target.name} has no such setting" if key not in target.settings else f"say it as {target.name} does"
        print_problems([Problem(file, 0, what, why, Severity.WARNING)])
    return carried


def _print_first(problems: Sequence[Problem]) -> None:
    print_problems(problems[:_MOST_PRINTED])
    if len(problems) > _MOST_PRINTED:
        print(f"and {len(problems) - _MOST_PRINTED} more", file=sys.stderr)


def _post_hint(target: str, machine: str, settings: Mapping[str, str]) -> str:
    """How to post the CL file such that the program's head becomes the same."""
    name = "FILE.cls" if target == "-" else target
    words = [f"--set={key}={value}" for key, value in settings.items()]
    return "to post it with the same head: " + shlex.join(["trunnion", "post", name, "--machine", machine, *words])


def _target_file(arguments: argparse.Namespace, control: Control) -> str:
    """Where the result goes: never onto the program itself."""
    source = Path(arguments.file)
    extension = ".cls" if arguments.to_cl else control.extension
    output: str = arguments.output or source.stem + extension
    if output != "-" and Path(output).is_dir():
        output = str(Path(output) / (source.stem + extension))
    if output != "-" and Path(output).exists() and source.exists() and Path(output).samefile(source):
        raise InputError(Problem(output, 0, "is the program itself", "name another --output"))
    return output
