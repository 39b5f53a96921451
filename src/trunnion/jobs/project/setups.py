"""Reading the set-ups of a project: what is simulated in each, and what is posted.

In:     the table of all set-ups, and those of single ones, which state some of it in place of the first.
Out:    ``ReadSetup``: the set-up as it is simulated, and as it is posted, if it is.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from trunnion.controls.vocabulary import RADIUS_REGISTER_SETTING
from trunnion.definitions import Table
from trunnion.errors import InputError
from trunnion.jobs.inputs.reading import as_machine
from trunnion.jobs.inputs.settings import SettingValue, work_offset_setting
from trunnion.jobs.inputs.simulation_input import Places, SetupInput, with_place
from trunnion.jobs.project.keys import KEYS, OF_SETUP, POSTED, STATED
from trunnion.jobs.project.paths import is_file
from trunnion.jobs.project.project import Division, PostedSetup
from trunnion.jobs.project.settings import read_settings
from trunnion.jobs.project.stated_values import StatedValues
from trunnion.jobs.result_output import NO_PAPERS, PAPERS, PaperFiles, paper_files
from trunnion.messages import Wording
from trunnion.options.option import Option
from trunnion.options.words import CL_SETTINGS, FRAME_SETTING
from trunnion.records import dataclass
from trunnion.simulation.stock.turning import Pose
from trunnion.simulation.tools.text import parse_tool

#: What belongs to one program, and stands in the set-ups where there are any.
OF_ONE_PROGRAM: Final = ("programs", "output", "released", *PAPERS)


@dataclass(frozen=True, slots=True)
class Purpose:
    """What a project is read for.

    path       of its file
    elsewhere  arguments that are given otherwise: it may leave them out
    is_posted  its programs need not be there yet
    """

    path: Path
    elsewhere: Collection[str]
    is_posted: bool


@dataclass(frozen=True, slots=True, eq=False)
class StatedSetup:
    """What a table states, with what it takes over from the table of all set-ups.

    values          of options, by their names
    places          where they are stated
    division        of the post
    settings        of the post
    setting_places  where they are stated
    """

    values: Mapping[str, Any]
    places: Places
    division: Division
    settings: Mapping[str, SettingValue]
    setting_places: Places


@dataclass(frozen=True, slots=True, eq=False)
class ReadSetup:
    """A set-up as it is simulated, and as it is posted; None: its programs exist already."""

    simulated: SetupInput
    posted: PostedSetup | None


class SetupReader:
    """Reads the tables of set-ups; mistakes become problems of the tables."""

    def __init__(self, purpose: Purpose, stated: StatedValues) -> None:
        self._purpose, self._stated, self._paths = purpose, stated, stated.paths

    def shared(self, table: Table, *, is_alone: bool) -> StatedSetup:
        """Return what is stated for all set-ups; it may be the only one."""
        needs_machine = is_alone and not self._is_elsewhere("machine")
        values = {each.name: self._value(table, each, is_needed=needs_machine) for each in STATED}
        return self._with_post(table, self._judged(table, values, values), None)

    def alone(self, table: Table, shared: StatedSetup) -> ReadSetup:
        """Return the only set-up, which is stated at the top of the file."""
        return self._setup(table, shared, "", None)

    def one(self, table: Table, shared: StatedSetup) -> ReadSetup:
        """Return one of several set-ups."""
        name = table.text("name", f"set-up {_number(table)}")
        own = {each.name: self._value(table, each) for each in STATED if each.key in table}
        values = {**shared.values, **own}
        if "part" not in own and _number(table) > 1:
            values["part"] = None  # it is where the last set-up's part lies now
        stated = self._with_post(table, self._judged(table, values, own), shared)
        pose = self._pose(table) if "pose" in table else None
        if not values["machine"] and not self._is_elsewhere("machine") and "machine" not in table:
            table.add_problem("machine", Wording("DEF330", "no_machine"))
        found = self._setup(table, stated, name, pose)
        table.report_unread_keys()
        return found

    def _is_elsewhere(self, *names: str) -> bool:
        """Whether one of some arguments is given otherwise."""
        return bool({*names} & {*self._purpose.elsewhere})

    def _value(self, table: Table, option: Option, *, is_needed: bool = False) -> Any:
        """Return what a table states of an option; only a machine may be needed."""
        if option.name == "machine":
            return self._stated.machine(table, option.key, required=is_needed)
        return self._stated.value(table, option)

    def _judged(self, table: Table, values: Mapping[str, Any], own: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the values, of which what this table states itself is tried: mistakes are told with all others."""
        if not values["tool_libraries"] and not self._is_elsewhere("tools", "tool_libraries"):
            for tool in own.get("tools", ()):  # libraries may have diameters that the texts leave out
                try_value(table, parse_tool, tool)
        offset, machine = own.get("work_offset"), values["machine"]
        if offset is not None and machine and not self._is_elsewhere("machine"):
            try_value(table, lambda: work_offset_setting(offset, as_machine(machine)))
        return values

    def _with_post(self, table: Table, values: Mapping[str, Any], shared: StatedSetup | None) -> StatedSetup:
        """Return the values with how they are posted, as far as set-ups may share it."""
        settings, setting_places = read_settings(table)
        places = places_of(table)
        if shared is None:
            return StatedSetup(values, places, _division(table), settings, setting_places)
        return StatedSetup(
            values,
            {**shared.places, **places},
            _division(table) if "divide" in table else shared.division,
            {**shared.settings, **settings},
            {**shared.setting_places, **setting_places},
        )

    def _setup(self, table: Table, stated: StatedSetup, name: str, pose: Pose | None) -> ReadSetup:
        """Return a set-up with its programs, which exist or are posted."""
        output = self._paths.output(table, "output")
        released, papers = self._paths.files(table, "released"), self._papers(table, output)
        posted: PostedSetup | None = None
        if output is None:
            programs = self._existing_programs(table, stated)
        else:
            self._check_post(table, stated, output, papers)
            programs = (str(output),)
            posted = replace(
                _posted(stated, name, output, released, papers), files=_places_of_files(table, output, papers)
            )
        values = {each.name: stated.values[each.name] for each in OF_SETUP}
        values["radius_register"] = values["radius_register"] or stated.settings.get(RADIUS_REGISTER_SETTING)
        known = (*CL_SETTINGS, FRAME_SETTING)
        values["settings"] = {key: value for key, value in stated.settings.items() if key in known}
        return ReadSetup(SetupInput(programs, name=name, pose=pose, places=stated.places, **values), posted)

    def _existing_programs(self, table: Table, stated: StatedSetup) -> tuple[str, ...]:
        """Return the programs of a set-up in which nothing is posted; given elsewhere they need not be there."""
        for key in ("released", *PAPERS):
            if key in table:
                table.add_problem(key, Wording("DEF330", "of_posted_program"))
        if self._purpose.is_posted and "programs" not in table and (stated.values["cl"] or "cl" in table):
            table.add_problem("output", Wording("DEF330", "output_missing"))
            return ()
        if self._is_elsewhere("nc"):
            table.texts("programs", ())
            return ()
        return self._paths.files(table, "programs", required="output" not in table)

    def _check_post(self, table: Table, stated: StatedSetup, output: Path, papers: PaperFiles) -> None:
        """Note what does not go together where a program is posted."""
        if "programs" in table:
            table.add_problem("programs", Wording("DEF330", "beside_output"))
            table.mark_read("programs")
        if not stated.values["cl"] and "cl" not in table:
            table.add_problem("cl", Wording("DEF330", "cl_missing"))
        for name in papers.by_name() if stated.division is Division.OPERATIONS else ():
            table.add_problem(name, Wording("DEF330", "one_paper_of_operations", paper=PAPERS[name]))
        if not self._purpose.is_posted and not self._is_elsewhere("nc"):
            self._check_is_there(table, output, stated.division)

    def _check_is_there(self, table: Table, output: Path, division: Division) -> None:
        """Note where programs that a project posts cannot be simulated as they lie there."""
        if division is not Division.ONE:
            table.add_problem("output", Wording("DEF330", "becomes_several_files"))
        elif not is_file(output):
            names = {"name": table.text("output"), "project": self._purpose.path.name}
            table.add_problem("output", Wording("DEF330", "not_posted_yet", **names))

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
                first = error.problems[0]
                table.add_problem(name, first.wording.within("names_file", file=first.file))
        return PaperFiles(**named)

    def _pose(self, table: Table) -> Pose:
        pose = table.table("pose")
        x, y, z = pose.vector("origin_mm", 3, (0.0, 0.0, 0.0))
        a, b, c = pose.vector("turn_deg", 3, (0.0, 0.0, 0.0))
        pose.report_unread_keys()
        return Pose((x, y, z), (a, b, c))


def _posted(stated: StatedSetup, name: str, output: Path, released: tuple[str, ...], papers: PaperFiles) -> PostedSetup:
    """Return how a set-up is posted."""
    values = stated.values
    arguments = {each.name: values[each.name] for each in POSTED}
    return PostedSetup(
        name, values["cl"], values["machine"], output, stated.division, stated.settings, released, arguments, papers,
        stated.setting_places,
    )  # fmt: skip


def _places_of_files(table: Table, output: Path, papers: PaperFiles) -> Places:
    """Where a table names the files that are written."""
    keys = {"output": output, **papers.by_name()}
    return {str(file): (*table.location(key), table.key_path(key)) for key, file in keys.items()}


def _division(table: Table) -> Division:
    return Division(table.text("divide", Division.ONE, one_of=tuple(Division)))


def try_value(table: Table, check: Callable[..., object], *values: object) -> None:
    """Note what cannot be used of a value, so that it is told with all other mistakes."""
    try:
        check(*values)
    except InputError as error:
        table.problems.extend(with_place(problem, places_of(table)) for problem in error.problems)


def places_of(table: Table) -> dict[str, tuple[str, int, str]]:
    """File, line and key of each argument that a table states."""
    return {argument: (*table.location(key), table.key_path(key)) for argument, key in KEYS.items() if key in table}


def _number(table: Table) -> int:
    """Return the number of a set-up, from 1."""
    return int(table.path.rpartition("[")[2].rstrip("]")) + 1
