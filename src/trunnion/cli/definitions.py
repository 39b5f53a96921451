"""``trunnion machines`` and ``trunnion check``."""

import argparse
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path, PurePath

from trunnion.cli.controls import control_lines
from trunnion.cli.machine_list import machine_list
from trunnion.cli.machine_text import machine_data, machine_lines
from trunnion.cli.results import as_json, print_result
from trunnion.controls import load_control
from trunnion.controls.definition_files import is_control_file, load_control_table
from trunnion.controls.loading import shipped_controls, with_control
from trunnion.definitions import load_table
from trunnion.definitions.messages import did_you_mean
from trunnion.definitions.resolved import resolved_text
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.describe.controls import describe_control
from trunnion.jobs.describe.definition_checks import all_problems, machine_problems, stand_in
from trunnion.jobs.describe.machines import describe_machine
from trunnion.jobs.inputs.cl_statements import check_statements
from trunnion.machines import load_machine, shipped_machines
from trunnion.machines.loading import machine_library
from trunnion.readers import check_reading
from trunnion.schemas import first_line


def machines(arguments: argparse.Namespace) -> int:
    """List the shipped machines, or print one definition as its file has it, or with all that it extends."""
    if arguments.resolved and not arguments.name:
        raise InputError(argument_problem("resolved", "wants a machine", "name one, or the file of one", code="ARG130"))
    if arguments.resolved:
        load_machine(arguments.name)
        table = load_table(arguments.name, machine_library(), kind="machine")
        print_result(resolved_text(with_control(table)), end="")
        return 0
    if arguments.name:
        load_machine(arguments.name)
        folder = machine_library()
        shipped_file = folder.joinpath(f"{arguments.name}.toml")
        source = shipped_file if shipped_file.is_file() else Path(arguments.name)
        text = source.read_text(encoding="utf-8")
        if source is shipped_file:  # the schema of what is saved of it lies beside that
            text = first_line("machine") + text.partition("\n")[2]
        print_result(text, end="")
        return 0
    print_result(*machine_list([load_machine(key) for key in shipped_machines()]))
    return 0


def check(arguments: argparse.Namespace) -> int:
    """Validate the definition of a machine with its control, or of a control, and show what it means.

    Every mistake comes at once.
    """
    if arguments.file in shipped_controls() or is_control_file(Path(arguments.file)):
        _check_control_file(arguments.file)
        control = describe_control(arguments.file)
        good = f"{arguments.file}: good"
        print_result(*([as_json(asdict(control))] if arguments.json else [good, "", *control_lines(control)]))
        return 0
    _check_is_known(arguments.file)
    key = PurePath(arguments.file).name.removesuffix(".toml")
    _raise(machine_problems(load_table(arguments.file, machine_library(), kind="machine"), key))
    found = describe_machine(arguments.file)
    good = f"{arguments.file}: good"
    print_result(*([as_json(machine_data(found))] if arguments.json else [good, "", *machine_lines(found)]))
    return 0


def _raise(problems: Sequence[Problem]) -> None:
    if problems:
        raise InputError(problems)


def _check_control_file(file: str) -> None:
    """Raise every mistake of a control's own file, the words that it declares for readers among them."""
    table = load_control_table(file)
    machine = stand_in(file, table)
    checks = (lambda: load_control(table), lambda: check_reading(machine), lambda: check_statements(machine))
    _raise(all_problems(checks))


def _check_is_known(name: str) -> None:
    """Raise ``InputError`` for a name that is neither a file's nor that of a shipped definition."""
    known = [*shipped_machines(), *shipped_controls()]
    if name in known or name.endswith(".toml") or Path(name).exists():
        return
    near = did_you_mean(name, known)
    cure = f"{near} " if near else ""
    cure += f"write the path of a .toml file, or one of {', '.join(known)}"
    raise InputError(Problem(name, 0, "there is no shipped machine or control of this name", cure, code="DEF110"))
