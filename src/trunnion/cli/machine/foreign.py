"""``trunnion import``."""

import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from trunnion.builder.saved_file import is_file_name
from trunnion.cli.results import show
from trunnion.cli.wording import in_words, line
from trunnion.definitions.value_marks import marked_values
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.files import atomic_file, check_outputs
from trunnion.foreign.definition import Difference, Written, differences, nearest_machine, written_definition
from trunnion.foreign.machine import ForeignMachine, Left, because
from trunnion.foreign.machine_data import read_machine_data
from trunnion.foreign.mastercam import read_mastercam_post
from trunnion.foreign.nx_post import read_nx_post
from trunnion.jobs.job import Given
from trunnion.machines import load_machine
from trunnion.machines.loading import check_is_shipped, shipped_machines
from trunnion.messages import Wording
from trunnion.results import to_data
from trunnion.schemas import file_name, put_beside

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
        "left": _left_data(written.left),
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
        yield in_words(because("taken", key=".".join(key), value=str(value.value), source=value.source))
    for each in found.left:
        yield in_words(because("not_taken", said=each.said, where=each.where, reason=each.reason))
    counts = {"marks": marks, "left": len(found.left)}
    if base:
        yield in_words(because("written_extending", file=str(file), base=base, **counts))
    else:
        yield in_words(because("written_alone", file=str(file), **counts))
    yield line("next_check", file=shlex.quote(str(file)))


def _left_data(left: Sequence[Left]) -> list[dict[str, str]]:
    """Return what is not taken as data, which are English."""
    return [{"what": each.what, "where": each.where, "why": each.why} for each in left]


def _compared(given: Given, found: ForeignMachine) -> int:
    """Report what a definition has otherwise; the exit code says whether there is any."""
    machine = load_machine(given.machine)
    other = list(differences(found, machine))
    compared = len([key for key in found.values if key[0] != "spindle"])
    data: dict[str, Any] = {
        "schema": 1, "machine": machine.key, "compared": compared, "differences": [to_data(each) for each in other],
        "left": _left_data(found.left),
    }  # fmt: skip
    show(given, lambda: data, _differences(found, other, machine.key, compared))
    return 1 if other else 0


def _differences(found: ForeignMachine, other: list[Difference], machine: str, compared: int) -> Iterator[str]:
    for each in other:
        values = {"key": each.key, "machine": machine, "source": each.source}
        if each.here is not None:
            yield in_words(because("differs", here=str(each.here), there=str(each.there), **values))
        elif each.is_axis:
            yield in_words(because("differs_axis_missing", **values))
        else:
            yield in_words(because("differs_not_stated", there=str(each.there), **values))
    for left in found.left:
        yield in_words(because("not_compared", said=left.said, where=left.where, reason=left.reason))
    yield in_words(because("differences_in_all", count=len(other), compared=compared, left=len(found.left)))
