"""Project files: set-ups of a part that are written once, as a TOML file, for posts and simulations.

In:     the file. Its keys stand at its top, or all of them in a table ``[simulation]``.
Out:    a ``Project``, whose ``SimulationInput`` is what the arguments of ``trunnion.simulate`` would give.
Units:  mm, degrees.

A project may come from anyone: it names files beside or below its own only. Nothing of it is run but the hooks that it
names, and these by a post alone.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from trunnion.definitions import Table, load_table
from trunnion.definitions.extends import MAX_FILE_BYTES
from trunnion.errors import InputError, Problem, unusable_file
from trunnion.jobs.inputs.simulation_input import SimulationInput
from trunnion.jobs.project.keys import KEYS, OF_PROJECT
from trunnion.jobs.project.project import Judgement, Project, ProjectChecks
from trunnion.jobs.project.setups import OF_ONE_PROGRAM, Purpose, SetupReader, places_of, try_value
from trunnion.jobs.project.stated_values import StatedValues
from trunnion.machines import shipped_machines
from trunnion.messages import Wording, phrase
from trunnion.simulation.stock.solids import CL_STOCK, is_mesh, stock_shape

#: A line that begins the table of a simulation: no control has one like it.
_HEADER: Final = re.compile(rb"^[ \t]*\[{1,2}[ \t]*[\"']?simulation[\"']?[ \t]*[\].]", re.MULTILINE)

#: Set-ups that a project may have.
_MOST_SETUPS: Final = 100

#: Keys of which a project has at least one, as no other definition does.
_KEYS_OF_PROJECTS: Final = ("setup", "programs", "cl", "output", "stock")


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


def read_project(path: Path, elsewhere: Collection[str] = ()) -> SimulationInput:
    """Read a project to be simulated; it may leave out the arguments that are given ``elsewhere``.

    Raises ``InputError`` if it cannot be read, with every mistake in it and its line; or if programs that it posts are
    not there.
    """
    return read_whole(path, elsewhere, is_posted=False).simulation


def load_project(path: Path) -> Project:
    """Read a project to be posted: the programs need not be there yet, and a stock only where it is simulated.

    Raises ``InputError`` if it cannot be read, or posts nothing; with every mistake in it and its line.
    """
    return read_whole(path, (), is_posted=True)


def read_whole(path: Path, elsewhere: Collection[str] = (), *, is_posted: bool) -> Project:
    """Read a project for posts or for simulations; errors as ``load_project`` or ``read_project``."""
    if unusable := unusable_file(path, phrase("file_of_project")):
        raise InputError(unusable)
    if path.suffix != ".toml":
        raise InputError(Problem(str(path), 0, Wording("SIM112", "project_of_other_ending")))
    try:
        root = load_table(path, files(__package__), kind="project")
    except InputError as error:
        if any(problem.wording.parameter("name") in shipped_machines() for problem in error.problems):
            raise InputError(Problem(str(path), 0, Wording("SIM112", "machine_for_project"))) from None
        raise
    return read_project_table(root, path, elsewhere, is_posted=is_posted)


def read_project_table(root: Table, path: Path, elsewhere: Collection[str] = (), *, is_posted: bool = True) -> Project:
    """Read the table of a project that stands, or would stand, in the file ``path``; errors as ``load_project``."""
    if "simulation" not in root and not any(key in root for key in _KEYS_OF_PROJECTS):
        is_machine = "axis" in root or "spindle" in root or "control" in root
        wording = Wording("SIM112", "no_project", keys=_KEYS_OF_PROJECTS)
        raise InputError(Problem(str(path), 0, Wording("SIM112", "machine_for_project") if is_machine else wording))
    found = _Reader(Purpose(path, elsewhere, is_posted)).project(root)
    root.report_unread_keys()
    root.raise_problems()
    return found


class _Reader:
    """Reads the tables of a project; mistakes become problems of the tables."""

    def __init__(self, purpose: Purpose) -> None:
        self._purpose, self._stated = purpose, StatedValues(purpose.path.parent)
        self._setups = SetupReader(purpose, self._stated)

    def project(self, root: Table) -> Project:
        """Return all of it; its keys stand at the top, or in one table."""
        table = root.table("simulation") if "simulation" in root else root
        checks = _checks(table.table("checks"))
        hooks = self._stated.paths.files(table, "hooks")
        strict = table.flag("strict", False)
        own = _tables(table)
        whole = self._whole(table, checks, has_cl="cl" in table or bool(own and "cl" in own[0]))
        shared = self._setups.shared(table, is_alone=not own)
        setups = [self._setups.one(each, shared) for each in own] if own else [self._setups.alone(table, shared)]
        _check_names(own, [each.simulated.name for each in setups])
        simulated = [each.simulated for each in setups]
        simulated[-1] = replace(simulated[-1], until=whole.pop("until"))
        posted = tuple(each.posted for each in setups)
        if self._purpose.is_posted and not any(posted) and not table.problems:
            table.add_problem("", Wording("DEF330", "posts_nothing"))
        table.report_unread_keys()
        simulation = SimulationInput(setups=simulated, places=places_of(table), **whole)
        return Project(self._purpose.path, simulation, posted, checks, hooks, strict, files=tuple(root.files()))

    def _whole(self, table: Table, checks: ProjectChecks, *, has_cl: bool) -> dict[str, Any]:
        """Return what is stated of the simulation as a whole, by the names of arguments."""
        is_simulated = not self._purpose.is_posted or checks.simulate is not Judgement.OFF
        found = {each.name: self._stated.value(table, each) for each in OF_PROJECT if each.name != "stock"}
        is_needed = is_simulated and not has_cl and not {"stock", "cl"} & {*self._purpose.elsewhere}
        found["stock"] = self._stock(table, is_needed=is_needed)
        if found["until"] is not None and self._purpose.is_posted and is_simulated:
            table.add_problem("until", Wording("DEF330", "ends_early"))
        return found

    def _stock(self, table: Table, *, is_needed: bool) -> str:
        stock = table.text("stock") if is_needed else table.text("stock", "")
        if "stock" in table and stock == "" and not table.problems:
            table.add_problem("stock", Wording("DEF330", "no_stock"))
        elif stock and is_mesh(stock):
            return self._stated.paths.file(table, "stock", stock)
        elif stock not in ("", CL_STOCK) and "stock" not in self._purpose.elsewhere:
            try_value(table, stock_shape, stock)
        return stock


def _checks(table: Table) -> ProjectChecks:
    """Return what is judged after the posts."""
    words = tuple(Judgement)
    found = ProjectChecks(
        Judgement(table.text("simulate", Judgement.OFF, one_of=words)),
        Judgement(table.text("released", Judgement.WARN, one_of=words)),
        table.number("longest_s", None, above=0.0),
    )
    table.report_unread_keys()
    return found


def _tables(table: Table) -> list[Table]:
    """Return the tables of set-ups; none where the project is one set-up, or there are too many."""
    told, own = len(table.problems), table.tables("setup")
    if "setup" in table and not own and len(table.problems) == told:
        table.add_problem("setup", Wording("DEF330", "no_setups", key=table.key_path("setup")))
    if len(own) > _MOST_SETUPS:
        table.add_problem("setup", Wording("DEF330", "too_many_setups", count=len(own), most=_MOST_SETUPS))
        return []
    if own:
        for key in (key for key in OF_ONE_PROGRAM if key in table):
            table.add_problem(key, Wording("DEF330", "beside_setups", key=table.key_path("setup")))
        table.mark_read(*OF_ONE_PROGRAM)
    return own


def _check_names(tables: Sequence[Table], names: Sequence[str]) -> None:
    """Note set-ups that cannot be told apart, and a pose that would be that of nothing."""
    for k, (each, name) in enumerate(zip(tables, names, strict=False)):
        if name in names[:k]:
            each.add_problem("name", Wording("DEF330", "setup_name_twice", name=name))
    if tables and "pose" in tables[0]:
        tables[0].add_problem("pose", Wording("DEF330", "pose_of_first"))


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
    wording = problem.wording.within("of", name=KEYS.get(problem.argument, problem.argument))
    return replace(problem, file=str(path), wording=wording, subject=None)
