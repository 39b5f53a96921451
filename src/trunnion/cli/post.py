"""``trunnion post``: CL files in, one proven NC program out (or one each, into a folder)."""

import argparse
import os
import sys
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from trunnion.api.post_result import PostResult
from trunnion.api.posting import post as post_program
from trunnion.api.reading import load_machine
from trunnion.cli.terminal import Terminal, output_place
from trunnion.controls import load_control
from trunnion.errors import InputError, Problem
from trunnion.machines import Machine
from trunnion.model.toolpath import Toolpath
from trunnion.wording import counted


def post(arguments: argparse.Namespace, toolpaths: Iterator[Toolpath]) -> int:
    """Post every CL file; their toolpaths come one after the other."""
    machine = load_machine(arguments.machine)
    targets = _files_by_target(arguments, machine)
    if arguments.report and len(targets) > 1:
        what = f"one report for {len(targets)} programs"
        raise InputError(Problem(arguments.report, 0, what, "post them one at a time, or leave --report out"))
    for target, files in targets.items():
        result = post_program(
            islice(toolpaths, len(files)),
            machine=machine,
            output=output_place(target),
            settings=dict(arguments.settings),
            strict=arguments.strict,
            force=arguments.force,
            explain=arguments.explain,
            report=arguments.report,
            columns=False,
            subprograms=arguments.subprograms,
            observer=Terminal(explain=arguments.explain, recorded=arguments.explain or bool(arguments.report)),
        )
        _print_summary(target, result)
    return 0


def _print_summary(target: str, result: PostResult) -> None:
    """Name the files of a program."""
    if result.output is None:
        return
    rows = sum(len(motion.operation.moves) for motion in result.motions)
    operations = sum(motion.starts_operation for motion in result.motions)
    print(f"{target}: {counted(rows, 'point')}, {counted(operations, 'operation')}", file=sys.stderr)
    for subprogram in result.subprograms:
        print(f"{subprogram}: a subprogram of {result.output.name}", file=sys.stderr)


def _files_by_target(arguments: argparse.Namespace, machine: Machine) -> dict[str, list[str]]:
    """Which program is made from which CL files."""
    place = arguments.output
    if place == "-":
        return {"-": arguments.files}
    folder = place is not None and (Path(place).is_dir() or place.endswith(("/", os.sep)))
    if place is not None and not folder:
        return {place: arguments.files}
    if place is None and len(arguments.files) > 1:
        raise InputError(Problem("post", 0, "several CL files, and no output named", "write --output FILE or FOLDER"))
    into = Path(place or ".")
    if not into.is_dir():
        raise InputError(Problem(str(into), 0, "is not a folder", "make it first"))
    extension = load_control(machine.control).extension
    targets: dict[str, list[str]] = {}
    for file in arguments.files:
        targets.setdefault(str(into / (Path(file).stem + extension)), []).append(file)
    twice = next((files for files in targets.values() if len(files) > 1), None)
    if twice:
        raise InputError(Problem(twice[1], 0, f"would write over the program of {twice[0]}", "rename one of them"))
    return targets
