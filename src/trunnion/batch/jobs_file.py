"""Files of jobs, in TOML: defaults, and jobs with the files of each.

A file of jobs may come from anyone: it names files beside or below its own only, and runs nothing.
"""

from collections.abc import Collection, Mapping
from dataclasses import replace
from importlib.resources import files
from pathlib import Path, PurePosixPath
from typing import Any, Final, NamedTuple

from trunnion.batch.argument_checks import beside_fault
from trunnion.batch.jobs import Batch, BatchJob, folder_files, judged
from trunnion.batch.patterns import matches, pattern_fault
from trunnion.batch.result_keys import home_of
from trunnion.batch.unmatched_patterns import unmatched
from trunnion.batch.worker_task import Action
from trunnion.definitions import Table, load_table
from trunnion.definitions.extends import is_within
from trunnion.errors import InputError, unusable_file
from trunnion.files import name_fault
from trunnion.jobs.inputs.settings import as_texts
from trunnion.jobs.project.stated_values import StatedValues
from trunnion.jobs.registry import JOBS
from trunnion.messages import Wording, phrase
from trunnion.options.kinds import FileOut, Setting
from trunnion.options.option import Option
from trunnion.options.words import PROOF_SETTINGS
from trunnion.records import dataclass

#: Jobs that a file may have, patterns of one, and settings.
_MOST_JOBS: Final = 1000
_MOST_PATTERNS: Final = 100
_MOST_SETTINGS: Final = 500

#: Where results go if nothing else is said.
RESULTS: Final = "results"

#: Options that several files at once do not have: hooks, since a file of jobs runs nothing; where one program ends; and
#: simulations in the same run, which are an action of their own.
_OF_SINGLE_FILES: Final = ("hooks", "until", "simulate", "project")

#: Options whose files go with each input, so that they are not known yet.
_BESIDE: Final = ("cl", "subprograms")


@dataclass(frozen=True, slots=True)
class _Stated:
    """A key of a job: the option that it states, and of which actions; each may have it in words of its own."""

    options: Mapping[Action, Option]

    @property
    def option(self) -> Option:
        """The option as the first action has it: its kind is that of all."""
        return next(iter(self.options.values()))

    @property
    def argument(self) -> str:
        """Its name."""
        return self.option.name


def _takes_key(option: Option) -> bool:
    """Whether a job may state an option of its action."""
    is_left_out = option.own or option.heading or option.name in _OF_SINGLE_FILES
    return bool(option.key) and not is_left_out and not isinstance(option.kind, FileOut)


def _stated_keys() -> dict[str, _Stated]:
    """Return the keys of a job, as the actions declare them; a report and tiles are of the batch itself."""
    found: dict[str, dict[Action, Option]] = {}
    for action in Action:
        for option in filter(_takes_key, JOBS[action].flags):
            found.setdefault(option.key, {})[action] = option
    batch = JOBS["batch"]
    for name, actions in (("report", (Action.POST, Action.VERIFY, Action.SIMULATE)), ("tiles", (Action.SIMULATE,))):
        found[name] = {action: each.but(key=name) for each in batch.flags if each.name == name for action in actions}
    return {key: _Stated(options) for key, options in found.items()}


#: Keys of a job besides those that say which files it has and where its results go.
_KEYS: Final[Mapping[str, _Stated]] = _stated_keys()


class _Tables:
    """Reads the values of keys; mistakes become problems of the tables."""

    def __init__(self, folder: Path) -> None:
        self._stated = StatedValues(folder)

    def value(self, table: Table, option: Option) -> Any:
        """Return what a table states of an option."""
        if option.name in _BESIDE:
            return self._beside(table, option.key)
        if isinstance(option.kind, Setting):
            return self._settings(table, option.key)
        found = self._stated.value(table, option)
        return list(found) if isinstance(found, tuple) else found  # as JSON has it

    def _settings(self, table: Table, key: str) -> dict[str, Any]:
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

    def _beside(self, table: Table, key: str) -> list[str]:
        """Names of files that go with each input, which are not known yet."""
        found = list(table.texts(key, ()))
        for name in found:
            if fault := beside_fault(name):
                table.add_problem(key, Wording("DEF330", "no_name_beside", name=name[:100], fault=fault))
        return found


def load_batch(path: Path) -> Batch:
    """Read a file of jobs, and find their files.

    Raises ``InputError`` if it cannot be read, with every mistake in it and its line; or if a job has no files.
    """
    if unusable := unusable_file(path, phrase("file_of_jobs")):
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
        of_defaults = {key: value for key, value in default_values.items() if action in _KEYS[key].options}
        of_defaults = _with_settings(defaults, of_defaults, action)
        if action is Action.VERIFY and "settings" in of_defaults:  # others hold for the posts of the file
            of_defaults["settings"] = {
                key: own for key, own in of_defaults["settings"].items() if key in PROOF_SETTINGS
            }
            of_defaults = {key: value for key, value in of_defaults.items() if key != "settings" or value}
        stated = _with_settings(table, {key: stated[key] for key in stated if action in _KEYS[key].options}, action)
        values = of_defaults | stated
        if "settings" in values:
            values["settings"] = of_defaults.get("settings", {}) | stated.get("settings", {})
        inputs = _inputs(table, found, path, results)
        jobs += _judged(_Entry(table, name, action, inputs, output), values, path.parent)
    defaults.report_unread_keys()
    for table in own:
        table.report_unread_keys()
    root.report_unread_keys()
    root.raise_problems()
    return Batch(path.parent, jobs, results, home_of(path), is_whole=True)


def _with_settings(table: Table, values: Mapping[str, Any], action: Action) -> dict[str, Any]:
    """Return what a table states, with options among the settings that are settings of the action."""
    options = {key: _KEYS[key].options[action] for key in values}
    place = {each.setting: values[key] for key, each in options.items() if each.setting and values[key] is not None}
    found = {key: value for key, value in values.items() if not options[key].setting}
    own = found.get("settings", {})
    for key, each in options.items():
        if each.setting in place and each.setting in own:
            table.add_problem(key, Wording("BAT110", "stated_besides_settings", name=each.setting))
    return {**found, "settings": {**place, **own}} if place else found


class _Entry(NamedTuple):
    """A table of a job, and what the job is called, does, reads, and where its results go."""

    table: Table
    name: str
    action: Action
    inputs: list[str]
    output: str


def _judged(entry: _Entry, values: dict[str, Any], folder: Path) -> list[BatchJob]:
    """Return a job with the values of its options, if they can be used; else its problems are told where its table
    states them.
    """
    table, name, action, inputs, output = entry
    if table.problems:
        return []
    beside = {key: values.pop(key) for key in ("cl", "subprograms") if values.get(key)}
    report, tiles = values.pop("report", None) or "", values.pop("tiles", 1)
    if tiles > 1 and values.get("stop_at") == "first":
        table.add_problem("tiles", Wording("SIM116", "no_meaning_stop"))
    for key in ("turn_deg", "tilt_deg") if action is Action.VERIFY and "cl" not in beside else ():
        if values.get(key):
            table.add_problem(key, Wording("BAT110", "turns_cl_files"))
    if table.problems:
        return []
    arguments = {_KEYS[key].argument: value for key, value in values.items() if value}
    keys = {_KEYS[key].argument: key for key in values}
    try:
        said, shared, extensions = judged(action, arguments, folder, has_cl="cl" in beside)
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
    if fault := pattern_fault(name) or (phrase("begins_with_tilde") if name[0] == "~" else None):
        table.add_problem(key, Wording("FIL340", "no_folder_name", name=name[:100], fault=fault))
    elif fault := name_fault(PurePosixPath(name)):
        table.add_problem(key, Wording("FIL340", "name_of_no_folder", fault=fault))
    else:
        return name
    return ""


def _values(tables: _Tables, table: Table) -> dict[str, Any]:
    """Return what a table states of the options, by their keys; all of them are asked for, so that none is unknown."""
    stated = set(table.keys())
    return {key: value for key, each in _KEYS.items() for value in [tables.value(table, each.option)] if key in stated}


def _refuse_keys(table: Table, action: Action, stated: Collection[str]) -> None:
    for key in stated:
        if action not in _KEYS[key].options:
            table.add_problem(
                key,
                Wording(
                    "BAT110",
                    "no_meaning_action",
                    action=action,
                    actions=tuple(f'"{each}"' for each in Action if each in _KEYS[key].options),
                ),
            )


def _inputs(table: Table, names: Collection[str], path: Path, results: Path) -> list[str]:
    """Return the files of a job."""
    patterns = table.texts("files")
    if len(patterns) > _MOST_PATTERNS:
        table.add_problem("files", Wording("DEF330", "patterns", count=len(patterns), most_patterns=_MOST_PATTERNS))
        return []
    if table.to_dict().get("files") == []:
        table.add_problem("files", Wording("DEF330", "no_patterns"))
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
                wording = Wording("BAT120", "matches_nothing", pattern=pattern[:100])
            table.add_problem("files", wording)
        found.update(matched)
    return sorted(found)
