"""``trunnion machines`` and ``trunnion check``."""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path

from trunnion.api.describing import describe_control
from trunnion.api.describing_machine import describe_machine
from trunnion.cli.controls import control_lines
from trunnion.cli.machine_text import machine_data, machine_lines
from trunnion.cli.results import as_json, print_result
from trunnion.controls import load_control
from trunnion.controls.definition_files import is_control_file, load_control_table
from trunnion.controls.loading import shipped_controls
from trunnion.definitions import load_table
from trunnion.errors import InputError, Problem
from trunnion.machines import load_machine, shipped_machines
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
    _raise_all(arguments.file, (load_machine, _load_control, _check_reading))
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
        raise InputError(problems)


def _check_control_file(file: str) -> None:
    """Raise every mistake of a control's own file, the words that it declares for readers among them."""
    table = load_control_table(file)
    machine = replace(load_machine(shipped_machines()[0]), key=file, name=file, control=table)
    _raise_all(file, (lambda _: load_control(table), lambda _: check_reading(machine)))


def _check_reading(file: str) -> None:
    """Judge what a definition says to the reader of its programs."""
    check_reading(load_machine(file))


def _load_control(file: str) -> None:
    """Read the control's part of a definition, unless it only names a family."""
    table = load_table(file, machine_library(), kind="machine").table("control")
    if table.keys() not in ([], ["family"]):
        load_control(table)
