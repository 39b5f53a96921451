"""Project files: a simulation that is written once, as the table ``[simulation]`` of a TOML file.

In:     the file.
Out:    ``SimulationInput``, as the arguments of ``trunnion.simulate`` would give it.
Units:  mm, degrees.

A project may come from anyone: it names files beside or below its own only, and nothing of it is run.
"""

import os
import re
from collections.abc import Callable, Collection, Iterable, Iterator
from importlib.resources import files
from pathlib import Path, PurePosixPath
from typing import Any, Final

from trunnion.api.reading import FilePath, as_machine
from trunnion.api.settings import work_offset_setting
from trunnion.api.simulation_setups import SetupInput, SimulationInput, listed, with_place
from trunnion.definitions import Table, load_table
from trunnion.definitions.extends import MAX_FILE_BYTES, is_within
from trunnion.errors import InputError, Problem, unusable_file
from trunnion.machines import shipped_machines
from trunnion.model.toolpath import Toolpath
from trunnion.simulation.stock.solids import stock_shape
from trunnion.simulation.stock.turning import Pose
from trunnion.simulation.tools.text import parse_tool

#: A line that begins the table of a simulation: no control has one like it.
_HEADER: Final = re.compile(rb"^[ \t]*\[{1,2}[ \t]*[\"']?simulation[\"']?[ \t]*[\].]", re.MULTILINE)

#: Set-ups that a project may have.
_MOST_SETUPS: Final = 100

#: Argument of ``simulate`` -> the key that states it.
_KEYS: Final = {
    "nc": "programs", "subprograms": "subprograms", "machine": "machine", "part": "part", "fixtures": "fixtures",
    "work_offset": "work_offset", "tools": "tools", "libraries": "tool_libraries", "unit": "unit", "cl": "cl",
    "zero": "zero_mm", "tool_length": "tool_length_mm", "until": "until", "stock": "stock", "cell": "cell_mm",
    "accuracy": "accuracy_mm", "near": "near_mm", "stop_at": "stop_at",
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
    projects = [read_project(Path(each), ("machine", "stock", *elsewhere)) for each in given if is_project(Path(each))]
    named = [name for each in projects for setup in each.setups for name in _named_files(setup)]
    return [*named, *(str(each.stock) for each in projects)]


def _named_files(setup: SetupInput) -> Iterator[FilePath]:
    several: tuple[Iterable[object], ...] = setup.programs, setup.subprograms, setup.fixtures, setup.libraries
    for names in (*several, listed("cl", setup.cl, Toolpath), (setup.part,)):
        yield from (name for name in names if isinstance(name, str | os.PathLike))
    if isinstance(setup.machine, str) and setup.machine.endswith(".toml"):
        yield setup.machine


def read_project(path: Path, elsewhere: Collection[str] = ()) -> SimulationInput:
    """Read a project file; it may leave out the arguments that are given ``elsewhere``.

    Raises
    ------
    InputError
        If it cannot be read, with every mistake in it and its line.
    """
    if path.suffix != ".toml":
        raise InputError(
            Problem(str(path), 0, "is a project by its content", "let its name end in .toml", code="SIM112")
        )
    if unusable := unusable_file(path, "a project"):
        raise InputError(unusable)
    root = load_table(path, files(__package__), kind="project")
    if "simulation" not in root:
        what, cure = "has no table [simulation]", "write one, or give NC programs"
        raise InputError(Problem(str(path), 0, what, cure, code="SIM112"))
    found = _Reader(path, elsewhere).simulation(root.table("simulation"))
    root.report_unread_keys()
    root.raise_problems()
    return found


class _Reader:
    """Reads the tables of a project; mistakes become problems of the tables."""

    def __init__(self, path: Path, elsewhere: Collection[str]) -> None:
        self._folder, self._elsewhere = path.parent, elsewhere

    def simulation(self, table: Table) -> SimulationInput:
        """All of it."""
        stock = table.text("stock", "") if "stock" in self._elsewhere else table.text("stock")
        if "stock" in table and stock == "" and not table.problems:
            table.add_problem("stock", 'is ""', "state a box, a cylinder or a mesh")
        elif stock and not stock.startswith(("box:", "cylinder:")):
            stock = self._file(table, "stock", stock)
        elif stock and "stock" not in self._elsewhere:
            _try(table, stock_shape, stock)
        told, own = len(table.problems), table.tables("setup")
        if "setup" in table and not own and len(table.problems) == told:
            table.add_problem("setup", "is []", "write tables [[simulation.setup]], or leave it out")
        if len(own) > _MOST_SETUPS:
            table.add_problem("setup", f"has {len(own)} tables", f"write at most {_MOST_SETUPS}")
            own = []
        if own and "programs" in table:
            table.add_problem("programs", "stands beside set-ups", "write it in each [[simulation.setup]]")
            table.mark_read("programs")
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
        table.report_unread_keys()
        places = _places(table)
        return SimulationInput(
            stock=stock, setups=[SetupInput(**setup) for setup in setups], places=places, **found
        )  # fmt: skip

    def _setup(self, table: Table, shared: dict[str, Any] | None, *, is_alone: bool = False) -> dict[str, Any]:
        """What a set-up states; ``shared`` is what stands for all of them, None where this is it, maybe alone."""
        found: dict[str, Any] = {} if shared is None else dict(shared)
        stated = set(table.keys())
        if is_alone or shared is not None:
            found["programs"] = self._programs(table)
        found["name"] = "" if shared is None else table.text("name", f"set-up {_number(table)}")
        for argument, key in (("subprograms",) * 2, ("fixtures",) * 2, ("cl",) * 2, ("libraries", "tool_libraries")):
            if shared is None or key in stated:
                found[argument] = self._files(table, key)
        if shared is None or "machine" in stated:
            found["machine"] = self._machine(table, required=is_alone and "machine" not in self._elsewhere)
        if "part" in stated:
            found["part"] = self._file(table, "part", table.text("part"))
        elif shared is not None and table.path != "simulation.setup[0]":
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
        if shared is not None:
            found["pose"] = self._pose(table) if "pose" in stated else None
            if not found["machine"] and "machine" not in self._elsewhere and "machine" not in stated:
                table.add_problem("machine", "is missing", "name the machine, here or in [simulation]")
            table.report_unread_keys()
            found["places"] = {**shared["places"], **_places(table)}
        else:
            found["places"] = _places(table)
        return found

    def _programs(self, table: Table) -> tuple[str, ...]:
        """The programs of a set-up; where they are given elsewhere they may be missing, and not be there yet."""
        if "nc" not in self._elsewhere:
            return self._files(table, "programs", required=True)
        table.texts("programs", ())
        return ()

    def _pose(self, table: Table) -> Pose:
        pose = table.table("pose")
        x, y, z = pose.vector("origin_mm", 3, (0.0, 0.0, 0.0))
        a, b, c = pose.vector("turn_deg", 3, (0.0, 0.0, 0.0))
        pose.report_unread_keys()
        return Pose((x, y, z), (a, b, c))

    def _machine(self, table: Table, *, required: bool) -> str:
        name = table.text("machine") if required else table.text("machine", "")
        if name.endswith(".toml"):
            return self._file(table, "machine", name)
        return table.text("machine", "", one_of=shipped_machines()) if name else ""

    def _files(self, table: Table, key: str, *, required: bool = False) -> tuple[str, ...]:
        names = table.texts(key) if required else table.texts(key, ())
        if required and key in table and not names:
            table.add_problem(key, "is []", 'write ["one.mpf"]')
        return tuple(self._file(table, key, name) for name in names)

    def _file(self, table: Table, key: str, name: str) -> str:
        """The path of a file that a project names; it lies beside the project or below."""
        if not name:
            return ""
        pure = PurePosixPath(name)
        location = self._folder / pure
        cure = "write the path of a file in the folder of the project or below it"
        outside = pure.is_absolute() or ".." in pure.parts or re.search(r"[\\:\x00-\x1f]", name) or len(name) > 1000
        if outside or not is_within(location, self._folder):
            table.add_problem(key, f'"{name[:100]}" leads out of the folder of the project', cure)
        elif not location.is_file():
            table.add_problem(key, f'names "{name}", and there is no such file', cure)
        return str(location)


def _try(table: Table, check: Callable[..., object], *values: object) -> None:
    """Note what cannot be used of a text, so that it is told with all other mistakes."""
    try:
        check(*values)
    except InputError as error:
        table.problems.extend(with_place(problem, _places(table)) for problem in error.problems)


def _number(table: Table) -> int:
    """The number of a set-up, from 1."""
    return int(table.path.rpartition("[")[2].rstrip("]")) + 1


def _places(table: Table) -> dict[str, tuple[str, int, str]]:
    """File, line and key of each argument that a table states."""
    return {argument: (*table.location(key), table.key_path(key)) for argument, key in _KEYS.items() if key in table}
