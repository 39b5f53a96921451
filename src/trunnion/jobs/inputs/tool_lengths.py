"""Lengths of tools where nobody states one for all of them: those of tool libraries and of CL files.

In:     a machine with the lengths that are stated, tools, and CL files.
Out:    the machine with a length for each tool that something else knows, and what knows it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from trunnion.errors import InputError
from trunnion.jobs.inputs.reading import FilePath
from trunnion.machines import Machine
from trunnion.machines.machine import tool_key
from trunnion.model.toolpath import LoadTool, Operation, Toolpath

if TYPE_CHECKING:  # few runs have tools with bodies
    from trunnion.jobs.inputs.bodies import KnownTools

#: What a length comes from, as results say it.
OF_CL_FILE: Final = "CL file"


def with_lengths_of_tools(
    machine: Machine, toolpaths: Sequence[Toolpath], tools: "KnownTools | None" = None
) -> Machine:
    """Return the machine with the lengths of tools, libraries and CL files, in that order, of tools that have none."""
    if machine.tool_length is not None:
        return machine
    lengths, sources = dict(machine.tool_lengths), dict(machine.length_sources)
    for name, length, source in (*_of_bodies(tools), *_of_cl_files(toolpaths)):
        if tool_key(name) not in lengths:
            lengths[tool_key(name)], sources[tool_key(name)] = length, source
    if len(lengths) == len(machine.tool_lengths):
        return machine
    return replace(machine, tool_lengths=lengths, length_sources=sources)


def library_tools(libraries: Sequence[FilePath], unit: str | None) -> "KnownTools | None":
    """Return the tools of libraries; None without one.

    Raises ``InputError`` if a library cannot be used.
    """
    if not libraries:
        return None
    from trunnion.jobs.inputs.bodies import known_tools

    return known_tools((), libraries, unit, ())


def called_tools(toolpaths: Sequence[Toolpath]) -> Iterator[tuple[Operation, list[str]]]:
    """Yield the operations, each with the number and the name of the tool that it works with."""
    number = ""
    for toolpath in toolpaths:
        for operation in toolpath.operations:
            loads = [event.number for event in operation.events if isinstance(event, LoadTool)]
            number = str(loads[-1]) if loads else number
            yield operation, [name for name in (number, operation.tool.name) if name]


def _of_bodies(tools: "KnownTools | None") -> Iterator[tuple[str, float, str]]:
    if tools is None:
        return
    for shape in tools.stated:
        if shape.length:
            yield shape.name if shape.number is None else str(shape.number), shape.length, "stated tool"
    for library in tools.libraries:
        for tool in library.tools:
            try:
                length = tool.shape().length
            except InputError:  # it has no body, which is no mistake until a program is simulated
                continue
            for name in (tool.number, tool.name):
                if length and name not in (None, ""):
                    yield str(name), length, library.file


def _of_cl_files(toolpaths: Sequence[Toolpath]) -> Iterator[tuple[str, float, str]]:
    """Yield the tools of which CL files state one length, and always the same."""
    found: dict[str, set[float]] = {}
    for operation, names in called_tools(toolpaths):
        for name in names if len(operation.moves) else ():
            found.setdefault(name, set()).add(operation.tool.set_length)
    for name, lengths in found.items():
        if len(lengths) == 1 and 0.0 not in lengths:
            yield name, max(lengths), OF_CL_FILE
