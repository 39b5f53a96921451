"""The body of each tool that a program calls: from what is stated for the run, tool libraries, and CL files.

In:     the names of ``Run.tools``, stated tools, libraries and the tools of CL files, each of which may be empty.
Out:    a ``ToolShape`` for each name. No tool is guessed: those that nothing describes are told, all at once.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Final, NamedTuple

from trunnion.errors import InputError, Problem, argument_problem
from trunnion.messages import Wording
from trunnion.model.toolpath import LoadTool, Tool, Toolpath
from trunnion.simulation.tools.cl_tools import cl_tool_shape
from trunnion.simulation.tools.library import ToolLibrary
from trunnion.simulation.tools.profile import ToolShape

#: The number of the tool with which a program cuts that calls none.
NO_CALL: Final = "0"


class ClTool(NamedTuple):
    """A tool of a CL file: the number by which it is called, None if by name, its description, and where that is."""

    number: int | None
    tool: Tool
    file: str
    line: int
    dialect: str


def tools_of_toolpaths(toolpaths: Iterable[Toolpath]) -> tuple[ClTool, ...]:
    """Return the tools that CL files describe, each once, in the order of their operations."""
    return tuple(dict.fromkeys(_tools_of_toolpaths(toolpaths)))


def _tools_of_toolpaths(toolpaths: Iterable[Toolpath]) -> Iterator[ClTool]:
    number: int | None = None
    for toolpath in toolpaths:
        for operation in toolpath.operations:
            loads = [event.number for event in operation.events if isinstance(event, LoadTool)]
            number = loads[-1] if loads else number
            yield ClTool(number, operation.tool, operation.file or toolpath.file, operation.line, toolpath.dialect)


def choose_tools(
    called: Iterable[str],
    stated: Sequence[ToolShape] = (),
    libraries: Sequence[ToolLibrary] = (),
    cl_tools: Sequence[ClTool] = (),
) -> dict[str, ToolShape]:
    """Return the body of each tool that a program calls, by the word of the program.

    called     numbers and names as programs write them; the empty name is no tool
    stated     tools that were stated for this run; they come first
    libraries  in their order
    cl_tools   tools of the CL files, where nothing else has one

    Raises ``InputError`` if nothing describes a tool, or nothing settles its form; with all of them.
    """
    sources: tuple[Callable[[int | None, str], ToolShape | None], ...] = (
        lambda number, name: _stated(stated, number, name),
        *(library.find for library in libraries),
        lambda number, name: _of_cl_files(cl_tools, number, name),
    )
    found: dict[str, ToolShape] = {}
    problems: list[Problem] = []
    for word in dict.fromkeys(called):
        if not word:
            continue
        number = int(word) if word.isascii() and word.isdecimal() else None
        try:
            shapes = (source(number, "" if number is not None else word) for source in sources)
            shape = next((shape for shape in shapes if shape is not None), None)
        except InputError as error:
            problems += error.problems
            continue
        if shape is None:
            problems.append(_nothing_describes(word, number, libraries))
        else:
            found[word] = shape
    if problems:
        raise InputError(dict.fromkeys(problems))
    return found


def _nothing_describes(word: str, number: int | None, libraries: Sequence[ToolLibrary]) -> Problem:
    diameters: Mapping[str, float] = {
        library.file: library.diameters[number]
        for library in libraries
        if number is not None and number in library.diameters
    }
    for file, diameter in diameters.items():
        return Problem(file, 0, Wording("SIM150", "tool_diameter_mm", word=word, diameter=diameter))
    return argument_problem("tools", Wording("SIM150", "nothing_says_form", word=word))


def _stated(stated: Sequence[ToolShape], number: int | None, name: str) -> ToolShape | None:
    same = [shape for shape in stated if (shape.number == number if number is not None else shape.name == name)]
    if len(same) > 1:
        raise InputError(
            argument_problem(
                "tools",
                Wording("SIM151", "tool_stated_times", name=name if number is None else number, count=len(same)),
            )
        )
    return same[0] if same else None


def _of_cl_files(cl_tools: Sequence[ClTool], number: int | None, name: str) -> ToolShape | None:
    """Return the tool of CL files; several of one number or name must be one form."""
    same = [each for each in cl_tools if (each.number == number if number is not None else each.tool.name == name)]
    shapes = [cl_tool_shape(each.tool, number, file=each.file, line=each.line, dialect=each.dialect) for each in same]
    for each, shape in zip(same, shapes, strict=True):
        if shape.sections != shapes[0].sections:
            raise InputError(
                Problem(
                    each.file,
                    each.line,
                    Wording(
                        "SIM151",
                        "tool_another_one",
                        name=name if number is None else number,
                        same_line=same[0].line,
                        same_file=same[0].file,
                    ),
                )
            )
    return shapes[0] if shapes else None
