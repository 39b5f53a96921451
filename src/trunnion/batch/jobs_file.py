"""Files of jobs, in TOML: defaults, and jobs with the files of each.

A file of jobs may come from anyone: it names files beside or below its own only, and runs nothing.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from importlib.resources import files
from pathlib import Path, PurePosixPath
from typing import Any, Final, TypeAlias

from trunnion.batch.argument_checks import MOST_TILES, beside_fault
from trunnion.batch.jobs import Batch, BatchJob, folder_files, judged
from trunnion.batch.patterns import matches, pattern_fault
from trunnion.batch.result_keys import home_of
from trunnion.batch.unmatched_patterns import unmatched
from trunnion.batch.worker_task import Action
from trunnion.cl import DIALECTS
from trunnion.cl.writers import WRITERS
from trunnion.definitions import Table, load_table
from trunnion.definitions.extends import is_within
from trunnion.errors import InputError, unusable_file
from trunnion.files import name_fault
from trunnion.jobs.inputs.settings import as_texts
from trunnion.jobs.project.paths import ProjectPaths
from trunnion.machines import shipped_machines
from trunnion.messages import Wording
from trunnion.simulation.stock.solids import is_mesh

#: Jobs that a file may have, patterns of one, and settings.
_MOST_JOBS: Final = 1000
_MOST_PATTERNS: Final = 100
_MOST_SETTINGS: Final = 500

#: Where results go if nothing else is said.
RESULTS: Final = "results"

_ALL: Final = frozenset(Action)
_POST, _CONVERT, _VERIFY, _SIMULATE = (frozenset({each}) for each in Action)

_Reader: TypeAlias = Callable[["_Tables", Table, str], Any]


@dataclass(frozen=True, slots=True)
class _Option:
    """A key of a job: the argument that it states, the actions that take it, and how it is read."""

    argument: str
    actions: Collection[Action]
    read: _Reader


class _Tables:
    """Reads the values of keys; mistakes become problems of the tables."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.paths = ProjectPaths(folder)

    def machine(self, table: Table, key: str) -> str:
        name = table.text(key, "")
        if name.endswith(".toml"):
            return self.paths.file(table, key, name)
        return table.text(key, "", one_of=shipped_machines()) if name else ""

    def settings(self, table: Table, key: str) -> dict[str, Any]:
        own, found = table.table(key), dict[str, Any]()
        stated = own.to_dict()
        if len(stated) > _MOST_SETTINGS:
            table.add_problem(key, Wording("DEF330", "keys", count=len(stated), most_settings=_MOST_SETTINGS))
            stated = {}
        for name, value in stated.items():
            try:
                as_texts({name: value})  # type: ignore[dict-item]  # of any type: that is what is judged
                found[name] = value
            except InputError as error:
                file, line = own.location(name)
                own.problems.extend(replace(each, file=file, line=line, subject=None) for each in error.problems)
        own.mark_read(*own.names())
        return found

    def stock(self, table: Table, key: str) -> str:
        name = table.text(key, "")
        return self.paths.file(table, key, name) if name and is_mesh(name) else name

    def file(self, table: Table, key: str) -> str:
        name = table.text(key, "")
        return self.paths.file(table, key, name) if name else ""

    def files(self, table: Table, key: str) -> list[str]:
        return list(self.paths.files(table, key))

    def beside(self, table: Table, key: str) -> list[str]:
        """Names of files that go with each input, which are not known yet."""
        found = list(table.texts(key, ()))
        for name in found:
            if fault := beside_fault(name):
                table.add_problem(key, Wording("DEF330", "no_name_beside", name=name[:100], fault=fault))
        return found


def _text(*one_of: str) -> _Reader:
    return lambda _, table, key: table.text(key, "", one_of=one_of)


def _number(_: _Tables, table: Table, key: str) -> float | None:
    return table.number(key, None, above=0.0)


def _tool_length(_: _Tables, table: Table, key: str) -> float | None:
    return table.number(key, None, above=0.0, at_most=_LONGEST_TOOL)


def _angle(most: float) -> _Reader:
    return lambda _, table, key: table.number(key, None, at_least=-most, at_most=most)


def _vector(_: _Tables, table: Table, key: str) -> list[float] | None:
    found = table.vector(key, 3, None)
    return None if found is None else list(found)


#: The setting ``tool_length`` takes no more, mm.
_LONGEST_TOOL: Final = 10_000.0

#: Keys that a post has as settings.
_PLACE_SETTINGS: Final = {"zero_mm": "zero", "tool_length_mm": "tool_length"}

#: Keys of a job besides those that say which files it has and where its results go.
_OPTIONS: Final[Mapping[str, _Option]] = {
    "machine": _Option("machine", _ALL, _Tables.machine),
    "report": _Option("report", _POST | _VERIFY | _SIMULATE, _text("html", "json")),
    "settings": _Option("settings", _POST | _CONVERT, _Tables.settings),
    "strict": _Option("strict", _POST, lambda _, table, key: table.flag(key, False)),
    "subprograms": _Option("subprograms", _ALL, _Tables.beside),
    "to_machine": _Option("to_machine", _CONVERT, _Tables.machine),
    "to_cl": _Option("to_cl", _CONVERT, lambda _, table, key: table.flag(key, False)),
    "to_dialect": _Option("dialect", _CONVERT, _text(*WRITERS)),
    "cl": _Option("cl", _VERIFY | _SIMULATE, _Tables.beside),
    "dialect": _Option("dialect", _VERIFY, _text(*DIALECTS)),
    "units": _Option("units", _VERIFY, _text("mm", "inch")),
    "frame": _Option("frame", _VERIFY, _text("first", "absolute")),
    "feed": _Option("feed", _VERIFY, _text("programmed", "fastest")),
    "work_offset": _Option("work_offset", _VERIFY, lambda _, table, key: table.text(key, "", example="G54")),
    "tolerance_mm": _Option("tolerance", _VERIFY, _number),
    "span_deg": _Option("span", _VERIFY, _number),
    "span_tip_mm": _Option("span_tip", _VERIFY, _number),
    "zero_mm": _Option("zero", _ALL, _vector),
    "tool_length_mm": _Option("tool_length", _ALL, _tool_length),
    "turn_deg": _Option("turn", _POST | _VERIFY | _SIMULATE, _angle(360.0)),
    "tilt_deg": _Option("tilt", _POST | _VERIFY | _SIMULATE, _angle(90.0)),
    "stock": _Option("stock", _SIMULATE, _Tables.stock),
    "part": _Option("part", _SIMULATE, _Tables.file),
    "fixtures": _Option("fixtures", _SIMULATE, _Tables.files),
    "tools": _Option("tools", _SIMULATE, lambda _, table, key: list(table.texts(key, ()))),
    "tool_libraries": _Option("libraries", _SIMULATE, _Tables.files),
    "unit": _Option("unit", _SIMULATE, _text("mm", "inch")),
    "cell_mm": _Option("cell", _SIMULATE, _number),
    "accuracy_mm": _Option("accuracy", _SIMULATE, _number),
    "near_mm": _Option("near", _SIMULATE, _number),
    "stop_at": _Option("stop_at", _SIMULATE, _text("none", "first")),
    "tiles": _Option("tiles", _SIMULATE, lambda _, table, key: table.integer(key, 1, at_least=1, at_most=MOST_TILES)),
}


def load_batch(path: Path) -> Batch:
    """Read a file of jobs, and find their files.

    Raises
    ------
    InputError
        If it cannot be read, with every mistake in it and its line; or if a job has no files.
    """
    if unusable := unusable_file(path, "a file of jobs"):
        raise InputError(unusable)
    return read_batch_table(load_table(path, files(__package__), kind="file of jobs"), path)


def read_batch_table(root: Table, path: Path) -> Batch:
    """Read the table of a file of jobs that stands, or would stand, in the file ``path``; errors as ``load_batch``."""
    tables = _Tables(path.parent)
    results = _results(root, path.parent)
    defaults = root.table("defaults")
    default_action = _action(defaults, Action.POST)
    default_output = _output(defaults)
    default_values = _values(tables, defaults)
    own = root.tables("job", required=True)
    if len(own) > _MOST_JOBS:
        root.add_problem("job", Wording("DEF330", "tables", count=len(own), most_jobs=_MOST_JOBS))
        own = []
    found = folder_files(path.parent, results) if path.parent.is_dir() else []
    found = [name for name in found if name != path.name]
    jobs: list[BatchJob] = []
    for number, table in enumerate(own, 1):
        action = _action(table, default_action)
        stated = _values(tables, table)
        output = _output(table) or default_output
        name = table.text("name", f"job {number}")
        if name in [job.name for job in jobs]:
            table.add_problem("name", Wording("DEF330", "twice", name=name[:100]))
        _refuse_keys(table, action, stated)
        of_defaults = {key: value for key, value in default_values.items() if action in _OPTIONS[key].actions}
        if action is Action.POST:
            of_defaults, stated = _with_place_settings(defaults, of_defaults), _with_place_settings(table, stated)
        values = of_defaults | stated
        if "settings" in values:
            values["settings"] = of_defaults.get("settings", {}) | stated.get("settings", {})
        inputs = _inputs(table, found, path, results)
        jobs += _judged(table, name, action, inputs, values, output, path.parent)
    defaults.report_unread_keys()
    for table in own:
        table.report_unread_keys()
    root.report_unread_keys()
    root.raise_problems()
    return Batch(path.parent, jobs, results, home_of(path), is_whole=True)


def _with_place_settings(table: Table, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a table states of a post, with the workpiece zero and the tool length among its settings."""
    found = dict(values)
    place = {name: value for key, name in _PLACE_SETTINGS.items() if (value := found.pop(key, None)) is not None}
    own = found.get("settings", {})
    for key, name in _PLACE_SETTINGS.items():
        if name in place and name in own:
            table.add_problem(key, Wording("BAT110", "stated_besides_settings", name=name))
    return {**found, "settings": {**place, **own}} if place else found


def _judged(
    table: Table, name: str, action: Action, inputs: list[str], values: dict[str, Any], output: str, folder: Path
) -> list[BatchJob]:
    """Return the job of a table, if its arguments can be used; else its problems are told where the table
    states them.
    """
    if table.problems:
        return []
    beside = {key: values.pop(key) for key in ("cl", "subprograms") if values.get(key)}
    report, tiles = values.pop("report", ""), values.pop("tiles", 1)
    if tiles > 1 and values.get("stop_at") == "first":
        table.add_problem("tiles", Wording("SIM116", "no_meaning_stop"))
    for key in ("turn_deg", "tilt_deg") if action is Action.VERIFY and "cl" not in beside else ():
        if values.get(key):
            table.add_problem(key, Wording("BAT110", "turns_cl_files"))
    if table.problems:
        return []
    arguments = {_OPTIONS[key].argument: value for key, value in values.items() if value}
    keys = {_OPTIONS[key].argument: key for key in values}
    try:
        said, shared, extensions = judged(action, arguments, folder)
    except InputError as error:
        for each in error.problems:
            if each.argument:
                table.add_problem(keys.get(each.argument, each.argument), each.wording)
            else:
                table.problems.append(each)
        return []
    return [BatchJob(name, action, inputs, said, shared, beside, output, extensions.written, report, tiles)]


def _action(table: Table, default: Action) -> Action:
    stated = table.text("action", "", one_of=tuple(Action))
    return Action(stated) if stated else default


def _results(root: Table, folder: Path) -> Path:
    name = _folder_name(root, "results") or RESULTS
    if not is_within(folder / name, folder):
        root.add_problem("results", Wording("DEF330", "leads_out_folder", name=name[:100]))
    return folder / name


def _output(table: Table) -> str:
    return _folder_name(table, "output")


def _folder_name(table: Table, key: str) -> str:
    """Return the name of a folder below another one; empty if it is not stated."""
    name = table.text(key, "").rstrip("/")
    if not name:
        return ""
    fault = pattern_fault(name) or ("begins with ~, which stands for no folder here" if name[0] == "~" else "")
    fault = f'"{name[:100]}" {fault}' if fault else name_fault(PurePosixPath(name))
    if fault:
        table.add_problem(key, fault, 'name a folder, such as "out"', code="FIL340")
        return ""
    return name


def _values(tables: _Tables, table: Table) -> dict[str, Any]:
    """Return what a table states of the options, by their keys; all of them are asked for, so that none is unknown."""
    stated = set(table.keys())
    return {
        key: value for key, option in _OPTIONS.items() for value in [option.read(tables, table, key)] if key in stated
    }


def _refuse_keys(table: Table, action: Action, stated: Collection[str]) -> None:
    for key in stated:
        if action not in _OPTIONS[key].actions:
            table.add_problem(
                key,
                Wording(
                    "BAT110",
                    "no_meaning_action",
                    action=action,
                    action_2=tuple(f'"{each}"' for each in Action if each in _OPTIONS[key].actions),
                ),
            )


def _inputs(table: Table, names: Collection[str], path: Path, results: Path) -> list[str]:
    """Return the files of a job."""
    patterns = table.texts("files")
    if len(patterns) > _MOST_PATTERNS:
        table.add_problem("files", Wording("DEF330", "patterns", count=len(patterns), most_patterns=_MOST_PATTERNS))
        return []
    if table.to_dict().get("files") == []:
        table.add_problem("files", Wording("DEF330", "is_or_write_cls"))
    found = set[str]()
    for pattern in patterns:
        if fault := pattern_fault(pattern):
            table.add_problem("files", Wording("DEF330", "no_pattern", pattern=pattern[:100], fault=fault))
            continue
        matched = [name for name in names if matches(name, pattern)]
        if not matched:
            why = unmatched(path.parent, pattern, results)
            if why:
                wording = Wording("BAT120", "matches_no", pattern=pattern[:100], left_out=why)
            elif matches(path.name, pattern):
                wording = Wording("BAT120", "matches_no_file", pattern=pattern[:100], path=path.name)
            else:
                wording = Wording("BAT120", "matches_no_file_or_look", pattern=pattern[:100])
            table.add_problem("files", wording)
        found.update(matched)
    return sorted(found)
