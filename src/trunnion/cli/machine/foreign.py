"""``trunnion import``."""

import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from trunnion.builder.saved_file import is_file_name
from trunnion.cli.results import show
from trunnion.definitions.value_marks import marked_values
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.files import atomic_file, check_outputs
from trunnion.foreign.definition import Difference, Written, differences, nearest_machine, written_definition
from trunnion.foreign.machine import ForeignMachine
from trunnion.foreign.machine_data import read_machine_data
from trunnion.foreign.mastercam import read_mastercam_post
from trunnion.foreign.nx_post import read_nx_post
from trunnion.jobs.job import Given
from trunnion.machines import load_machine
from trunnion.machines.loading import check_is_shipped, shipped_machines
from trunnion.messages import Wording
from trunnion.results import to_data
from trunnion.schemas import file_name, put_beside
from trunnion.wording import counted

#: Endings of the files of a post of NX Post Builder, of Mastercam, and of posts that are not read.
_NX = (".tcl", ".def", ".pui")
_MASTERCAM = (".pst", ".psb")
_NOT_READ = (".cps", ".mcam-mmd", ".mcam-control")


def run(given: Given) -> int:
    """Write a definition of what files of others say of a machine; or list what a definition has otherwise."""
    found = _read([Path(name) for name in given.files])
    if given.machine is not None:
        return _compared(given, found)
    base = given.like or nearest_machine(found)
    if base:
        check_is_shipped(base)
    file = Path(given.output if given.output.endswith(".toml") else f"{given.output}.toml")
    if not is_file_name(file.name):
        raise InputError(Problem(given.output, 0, Wording("FIL340", "not_on_every_system")))
    if file.stem in shipped_machines():
        raise InputError(Problem(given.output, 0, Wording("FIL340", "name_of_shipped_machine", stem=file.stem)))
    if file.exists() or file.is_symlink():
        raise InputError(Problem(str(file), 0, Wording("FIL250", "definition_exists")))
    streams = [] if given.json in (None, "-") else [given.json]
    check_outputs([file, file.with_name(file_name("machine")), *streams], list(given.files))
    written = written_definition(found, base, file.stem)
    with atomic_file(file) as sink:
        sink.write(written.text.encode())
    put_beside(file, "machine")
    marks = len(marked_values(written.text))
    data = {
        "schema": 1, "file": str(file), "extends": base, "numbers_to_measure": marks,
        "taken": [{"key": ".".join(key), "value": value.value, "source": value.source}
                  for key, value in written.taken.items()],
        "left": [to_data(each) for each in written.left],
    }  # fmt: skip
    show(given, lambda: data, _lines(written, file, base, marks))
    return 0


def _read(files: list[Path]) -> ForeignMachine:
    """Return the machine that files describe, by their endings: those of a post, or one of machine data."""
    endings = {file.suffix.lower() for file in files}
    if endings <= set(_NX):
        return read_nx_post(files)
    if endings <= set(_MASTERCAM):
        return read_mastercam_post(files)
    if endings & {*_NX, *_MASTERCAM, *_NOT_READ} or len(files) > 1:
        raise InputError(argument_problem("files", Wording("DEF650", "unknown_files", names=tuple(map(str, files)))))
    return read_machine_data(files[0])


def _lines(found: Written, file: Path, base: str, marks: int) -> Iterator[str]:
    for key, value in found.taken.items():
        yield f"taken: {'.'.join(key)} = {value.value}  ({value.source})"
    for each in found.left:
        yield f"not taken: {each.what}  ({each.where}): {each.why}"
    left = counted(len(found.left), "value")
    kind = f"extends {base}" if base else "a definition of its own"
    yield f"{file}: {kind}, {counted(marks, 'number')} to measure, {left} not taken"
    yield f"next: trunnion check {shlex.quote(str(file))}"


def _compared(given: Given, found: ForeignMachine) -> int:
    """Report what a definition has otherwise; the exit code says whether there is any."""
    machine = load_machine(given.machine)
    other = list(differences(found, machine))
    compared = len([key for key in found.values if key[0] != "spindle"])
    data: dict[str, Any] = {
        "schema": 1, "machine": machine.key, "compared": compared, "differences": [to_data(each) for each in other],
        "left": [to_data(each) for each in found.left],
    }  # fmt: skip
    show(given, lambda: data, _differences(found, other, machine.key, compared))
    return 1 if other else 0


def _differences(found: ForeignMachine, other: list[Difference], machine: str, compared: int) -> Iterator[str]:
    for each in other:
        here = "not stated" if each.here is None else each.here
        yield f"{each.key}: {here} in {machine}, {each.there} there  ({each.source})"
    for left in found.left:
        yield f"not compared: {left.what}  ({left.where}): {left.why}"
    yield f"{counted(len(other), 'difference')} in {counted(compared, 'value')}; {len(found.left)} not compared"
