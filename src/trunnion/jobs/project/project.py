"""A project: set-ups of a part with what is posted, simulated and checked in each, as its file states them."""

from collections.abc import Mapping
from dataclasses import field, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

from trunnion.jobs.inputs.settings import SettingValue
from trunnion.jobs.inputs.simulation_input import Places, SimulationInput
from trunnion.jobs.result_output import NO_PAPERS, PaperFiles
from trunnion.records import dataclass


class Judgement(StrEnum):
    """What becomes of a project when a check after the posts finds something."""

    OFF = "off"
    WARN = "warn"
    REFUSE = "refuse"


class Division(StrEnum):
    """Into which files the CL files of a set-up are posted.

    ONE         one program with all operations
    SUBPROGRAMS  a main program that calls a subprogram for each operation
    OPERATIONS  a program for each operation
    """

    ONE = "one"
    SUBPROGRAMS = "subprograms"
    OPERATIONS = "operations"


@dataclass(frozen=True, slots=True, eq=False)
class PostedSetup:
    """What is posted in a set-up.

    name         for messages; empty where there is one set-up only
    cl           CL files in their order
    machine      name of a shipped machine, or path of a definition
    output       file of the program; of a program for each operation, what their names begin with
    division     into which files
    settings     by their names, as ``trunnion.post`` takes them
    released     earlier programs that the new ones must move like; subprograms of one stand behind it
    arguments    of ``trunnion.post``, by their names: those of its other options that a set-up states
    papers       files of its report, setup sheet, listing and manifest
    places       where the project states settings: file, line and key, by their names; ``settings`` of all others
    files        where it names what is written, by that
    """

    name: str
    cl: tuple[str, ...]
    machine: str
    output: Path
    division: Division = Division.ONE
    settings: Mapping[str, SettingValue] = field(default_factory=dict)
    released: tuple[str, ...] = ()
    arguments: Mapping[str, Any] = field(default_factory=dict)
    papers: PaperFiles = NO_PAPERS
    places: Places = field(default_factory=dict)
    files: Places = field(default_factory=dict)

    @property
    def subprograms(self) -> tuple[str, ...]:
        """Files that exist already and that templates call."""
        return tuple(self.arguments.get("subprograms", ()))

    @property
    def angles(self) -> tuple[float | None, float | None]:
        """Turn and tilt of the part as it is clamped, degrees; None: as it is drawn."""
        return self.arguments.get("turn"), self.arguments.get("tilt")


@dataclass(frozen=True, slots=True)
class ProjectChecks:
    """What is judged once everything is posted and proven.

    simulate   what the simulation of all set-ups finds
    released   what moves otherwise than in the released programs
    longest_s  time that a program may take, s; None: any
    """

    simulate: Judgement = Judgement.OFF
    released: Judgement = Judgement.WARN
    longest_s: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Project:
    """A project.

    path        of its file
    simulation  all set-ups as they are simulated; programs that are posted are named by their outputs
    posted      what is posted in each of them; None: its programs exist already
    checks      what is judged after the posts
    hooks       files of hooks, in their order
    strict      unknown CL statements are errors
    files       of the project itself, and of what it extends
    into        folder that takes its programs, as they lie in its own; None: that is it
    """

    path: Path
    simulation: SimulationInput
    posted: tuple[PostedSetup | None, ...]
    checks: ProjectChecks = ProjectChecks()
    hooks: tuple[str, ...] = ()
    strict: bool = False
    files: tuple[str, ...] = ()
    into: Path | None = None

    @property
    def folder(self) -> Path:
        """The folder that holds all of its files."""
        return self.path.parent

    @property
    def setups(self) -> list[PostedSetup]:
        """Those in which something is posted."""
        return [each for each in self.posted if each is not None]

    def place_of(self, output: Path) -> Path:
        """Where a file that is written lies in the project's own folder."""
        return output if self.into is None else self.folder / output.relative_to(self.into)

    def writing_to(self, folder: Path) -> "Project":
        """Return the same project with all that it writes in another folder, where it lies as in its own."""

        def moved(file: Path) -> Path:
            return folder / file.relative_to(self.folder)

        posted = [
            each
            and replace(
                each,
                output=moved(each.output),
                papers=PaperFiles(**{name: moved(paper) for name, paper in each.papers.by_name().items()}),
            )
            for each in self.posted
        ]
        return replace(self, posted=tuple(posted), into=folder)
