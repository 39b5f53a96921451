"""What a tool library holds: tools with their sizes, and those that cannot be made a body, with the reason."""

from collections.abc import Mapping
from dataclasses import field, replace

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.shapes import tool_shape
from trunnion.simulation.tools.sizes import ToolSizes


@dataclass(frozen=True, slots=True)
class LibraryTool:
    """A tool of a library, whose sizes have no fault; its body is made when a program calls it.

    number   by which programs call it; None if it has none
    remarks  what was taken for granted besides what ``ToolShape.remarks`` says
    """

    sizes: ToolSizes
    number: int | None = None
    name: str = ""
    description: str = ""
    remarks: tuple[Wording, ...] = ()

    def shape(self) -> ToolShape:
        """Return its body."""
        found = tool_shape(self.sizes, self.number, self.name, self.description)
        return replace(found, remarks=(*found.remarks, *self.remarks))


@dataclass(frozen=True, slots=True)
class UnusableTool:
    """A tool of a library that has no body here: its kind is not known, or its sizes are impossible.

    number    by which programs call it; None if it has none
    problems  why, with the file
    """

    number: int | None
    name: str
    problems: tuple[Problem, ...]


@dataclass(frozen=True, slots=True)
class ToolLibrary:
    """The tools of a file.

    unusable   is no mistake until a program calls one of them
    diameters  of tools by their number, mm, of which nothing else is known
    """

    file: str
    tools: tuple[LibraryTool, ...] = ()
    unusable: tuple[UnusableTool, ...] = ()
    diameters: Mapping[int, float] = field(default_factory=dict)

    def find(self, number: int | None = None, name: str = "") -> ToolShape | None:
        """Return the body of the tool of a number, or if there is none, of a name; None if there is none of both.

        Raises ``InputError`` if there are several, or one that has no body.
        """
        for called, what in ((number, "number"), (name or None, "name")):
            if called is None:
                continue
            found = [tool for tool in self.tools if getattr(tool, what) == called]
            unusable = [tool for tool in self.unusable if getattr(tool, what) == called]
            if unusable:
                raise InputError(unusable[0].problems)
            if len(found) > 1:
                raise InputError(
                    Problem(
                        self.file,
                        0,
                        Wording(
                            "SIM173",
                            "tools_have",
                            count=len(found),
                            subject=what,
                            called=called,
                            fromkeys=tuple(dict.fromkeys(tool.name or str(tool.number) for tool in found)),
                        ),
                    )
                )
            if found:
                return found[0].shape()
        return None

    def tool(self, number: int | None = None, name: str = "") -> ToolShape:
        """Return the body of the tool of a number, or if there is none, of a name.

        Raises ``InputError`` if there is none, or several, or one that has no body.
        """
        found = self.find(number, name)
        if found is not None:
            return found
        raise InputError(
            Problem(
                self.file,
                0,
                Wording("SIM173", "no_tool_number", number=number)
                if number is not None
                else Wording("SIM173", "no_tool_name", name=name),
            )
        )
