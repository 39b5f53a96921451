"""The guard of files: no command writes over a file that it reads, and no two of its outputs are one file.

In:     what a command was given, and the kinds of its options: they say which files are read, to which others these
        lead, and which are written.
Out:    the files that are read; or an ``InputError``, before any work.

What knows to which files a kind of file leads is imported for the first such file: a post of CL files has no project,
no mesh and no manifest.
"""

import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, Final

from trunnion.controls.definition_files import is_control_file, load_control_table
from trunnion.controls.loading import shipped_controls
from trunnion.errors import InputError, argument_problem
from trunnion.files import check_outputs, resolve_output
from trunnion.jobs.inputs.input_files import definition_files, machine_files
from trunnion.jobs.inputs.reading import FilePath, load_machine
from trunnion.jobs.job import STDIN, Given
from trunnion.jobs.result_output import check_output_name
from trunnion.messages import Wording
from trunnion.options.kinds import FileIn, FileOut
from trunnion.options.option import Option, outputs

#: What stands for stdout.
_STDOUT: Final = "-"


def guard(given: Given) -> list[FilePath]:
    """Return the files that a command reads, once it is known that it may write what it is to write.

    Raises ``InputError`` if an output is one of them, or another output by whatever name, has an ending that says
    another form, or cannot be written; or if two outputs go to stdout.
    """
    named = [(each, given.values[each.name]) for each in outputs(given.job.options)]
    written = [(option, file) for option, file in named if file is not None and not _takes_folder(option, file)]
    streams = [option for option, file in written if file == _STDOUT]
    if len(streams) > 1:
        raise InputError(argument_problem(streams[0].name, Wording("ARG140", "two_to_stdout", other=streams[1].name)))
    files = [(option, file) for option, file in written if file != _STDOUT]
    if not files:
        return []
    read = list(files_read(given))
    check_outputs([file for _, file in files], read)
    check_names(given)
    return read


def check_names(given: Given) -> None:
    """Refuse an output whose name ends as something else does than what is written.

    Raises ``InputError`` for the first one.
    """
    for option in outputs(given.job.options):
        file = given.values[option.name]
        if file is not None and file != _STDOUT and not _takes_folder(option, file):
            _check_name(option, file)


def files_read(given: Given) -> Iterator[FilePath]:
    """Yield the files that a command reads, with all to which they lead.

    Raises ``InputError`` if one of them leads to others, and cannot be read.
    """
    for option in given.job.options:
        if not isinstance(option.kind, FileIn):
            continue
        value = given.values[option.name]
        files = value if isinstance(value, list) else [] if value in (None, "") else [value]
        yield from LEADS[option.kind.leads]([file for file in files if file != STDIN])


def _takes_folder(option: Option, file: str) -> bool:
    """Whether an output is a folder, in which the command names files itself."""
    assert isinstance(option.kind, FileOut)
    if not option.kind.folder:
        return False
    is_new = not Path(file).suffix and not Path(file).exists() and file != _STDOUT
    return is_new or file.endswith(("/", os.sep)) or Path(file).is_dir()


def _check_name(option: Option, file: str) -> None:
    """Refuse a name whose ending says another form than is written."""
    kind = option.kind
    assert isinstance(kind, FileOut)
    if kind.form == "mesh":
        from trunnion.simulation.meshes.writing import check_mesh_name

        check_mesh_name(file)
    if kind.endings and not (len(kind.endings) == 1 and resolve_output(file).is_stream):
        check_output_name(option.name, file, kind.endings, kind.why)


def _of_machines(names: Iterable[str]) -> Iterator[FilePath]:
    for name in names:
        yield from machine_files(name, load_machine(name))


def _of_list(lists: Iterable[str]) -> Iterator[FilePath]:
    """Definitions in lists with commas: those that are files, with all that they extend."""
    for name in (name.strip() for each in lists for name in each.split(",")):
        if name.endswith(".toml"):
            yield name
            if Path(name).is_file():
                yield from definition_files(name, load_machine(name))


def _of_definitions(names: Iterable[str]) -> Iterator[FilePath]:
    """Definitions of machines or controls."""
    for name in names:
        if name in shipped_controls() or is_control_file(Path(name)):
            yield from [name, *load_control_table(name).files()]
        else:
            yield from _of_machines([name])


def _of_projects(names: Iterable[str]) -> list[FilePath]:
    if not (files := list(names)):
        return []
    from trunnion.jobs.project.named_files import project_files

    return [*files, *project_files(files, ("machine", "stock"))]


def _of_posted(names: Iterable[str]) -> Iterator[FilePath]:
    """CL files, programs, and projects whose programs need not be there yet."""
    for name in names:
        yield name
        if name.endswith(".toml"):
            from trunnion.jobs.project.file import load_project
            from trunnion.jobs.project.named_files import project_inputs

            project = load_project(Path(name))
            yield from [*project_inputs(project), *(setup.output for setup in project.setups)]


def _of_stocks(names: Iterable[str]) -> Iterator[FilePath]:
    for name in names:
        from trunnion.simulation.stock.solids import is_mesh

        if is_mesh(name):
            yield name


def _of_fixtures(names: Iterable[str]) -> Iterator[FilePath]:
    for name in names:
        from trunnion.simulation.fixtures import is_stated_fixture

        if not is_stated_fixture(name):
            yield name


def _of_libraries(names: Iterable[str]) -> Iterator[FilePath]:
    for name in names:
        from trunnion.jobs.project.named_files import library_files

        yield from library_files([name])


def _of_impellers(names: Iterable[str]) -> Iterator[FilePath]:
    for name in names:
        from trunnion.impeller.definition import read_impeller

        yield from [name, *read_impeller(Path(name)).files]


def _of_manifests(names: Iterable[str]) -> Iterator[FilePath]:
    """Programs, and manifests with the files beside them that they list."""
    for name in names:
        yield name
        if name.endswith(".json"):
            from trunnion.jobs.post.papers.manifests import files_of_manifest

            yield from files_of_manifest(name)


def _named(names: Iterable[str]) -> Iterator[FilePath]:
    """Names of shipped lists, or files."""
    yield from (name for name in names if Path(name).suffix)


#: What a kind of file leads to: the files themselves, and those that they name.
LEADS: Final[dict[str, Callable[[list[Any]], Iterable[FilePath]]]] = {
    "": lambda files: files,
    "machine": _of_machines,
    "machines": _of_list,
    "definition": _of_definitions,
    "library": _of_libraries,
    "project": _of_projects,
    "posted": _of_posted,
    "stock": _of_stocks,
    "fixture": _of_fixtures,
    "impeller": _of_impellers,
    "manifest": _of_manifests,
    "jobs": _named,
    "named": _named,
}
