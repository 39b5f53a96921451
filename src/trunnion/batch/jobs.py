"""The jobs of a batch: which files, and what is done with each.

In:     a file of jobs (``jobs_file.py``) or a folder.
Out:    a ``Batch`` of ``BatchJob`` records, and its ``Unit`` records, one for each file, in order.
"""

import os
from collections.abc import Mapping, Sequence
from dataclasses import field
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import Any, Final, NamedTuple

from trunnion.batch.argument_checks import beside_fault, check_simulation, check_tiles, check_to_cl
from trunnion.batch.patterns import matches
from trunnion.batch.records import FOLDER
from trunnion.batch.result_keys import home_of
from trunnion.batch.unmatched_patterns import unmatched
from trunnion.batch.worker_task import DEFINITIONS, FILES, Action
from trunnion.controls import load_control
from trunnion.definitions.extends import is_within
from trunnion.dialect_names import WRITTEN_DIALECTS
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.convert.converting import check_conversion_settings
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import as_machine
from trunnion.jobs.post.post_job import prepare
from trunnion.jobs.project.paths import is_file
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.options.groups import BODIES
from trunnion.options.kinds import FileIn
from trunnion.records import dataclass
from trunnion.simulation.stock.solids import CL_STOCK

#: Files that a folder may have, all and those of a batch: a record of each is held while it runs.
MOST_FILES: Final = 1_000_000

#: Extensions of CL files.
CL_EXTENSIONS: Final = (".cls", ".clsf", ".cl", ".clt", ".ncl", ".apt", ".aptsource", ".cldata")

#: What the results of an action are called that writes no program.
NOTED: Final = {Action.VERIFY: ".verification", Action.SIMULATE: ".simulation"}


@dataclass(frozen=True, slots=True)
class BatchJob:
    """Files with which the same is done.

    files      names beside the jobs, in order
    arguments  of the function of the library that does it; files by their logical names
    shared     files that all of them need, by logical names
    beside     argument -> names of files that go with a single one; ``{folder}`` and ``{stem}`` stand for its own
    output     folder of the results, within those of the batch; empty: these themselves
    extension  of a result
    report     of what form: ``html``, ``json``, or empty
    tiles      tasks among which the tiles of a simulation are divided; 1: it is one task
    """

    name: str
    action: Action
    files: Sequence[str]
    arguments: Mapping[str, Any]
    shared: Mapping[str, Path] = field(default_factory=dict)
    beside: Mapping[str, Sequence[str]] = field(default_factory=dict)
    output: str = ""
    extension: str = ""
    report: str = ""
    tiles: int = 1

    @property
    def tasks(self) -> int:
        """Tasks of each file: its shares, and what joins them."""
        return self.tiles + 1 if self.tiles > 1 else 1


@dataclass(frozen=True, slots=True)
class Batch:
    """Jobs, and the folder beside which their files lie.

    results  where these go if nothing else is said
    home     tells this batch from others (``keys.home_of``)
    is_whole whether the jobs say all that is wanted: of a folder they may be but some of its files this time
    """

    folder: Path
    jobs: Sequence[BatchJob]
    results: Path | None = None
    home: str = ""
    is_whole: bool = False


class Unit(NamedTuple):
    """One file of one job, and the place of its result within the results.

    clash  the place that its result would share with that of another file: then it has none; empty: it has its own
    """

    place: str
    job: int
    file: str
    clash: str = ""


def folder_files(folder: Path, without: Path | None = None) -> list[str]:
    """Return the files in a folder and below, by their names with ``/``, in order; none of hidden folders, nor
    ``without``.

    Links to folders are not followed, and links to files elsewhere are left out.

    Raises ``InputError`` if it has too many files.
    """
    found: list[str] = []
    for at, folders, names in os.walk(folder):
        here = Path(at)
        folders[:] = [
            name for name in folders
            if not name.startswith(".") and (without is None or (here / name).resolve() != without.resolve())
            and not (here / name / FOLDER).is_dir()
        ]  # fmt: skip
        inner = PurePosixPath(here.relative_to(folder).as_posix())
        found += [(inner / name).as_posix() for name in names if _is_input(here / name, folder)]
        if len(found) > MOST_FILES:
            raise InputError(Problem(str(folder), 0, Wording("BAT120", "more_files", most_files=MOST_FILES)))
    return sorted(found)


def _is_input(path: Path, folder: Path) -> bool:
    """Whether a path is that of a file in the folder, which can be read to its end: no pipe, no link that leads out."""
    return not path.name.startswith(".") and is_file(path) and (not path.is_symlink() or is_within(path, folder))


def folder_batch(
    folder: Path, action: Action, arguments: Mapping[str, Any], results: Path | None, patterns: Sequence[str] = ()
) -> Batch:
    """Every file of a folder with which an action can be done.

    arguments  of the function of the library; the names of files are paths
    results    the folder of results, whose files are none of the inputs
    patterns   names of the files; by default those with the extensions of CL files, or of programs of the machine

    Raises ``InputError`` if an argument cannot be used, or there are no such files.
    """
    given = {name: value for name, value in arguments.items() if value and name != "tiles"}
    beside = {name: _listed(given.pop(name)) for name in ("cl", "subprograms") if given.get(name)}
    for argument, names in beside.items():
        for name in names:
            if fault := beside_fault(name):
                wording = Wording("ARG140", "no_name_beside", name=name[:100], fault=fault)
                raise InputError(argument_problem(argument, wording))
    report, tiles = str(given.pop("report", "")), check_tiles(action, arguments.get("tiles", 1))
    said, shared, extensions = judged(action, given, folder, has_cl="cl" in beside)
    sought = (extensions.read,) if extensions.read else CL_EXTENSIONS
    files = [
        name for name in folder_files(folder, results)
        if (any(matches(name, each) for each in patterns) if patterns else name.lower().endswith(sought))
    ]  # fmt: skip
    if not files:
        reasons = (unmatched(folder, each, results) for each in patterns or [f"**/*{each}" for each in sought])
        raise InputError(
            Problem(
                str(folder),
                0,
                Wording(
                    "BAT120",
                    "no_files_match",
                    patterns=tuple(patterns),
                    reasons=next((f"; {why}" for why in reasons if why), ""),
                )
                if patterns
                else Wording(
                    "BAT120", "no_files", sought=tuple(sought), reasons=next((f"; {why}" for why in reasons if why), "")
                ),
            )
        )
    job = BatchJob(str(action), action, files, said, shared, beside, "", extensions.written, report, tiles)
    return Batch(folder, [job], home=home_of(folder))


def _listed(value: Any) -> list[str]:
    return [value] if isinstance(value, str) else list(value)


class Extensions(NamedTuple):
    """Of the files that an action reads, empty for CL files, and of what it writes."""

    read: str
    written: str


def judged(
    action: Action, arguments: Mapping[str, Any], folder: Path, *, has_cl: bool = False
) -> tuple[dict[str, Any], dict[str, Path], Extensions]:
    """Judge the arguments of an action before any work.

    arguments  of the function of the library; files by their paths
    folder     beside which the files of the jobs lie
    has_cl     CL files go with each of these, and may state the stock

    dict        the arguments with logical names of files, as JSON has them
    dict        the paths of these, and of what they lead to, by logical names
    Extensions  of what is read and written

    Raises ``InputError`` with what cannot be used of them.
    """
    said, shared = dict(arguments), dict[str, Path]()
    machines: dict[str, Machine] = {}
    for name in ("machine", "to_machine"):
        if value := said.get(name):
            machines[name] = _loaded(str(value), name)
            said[name] = _add_machine(str(value), machines[name], folder, shared)
    if action is not Action.CONVERT and "machine" not in machines:
        raise InputError(argument_problem("machine", Wording("ARG130", "missing_machine_of_programs")))
    if action is Action.SIMULATE:
        if has_cl:
            said.setdefault("stock", CL_STOCK)
        if not said.get("stock"):
            raise InputError(argument_problem("stock", Wording("ARG130", "missing_stock")))
        check_simulation(said)
    for name in (each.name for each in BODIES if isinstance(each.kind, FileIn)):
        if value := said.get(name):
            several = [_add_file(each, folder, shared) for each in ([value] if isinstance(value, str) else value)]
            said[name] = several[0] if isinstance(value, str) else several
    return said, shared, _extensions(action, said, machines)


def _loaded(name: str, argument: str) -> Machine:
    return as_machine(name, argument) if name.endswith(".toml") else shipped_machine(name)


@lru_cache(maxsize=16)
def shipped_machine(name: str) -> Machine:
    """Return a machine that is shipped, or an ``InputError`` that there is none: many jobs name the same one."""
    return as_machine(name)


def _extensions(action: Action, said: Mapping[str, Any], machines: Mapping[str, Machine]) -> Extensions:
    if action is Action.POST:
        job = prepare(machines["machine"], said.get("settings"))
        return Extensions("", job.control.extension)
    machine = machines.get("machine")
    read = load_control(machine.control).extension if machine is not None else ""
    if action in NOTED:
        return Extensions(read, "")
    if bool(said.get("to_machine")) is bool(said.get("to_cl")):
        raise InputError(argument_problem("to_machine", Wording("CNV110", "cl_say_where")))
    if said.get("to_cl"):
        check_to_cl(said, machine)
        return Extensions(read, WRITTEN_DIALECTS[said.get("to_dialect", "clsf")])
    if machine is None:
        raise InputError(argument_problem("machine", Wording("CNV110", "missing")))
    job = prepare(machines["to_machine"], said.get("settings"))
    check_conversion_settings(job, to_cl=False)
    return Extensions(read, job.control.extension)


def _add_machine(name: str, machine: Machine, folder: Path, shared: dict[str, Path]) -> str:
    """Note the files of a machine that are not shipped; returns its logical name."""
    if not name.endswith(".toml"):
        return name
    path = Path(name)
    own = [Path(each) for each in machine_files(name, machine)]
    root = folder if is_within(path, folder) else path.parent
    prefix = FILES if root is folder else DEFINITIONS
    for each in (path, *own):
        if is_within(each, root):
            shared[_logical(each, root, prefix)] = each
    return _logical(path, root, prefix)


def _add_file(name: Any, folder: Path, shared: dict[str, Path]) -> Any:
    """Note a file that is named; a text that names none, such as ``box:10,10,10``, stays what it is."""
    if not isinstance(name, str | os.PathLike) or not Path(name).is_file():
        return name
    path = Path(name)
    inside = is_within(path, folder)
    logical = _logical(path, folder, FILES) if inside else f"{DEFINITIONS}{path.name}"
    shared[logical] = path
    return logical


def _logical(path: Path, root: Path, prefix: str) -> str:
    """Return the name of a file below a folder: as it is written there, or behind links where it is not."""
    try:
        return prefix + path.absolute().relative_to(root.absolute()).as_posix()
    except ValueError:
        return prefix + path.resolve().relative_to(root.resolve()).as_posix()
