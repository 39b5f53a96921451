"""``trunnion machines`` and ``trunnion check``."""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path

from trunnion.api.cl_statements import check_statements
from trunnion.api.describing import describe_control
from trunnion.api.describing_machine import describe_machine
from trunnion.cli.controls import control_lines
from trunnion.cli.machine_text import machine_data, machine_lines
from trunnion.cli.results import as_json, print_result
from trunnion.controls import load_control
from trunnion.controls.definition_files import is_control_file, load_control_table
from trunnion.controls.loading import shipped_controls
from trunnion.definitions import Table, load_table
from trunnion.definitions.messages import did_you_mean
from trunnion.errors import InputError, Problem
from trunnion.machines import Machine, load_machine, shipped_machines
from trunnion.machines.loading import machine_library
from trunnion.readers import check_reading


def machines(arguments: argparse.Namespace) -> int:
    """List the shipped machines, or print one definition as its file has it."""
    if arguments.name:
        load_machine(arguments.name)
        folder = machine_library()
        shipped_file = folder.joinpath(f"{arguments.name}.toml")
        source = shipped_file if shipped_file.is_file() else Path(arguments.name)
        print_result(source.read_text(encoding="utf-8"), end="")
        return 0
    found = [load_machine(key) for key in shipped_machines()]
    width = max(len(machine.key) for machine in found)
    print_result(*(f"{machine.key:<{width}}  {machine.name}" for machine in found))
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
    _raise_all(arguments.file, (load_machine, _load_control, _check_reading, _check_statements))
    found = describe_machine(arguments.file)
    good = f"{arguments.file}: good"
    print_result(*([as_json(machine_data(found))] if arguments.json else [good, "", *machine_lines(found)]))
    return 0


def _raise_all(file: str, loaders: Sequence[Callable[[str], object]]) -> None:
    """Raise the problems of all loaders together."""
    problems: list[Problem] = []
    for load in loaders:
        try:
            load(file)
        except InputError as error:
            problems += [problem for problem in error.problems if problem not in problems]
    if problems:
        raise InputError(sorted(problems, key=lambda problem: (problem.file, problem.line)))


def _check_control_file(file: str) -> None:
    """Raise every mistake of a control's own file, the words that it declares for readers among them."""
    table = load_control_table(file)
    machine = _any_machine(file, table)
    _raise_all(
        file,
        (lambda _: load_control(table), lambda _: check_reading(machine), lambda _: check_statements(machine)),
    )


def _check_is_known(name: str) -> None:
    """Raise ``InputError`` for a name that is neither a file's nor that of a shipped definition."""
    known = [*shipped_machines(), *shipped_controls()]
    if name in known or name.endswith(".toml") or Path(name).exists():
        return
    near = did_you_mean(name, known)
    cure = f"{near} " if near else ""
    cure += f"write the path of a .toml file, or one of {', '.join(known)}"
    raise InputError(Problem(name, 0, "there is no shipped machine or control of this name", cure))


def _any_machine(file: str, control: Table) -> Machine:
    """A machine with a control: what a definition says to readers can be judged although its axes are wrong."""
    return replace(load_machine(shipped_machines()[0]), key=file, name=file, control=control, files=())


def _check_reading(file: str) -> None:
    """Check what a definition says to the readers of programs."""
    check_reading(_any_machine(file, _control_table(file)))


def _check_statements(file: str) -> None:
    """Check what a definition says of CL statements; words of a shop only once its machine can be loaded."""
    check_statements(_any_machine(file, _control_table(file)))
    check_statements(load_machine(file))


def _control_table(file: str) -> Table:
    return load_table(file, machine_library(), kind="machine").table("control")


def _load_control(file: str) -> None:
    """Read the control's part of a definition, unless it only names a family."""
    table = _control_table(file)
    if table.keys() not in ([], ["family"]):
        load_control(table)
