"""The files that projects name, and those to which these lead: none of them may be written over."""

import os
from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TypeGuard

from trunnion.jobs.inputs.bodies import fixture_files, listed
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import FilePath, as_machine
from trunnion.jobs.inputs.simulation_input import SetupInput
from trunnion.jobs.project.file import is_project, read_whole
from trunnion.jobs.project.project import Project
from trunnion.model.toolpath import Toolpath
from trunnion.simulation.stock.solids import is_mesh
from trunnion.simulation.tools.library.toml_library import library_table


def project_files(given: Iterable[FilePath], elsewhere: Collection[str] = ()) -> list[FilePath]:
    """All files that the projects among some files name, none of which may be written over; the rest as for
    ``read_project``.

    Raises ``InputError`` if a project cannot be read.
    """
    projects = [
        read_whole(Path(each), ("machine", "stock", *elsewhere), is_posted=False)
        for each in given
        if is_project(Path(each))
    ]
    outputs = [str(setup.output) for each in projects for setup in each.setups]
    return [*outputs, *(name for each in projects for name in project_inputs(each))]


def project_inputs(project: Project) -> list[FilePath]:
    """All files that a project leads to and that are read, but for programs that it posts itself: those that it
    extends, those that it names, and what its machines and tool libraries lead to.

    Raises ``InputError`` if a machine or a library cannot be read.
    """
    setups = [
        replace(each, programs=() if posted else each.programs)
        for each, posted in zip(project.simulation.setups, project.posted, strict=True)
    ]
    released = [name for each in project.setups for name in each.released]
    named = [*project.files, *(name for each in setups for name in _named_files(each))]
    named += library_files(dict.fromkeys(file for each in setups for file in each.tool_libraries if _is_path(file)))
    for machine in dict.fromkeys(each.machine for each in setups if each.machine):
        named += machine_files(machine, as_machine(machine))
    stock = project.simulation.stock
    named += [stock] if isinstance(stock, str) and stock and is_mesh(stock) else []
    return [*named, *released, *project.hooks]


def library_files(libraries: Iterable[FilePath]) -> list[FilePath]:
    """Return the files of tool libraries, with all that those in TOML extend.

    Raises ``InputError`` if one in TOML cannot be read.
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
    fixtures = fixture_files(setup.fixtures)
    several: tuple[Iterable[object], ...] = setup.programs, setup.subprograms, fixtures, setup.tool_libraries
    for names in (*several, listed("cl", setup.cl, Toolpath), (setup.part or None,)):
        yield from (name for name in names if _is_path(name))


def _is_path(name: object) -> TypeGuard[FilePath]:
    return isinstance(name, str | os.PathLike)
