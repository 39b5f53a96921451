"""Bodies that jobs are given: meshes with their names, and tools from texts, libraries and CL files."""

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, TypeAlias

from trunnion.errors import InputError, Problem
from trunnion.jobs.inputs.arguments import check_choice, check_path, check_paths, wrong_argument
from trunnion.jobs.inputs.reading import FilePath
from trunnion.messages import phrase
from trunnion.model.toolpath import Toolpath
from trunnion.records import dataclass
from trunnion.simulation.fixtures import is_stated_fixture, stated_fixture
from trunnion.simulation.meshes import DEVIATION, TriangleMesh, load_mesh
from trunnion.simulation.tools.choice import ClTool, choose_tools, tools_of_toolpaths
from trunnion.simulation.tools.library import ToolLibrary, read_tools
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.text import parse_tool

MeshLike: TypeAlias = str | Path | TriangleMesh


def listed(name: str, values: Any, record: type) -> list[Any]:
    """One or several texts, paths or records; errors name the argument."""
    single = (str, os.PathLike, record)
    if isinstance(values, single):
        return [values]
    found = list(values) if isinstance(values, Iterable) else [None]
    if not all(isinstance(value, single) for value in found):
        raise wrong_argument(name, values, phrase("give_bodies", type=record.__name__))
    return found


def read_mesh(mesh: MeshLike, name: str, remarks: list[Problem], deviation: float = DEVIATION) -> TriangleMesh:
    """Return a mesh as it is given, or of a file, with its name; remarks get what is odd about it."""
    if isinstance(mesh, TriangleMesh):
        return mesh.named(name)
    check_path(name, mesh)
    return load_mesh(mesh, name=name, closed=True, deviation=deviation, warn=remarks.append)


def fixture_files(fixtures: Any) -> list[FilePath]:
    """Return the files among fixtures: neither meshes as they are nor texts of sizes."""
    given = listed("fixtures", fixtures, TriangleMesh)
    return [each for each in given if not isinstance(each, TriangleMesh) and not is_stated_fixture(str(each))]


def fixture_meshes(fixtures: Any, remarks: list[Problem], deviation: float = DEVIATION) -> tuple[TriangleMesh, ...]:
    """Return the meshes of fixtures, with what findings call them: by file or kind, and by their numbers where these
    are the same or there is none.
    """
    given: list[MeshLike] = listed("fixtures", fixtures, TriangleMesh)
    pieces = [_fixture_pieces(fixture, remarks, deviation) for fixture in given]
    firsts = [meshes[0].name for meshes in pieces]
    return tuple(
        mesh.named(
            f"fixture {mesh.name}" if mesh.name and firsts.count(first) == 1 else f"fixture {k} {mesh.name}".rstrip()
        )
        for k, (first, meshes) in enumerate(zip(firsts, pieces, strict=True), 1)
        for mesh in meshes
    )


def _fixture_pieces(fixture: MeshLike, remarks: list[Problem], deviation: float) -> list[TriangleMesh]:
    if isinstance(fixture, TriangleMesh):
        return [fixture.named("")]
    if is_stated_fixture(str(fixture)):
        return stated_fixture(str(fixture))
    return [read_mesh(fixture, Path(fixture).name, remarks, deviation)]


@dataclass(frozen=True, slots=True, eq=False)
class KnownTools:
    """The tools of which something says the form: stated ones, those of libraries, and those of CL files."""

    stated: Sequence[ToolShape]
    libraries: Sequence[ToolLibrary]
    of_cl_files: Sequence[ClTool]

    def choose(self, called: Iterable[str]) -> dict[str, ToolShape]:
        """Return the body of each tool that a program calls, by the word of the program.

        Raises ``InputError`` if nothing describes a tool, or nothing settles its form; with all of them.
        """
        return choose_tools(called, self.stated, self.libraries, self.of_cl_files)

    def find(self, called: str) -> ToolShape | None:
        """Return the body of a tool; None if nothing describes it.

        Raises ``InputError`` if it is stated twice.
        """
        try:
            return self.choose([called]).get(called)
        except InputError as error:
            if any(problem.code != "SIM150" for problem in error.problems):
                raise
            return None


def known_tools(
    tools: Any, libraries: Sequence[FilePath], unit: str | None, toolpaths: Iterable[Toolpath]
) -> KnownTools:
    """Read tools that are stated, and libraries, in ``unit`` where a library states none.

    Raises ``InputError`` if a text is no tool, or a library cannot be used.
    """
    if unit is not None:
        check_choice("unit", unit, ("mm", "inch"))
    read = [read_tools(path, unit or "") for path in check_paths("tool_libraries", libraries)]
    diameters = {number: wide for library in reversed(read) for number, wide in library.diameters.items()}
    given = listed("tools", tools, ToolShape)
    stated = [tool if isinstance(tool, ToolShape) else parse_tool(tool, diameters) for tool in given]
    return KnownTools(stated, read, tools_of_toolpaths(toolpaths))
