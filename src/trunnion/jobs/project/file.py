"""Project files: set-ups of a part that are written once, as a TOML file, for posts and simulations.

In:     the file. Its keys stand at its top, or all of them in a table ``[simulation]``.
Out:    a ``Project``, whose ``SimulationInput`` is what the arguments of ``trunnion.simulate`` would give.
Units:  mm, degrees.

A project may come from anyone: it names files beside or below its own only. Nothing of it is run but the hooks that it
names, and these by a post alone.
"""

import os
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from importlib.resources import files
from itertools import chain
from pathlib import Path
from typing import Any, Final, TypeGuard

from trunnion.definitions import Table, load_table
from trunnion.definitions.extends import MAX_FILE_BYTES
from trunnion.errors import InputError, Problem, unusable_file
from trunnion.jobs.inputs.bodies import listed
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import FilePath, as_machine
from trunnion.jobs.inputs.settings import work_offset_setting
from trunnion.jobs.inputs.simulation_input import SetupInput, SimulationInput, with_place
from trunnion.jobs.project.paths import ProjectPaths, is_file
from trunnion.jobs.project.project import Division, Judgement, PostedSetup, Project, ProjectChecks
from trunnion.jobs.project.settings import read_settings
from trunnion.jobs.result_output import NO_PAPERS, PAPERS, PaperFiles, paper_files
from trunnion.machines import shipped_machines
from trunnion.messages import Wording
from trunnion.model.toolpath import Toolpath
from trunnion.simulation.stock.solids import is_mesh, stock_shape
from trunnion.simulation.stock.turning import Pose
from trunnion.simulation.tools.library.toml_library import library_table
from trunnion.simulation.tools.text import parse_tool

#: A line that begins the table of a simulation: no control has one like it.
_HEADER: Final = re.compile(rb"^[ \t]*\[{1,2}[ \t]*[\"']?simulation[\"']?[ \t]*[\].]", re.MULTILINE)

#: Set-ups that a project may have.
_MOST_SETUPS: Final = 100

#: Keys of which a project has at least one, as no other definition does.
_KEYS_OF_PROJECTS: Final = ("setup", "programs", "cl", "output", "stock")

#: What a set-up has besides the arguments of its simulation.
_OF_POST: Final = ("division", "settings", "setting_places", "posted")

#: What belongs to one program, and stands in the set-ups where there are any.
_OF_ONE_PROGRAM: Final = ("programs", "output", "released", *PAPERS)

#: Argument of ``simulate`` -> the key that states it.
_KEYS: Final = {
    "nc": "programs", "subprograms": "subprograms", "machine": "machine", "part": "part", "fixtures": "fixtures",
    "work_offset": "work_offset", "tools": "tools", "libraries": "tool_libraries", "unit": "unit", "cl": "cl",
    "zero": "zero_mm", "tool_length": "tool_length_mm", "until": "until", "stock": "stock", "cell": "cell_mm",
    "accuracy": "accuracy_mm", "near": "near_mm", "stop_at": "stop_at", "turn": "turn_deg", "tilt": "tilt_deg",
}  # fmt: skip


def is_project(path: Path) -> bool:
    """Whether a file is a project, by its content; one that ends in ``.toml`` is none of anything else."""
    if path.suffix == ".toml":
        return True
    try:
        if not path.is_file():
            return False
        with path.open("rb") as stream:
            return _HEADER.search(stream.read(MAX_FILE_BYTES)) is not None
    except (OSError, ValueError):
        return False


def project_files(given: Iterable[FilePath], elsewhere: Collection[str] = ()) -> list[FilePath]:
    """All files that the projects among some files name, none of which may be written over; the rest as for
    ``read_project``.

    Raises
    ------
    InputError
        If a project cannot be read.
    """
    projects = [
        _read(Path(each), ("machine", "stock", *elsewhere), is_posted=False) for each in given if is_project(Path(each))
    ]
    outputs = [str(setup.output) for each in projects for setup in each.setups]
    return [*outputs, *(name for each in projects for name in project_inputs(each))]


def project_inputs(project: Project) -> list[FilePath]:
    """All files that a project leads to and that are read, but for programs that it posts itself: those that it
    extends, those that it names, and what its machines and tool libraries lead to.

    Raises
    ------
    InputError
        If a machine or a library cannot be read.
    """
    setups = [
        replace(each, programs=() if posted else each.programs)
        for each, posted in zip(project.simulation.setups, project.posted, strict=True)
    ]
    released = [name for each in project.setups for name in each.released]
    named = [*project.files, *(name for each in setups for name in _named_files(each))]
    named += library_files(dict.fromkeys(file for each in setups for file in each.libraries if _is_path(file)))
    for machine in dict.fromkeys(each.machine for each in setups if each.machine):
        named += machine_files(machine, as_machine(machine))
    stock = project.simulation.stock
    named += [stock] if isinstance(stock, str) and stock and is_mesh(stock) else []
    return [*named, *released, *project.hooks]


def library_files(libraries: Iterable[FilePath]) -> list[FilePath]:
    """Return the files of tool libraries, with all that those in TOML extend.

    Raises
    ------
    InputError
        If one in TOML cannot be read.
    """
    named = list(libraries)
    extended = (library_table(Path(each)).files() for each in named if str(each).lower().endswith(".toml"))
    return [*named, *chain.from_iterable(extended)]


def simulated_files(project: Project, number: int) -> list[FilePath]:
    """Return the files that the simulation of a set-up reads, with those of all before it, whose stock it takes."""
    several = zip(project.simulation.setups[: number + 1], project.posted, strict=False)
    setups = [replace(each, programs=() if posted else each.programs) for each, posted in several]
    return [str(project.simulation.stock), *(name for each in setups for name in _named_files(each))]


def _named_files(setup: SetupInput) -> Iterator[FilePath]:
    several: tuple[Iterable[object], ...] = setup.programs, setup.subprograms, setup.fixtures, setup.libraries
    for names in (*several, listed("cl", setup.cl, Toolpath), (setup.part or None,)):
        yield from (name for name in names if _is_path(name))


def _is_path(name: object) -> TypeGuard[FilePath]:
    return isinstance(name, str | os.PathLike)


def read_project(path: Path, elsewhere: Collection[str] = ()) -> SimulationInput:
    """Read a project to be simulated; it may leave out the arguments that are given ``elsewhere``.

    Raises
    ------
    InputError
        If it cannot be read, with every mistake in it and its line; or if programs that it posts are not there.
    """
    return _read(path, elsewhere, is_posted=False).simulation


def load_project(path: Path) -> Project:
    """Read a project to be posted: the programs need not be there yet, and a stock only where it is simulated.

    Raises
    ------
    InputError
        If it cannot be read, or posts nothing; with every mistake in it and its line.
    """
    return _read(path, (), is_posted=True)


def _read(path: Path, elsewhere: Collection[str], *, is_posted: bool) -> Project:
    if path.suffix != ".toml":
        raise InputError(Problem(str(path), 0, Wording("SIM112", "project_of_other_ending")))
    if unusable := unusable_file(path, "a project"):
        raise InputError(unusable)
    return read_project_table(
        load_table(path, files(__package__), kind="project"), path, elsewhere, is_posted=is_posted
    )


def read_project_table(root: Table, path: Path, elsewhere: Collection[str] = (), *, is_posted: bool = True) -> Project:
    """Read the table of a project that stands, or would stand, in the file ``path``; errors as ``load_project``."""
    if "simulation" not in root and not any(key in root for key in _KEYS_OF_PROJECTS):
        raise InputError(Problem(str(path), 0, Wording("SIM112", "no_project", keys=_KEYS_OF_PROJECTS)))
    found = _Reader(path, elsewhere, is_posted).project(root)
    root.report_unread_keys()
    root.raise_problems()
    return found


class _Reader:
    """Reads the tables of a project; mistakes become problems of the tables."""

    def __init__(self, path: Path, elsewhere: Collection[str], is_posted: bool) -> None:
        self._path, self._paths = path, ProjectPaths(path.parent)
        self._elsewhere, self._is_posted = elsewhere, is_posted

    def project(self, root: Table) -> Project:
        """All of it; its keys stand at the top, or in one table."""
        table = root.table("simulation") if "simulation" in root else root
        checks = self._checks(table.table("checks"))
        hooks = self._paths.files(table, "hooks")
        strict = table.flag("strict", False)
        stock = self._stock(table, is_needed=not self._is_posted or checks.simulate is not Judgement.OFF)
        told, own = len(table.problems), table.tables("setup")
        if "setup" in table and not own and len(table.problems) == told:
            cure = f"write tables [[{table.key_path('setup')}]], or leave it out"
            table.add_problem("setup", "is []", cure)
        if len(own) > _MOST_SETUPS:
            table.add_problem("setup", f"has {len(own)} tables", f"write at most {_MOST_SETUPS}")
            own = []
        if own:
            for key in (key for key in _OF_ONE_PROGRAM if key in table):
                table.add_problem(key, "stands beside set-ups", f"write it in each [[{table.key_path('setup')}]]")
            table.mark_read(*_OF_ONE_PROGRAM)
        shared = self._setup(table, None, is_alone=not own)
        setups = [self._setup(each, shared) for each in own] if own else [shared]
        names = [setup["name"] for setup in setups]
        for k, (each, name) in enumerate(zip(own, names, strict=False)):
            if name in names[:k]:
                each.add_problem("name", f'is "{name}" twice', "tell set-ups apart")
        if own and "pose" in own[0]:
            own[0].add_problem("pose", "of the first set-up", "state the stock in the coordinates of this set-up")
        found: dict[str, Any] = {
            "cell": table.number("cell_mm", None, above=0.0),
            "accuracy": table.number("accuracy_mm", None, above=0.0),
            "near": table.number("near_mm", None, above=0.0),
            "stop_at": table.text("stop_at", None, one_of=("none", "first")),
        }
        until = table.integer("until", None, at_least=0)
        setups[-1]["until"] = until
        if until is not None and self._is_posted and checks.simulate is not Judgement.OFF:
            table.add_problem("until", "ends the simulation early, and whole programs are posted", "leave it out")
        posted = tuple(setup["posted"] for setup in setups)
        simulated = [SetupInput(**{key: setup[key] for key in setup if key not in _OF_POST}) for setup in setups]
        if self._is_posted and not any(posted) and not table.problems:
            table.add_problem("", "posts nothing: no set-up has an output", 'write output = "NAME.mpf" beside its cl')
        table.report_unread_keys()
        simulation = SimulationInput(stock=stock, setups=simulated, places=_places(table), **found)
        return Project(self._path, simulation, posted, checks, hooks, strict, files=tuple(root.files()))

    def _checks(self, table: Table) -> ProjectChecks:
        """Return what is judged after the posts."""
        words = tuple(Judgement)
        found = ProjectChecks(
            Judgement(table.text("simulate", Judgement.OFF, one_of=words)),
            Judgement(table.text("released", Judgement.WARN, one_of=words)),
            table.number("longest_s", None, above=0.0),
        )
        table.report_unread_keys()
        return found

    def _stock(self, table: Table, *, is_needed: bool) -> str:
        is_needed = is_needed and "stock" not in self._elsewhere
        stock = table.text("stock") if is_needed else table.text("stock", "")
        if "stock" in table and stock == "" and not table.problems:
            table.add_problem("stock", 'is ""', "state a box, a cylinder or a mesh")
        elif stock and is_mesh(stock):
            stock = self._paths.file(table, "stock", stock)
        elif stock and "stock" not in self._elsewhere:
            _try(table, stock_shape, stock)
        return stock

    def _setup(self, table: Table, shared: dict[str, Any] | None, *, is_alone: bool = False) -> dict[str, Any]:
        """Return what a set-up states; ``shared`` is what stands for all of them, None where this is it, maybe
        alone.
        """
        found: dict[str, Any] = {} if shared is None else dict(shared)
        stated = set(table.keys())
        found["name"] = "" if shared is None else table.text("name", f"set-up {_number(table)}")
        for argument, key in (("subprograms",) * 2, ("fixtures",) * 2, ("cl",) * 2, ("libraries", "tool_libraries")):
            if shared is None or key in stated:
                found[argument] = self._paths.files(table, key)
        if shared is None or "machine" in stated:
            found["machine"] = self._machine(table, required=is_alone and "machine" not in self._elsewhere)
        if "part" in stated:
            found["part"] = self._paths.file(table, "part", table.text("part"))
        elif shared is not None and _number(table) > 1:
            found["part"] = None  # it is where the last set-up's part lies now
        if shared is None or "tools" in stated:
            found["tools"] = table.texts("tools", ())
            # Libraries may have diameters that the texts leave out.
            if not found.get("libraries") and not {"tools", "libraries"} & set(self._elsewhere):
                for tool in found["tools"]:
                    _try(table, parse_tool, tool)
        if shared is None or "unit" in stated:
            found["unit"] = table.text("unit", None, one_of=("mm", "inch"))
        if shared is None or "work_offset" in stated:
            found["work_offset"] = table.text("work_offset", None, example="G54")
            if found["work_offset"] is not None and found["machine"] and "machine" not in self._elsewhere:
                _try(table, lambda: work_offset_setting(found["work_offset"], as_machine(found["machine"])))
        if shared is None or "zero_mm" in stated:
            found["zero"] = table.vector("zero_mm", 3, None)
        if shared is None or "tool_length_mm" in stated:
            found["tool_length"] = table.number("tool_length_mm", None, above=0.0)
        for name, most in (("turn", 360.0), ("tilt", 90.0)):
            if shared is None or f"{name}_deg" in stated:
                found[name] = table.number(f"{name}_deg", None, at_least=-most, at_most=most)
        if shared is not None:
            found["pose"] = self._pose(table) if "pose" in stated else None
            if not found["machine"] and "machine" not in self._elsewhere and "machine" not in stated:
                table.add_problem("machine", "is missing", "name the machine, here or for all set-ups")
            found["places"] = {**shared["places"], **_places(table)}
        else:
            found["places"] = _places(table)
        self._of_post(table, found)
        if is_alone or shared is not None:
            found["programs"], found["posted"] = self._programs(table, found)
        if shared is not None:
            table.report_unread_keys()
        return found

    def _of_post(self, table: Table, found: dict[str, Any]) -> None:
        """How a set-up is posted, as far as set-ups may share it; added to what is ``found``."""
        if "divide" in table or "division" not in found:
            found["division"] = Division(table.text("divide", Division.ONE, one_of=tuple(Division)))
        settings, places = read_settings(table)
        if "divide" in table:
            places["programs"] = (*table.location("divide"), table.key_path("divide"))
        found["settings"] = {**found.get("settings", {}), **settings}
        found["setting_places"] = {**found.get("setting_places", {}), **places}

    def _programs(self, table: Table, found: Mapping[str, Any]) -> tuple[tuple[str, ...], PostedSetup | None]:
        """Return the programs of a set-up, and how they are posted if they are; given elsewhere they need not
        be there.
        """
        output = self._paths.output(table, "output")
        released, papers = self._paths.files(table, "released"), self._papers(table, output)
        if output is None:
            for key in ("released", *PAPERS):
                if key in table:
                    table.add_problem(key, "belongs to a program that is posted", "write output, too, or leave it out")
            if self._is_posted and "programs" not in table and (found["cl"] or "cl" in table):
                table.add_problem("output", "is missing", 'name the program that is posted: output = "NAME.mpf"')
                return (), None
            if "nc" in self._elsewhere:
                table.texts("programs", ())
                return (), None
            return self._paths.files(table, "programs", required="output" not in table), None
        if "programs" in table:
            table.add_problem("programs", "stands beside output", "write programs that exist, or one that is posted")
            table.mark_read("programs")
        if not found["cl"] and "cl" not in table:
            table.add_problem("cl", "is missing", 'name the CL files that are posted: cl = ["one.cls"]')
        for name in papers.by_name() if found["division"] is Division.OPERATIONS else ():
            what = f"is one {PAPERS[name]}, and every operation has a program of its own"
            table.add_problem(name, what, "leave it out")
        if not self._is_posted and "nc" not in self._elsewhere:
            self._check_is_posted(table, output, found["division"])
        keys = ("name", "cl", "machine", "division", "settings", "subprograms", "turn", "tilt")
        named = {key: found[key] for key in keys}
        posted = PostedSetup(
            output=output, released=released, papers=papers, places=found["setting_places"], **named
        )  # fmt: skip
        return (str(output),), posted

    def _papers(self, table: Table, output: Path | None) -> PaperFiles:
        """Return what is written about a program beside it."""
        told = len(table.problems)
        named = {name: self._paths.output(table, name) for name in PAPERS}
        if output is None or len(table.problems) > told:
            return NO_PAPERS
        for name, file in named.items():
            try:
                paper_files(**{**dict.fromkeys(PAPERS), name: file}, output=output)
            except InputError as error:
                table.add_problem(
                    name, f"names {error.problems[0].file}: {error.problems[0].what}", error.problems[0].cure
                )
        return PaperFiles(**named)

    def _check_is_posted(self, table: Table, output: Path, division: Division) -> None:
        """Note where programs that a project posts cannot be simulated as they lie there."""
        if division is not Division.ONE:
            what = "becomes several files, whose names are known only while it is posted"
            table.add_problem("output", what, 'write simulate = "refuse" in [checks], and post the project')
        elif not is_file(output):
            cure = f"post it first: trunnion post {self._path.name}"
            table.add_problem("output", f'names "{table.text("output")}", and there is no such file yet', cure)

    def _pose(self, table: Table) -> Pose:
        pose = table.table("pose")
        x, y, z = pose.vector("origin_mm", 3, (0.0, 0.0, 0.0))
        a, b, c = pose.vector("turn_deg", 3, (0.0, 0.0, 0.0))
        pose.report_unread_keys()
        return Pose((x, y, z), (a, b, c))

    def _machine(self, table: Table, *, required: bool) -> str:
        name = table.text("machine") if required else table.text("machine", "")
        if name.endswith(".toml"):
            return self._paths.file(table, "machine", name)
        return table.text("machine", "", one_of=shipped_machines()) if name else ""


@contextmanager
def told_by_keys(path: Path) -> Iterator[None]:
    """Tell problems with arguments that a project does not state as those of the keys that it lacks."""
    try:
        yield
    except InputError as error:
        raise InputError([_by_key(problem, path) for problem in error.problems]) from None


def _by_key(problem: Problem, path: Path) -> Problem:
    if not problem.argument:
        return problem
    wording = problem.wording.within("of", name=_KEYS.get(problem.argument, problem.argument))
    return replace(problem, file=str(path), wording=wording, subject=None)


def _try(table: Table, check: Callable[..., object], *values: object) -> None:
    """Note what cannot be used of a text, so that it is told with all other mistakes."""
    try:
        check(*values)
    except InputError as error:
        table.problems.extend(with_place(problem, _places(table)) for problem in error.problems)


def _number(table: Table) -> int:
    """Return the number of a set-up, from 1."""
    return int(table.path.rpartition("[")[2].rstrip("]")) + 1


def _places(table: Table) -> dict[str, tuple[str, int, str]]:
    """File, line and key of each argument that a table states."""
    return {argument: (*table.location(key), table.key_path(key)) for argument, key in _KEYS.items() if key in table}
