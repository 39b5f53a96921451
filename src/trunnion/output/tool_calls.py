"""How a program calls its tools, and their lengths."""

from functools import cached_property

from trunnion.controls.family_writer import FamilyWriter, UnsupportedFeatureError
from trunnion.controls.setting_rules import tool_number
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.model.toolpath import LoadTool, Operation, Tool
from trunnion.output.program import Program
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class LoadedTool:
    """The tool in the spindle: how the program called it, and its name; both empty before the first.

    register   the number of its length that LOAD/TOOL names; 0: that of the tool
    """

    call: str = ""
    name: str = ""
    register: int = 0


class ToolCalls:
    """The tools of a program as it calls them."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._family: FamilyWriter = program.control.family

    def call(self, operation: Operation, loaded: LoadedTool) -> str:
        """Return the tool as a tool change calls it: by the run's setting, the number of LOAD/TOOL, or else
        its name.
        """
        loads = [event for event in operation.events if isinstance(event, LoadTool)]
        number, name = self._program.effective_setting("tool", operation), operation.tool.name
        own = self._program.own_settings.get(operation.name, {}).get("tool")
        if own:
            return self._tool_setting(own, operation)
        if loaded.call and not loads and name == loaded.name:
            return loaded.call
        if name and (self._program.effective_setting("tool_call", operation) == "name" or not (number or loads)):
            return self._family_call(0, name, operation)
        if number:
            return self._tool_setting(number, operation)
        if loads:
            return self._family_call(loads[-1].number, "", operation)
        raise InputError(
            Problem(
                self._program.file_of(operation),
                operation.line,
                Wording("CTL145", "operation_no_load", operation=operation.name),
            )
        )

    @cached_property
    def calls(self) -> list[tuple[str, int, Operation]]:
        """The tool of each operation as the program calls it, and the register of its length, 0 for that of the tool.

        In the order of the program; errors as ``call``.
        """
        found: list[tuple[str, int, Operation]] = []
        loaded = LoadedTool()
        for motion in self._program.motions:
            if motion.starts_operation:
                operation = motion.operation
                register = self.length_register(operation, loaded)
                loaded = LoadedTool(self.call(operation, loaded), operation.tool.name, register)
                found.append((loaded.call, register, operation))
        return found

    def length_register(self, operation: Operation, loaded: LoadedTool) -> int:
        """Return the register of LOAD/TOOL for the length, 0 for that of the tool, as where the settings name
        the tool.
        """
        loads = [event for event in operation.events if isinstance(event, LoadTool)]
        if not loads:
            return loaded.register
        return 0 if self._program.effective_setting("tool", operation) else loads[-1].adjust

    def _tool_setting(self, text: str, operation: Operation) -> str:
        """Return the tool of the run's setting: a number as it is written, a name as the control takes names."""
        return text if tool_number(text) is not None else self._family_call(0, text.strip('"'), operation)

    def _family_call(self, number: int, name: str, operation: Operation) -> str:
        """Return a tool as the control's family calls it: by its name if there is one."""
        try:
            return self._family.tool_call(number, name, by_name=bool(name))
        except UnsupportedFeatureError as why:
            wording = why.wording.within("of", name=self._program.control.name)
            raise InputError(Problem(self._program.file_of(operation), operation.line, wording)) from None

    @cached_property
    def _next_calls(self) -> list[str | None]:
        """For each operation the next other tool after it, as the program calls it; None if there is none."""
        found: list[str | None] = []
        following: tuple[str, str | None] | None = None
        for call, *_ in reversed(self.calls):
            found.append(None if following is None else following[1] if following[0] == call else following[0])
            following = call, found[-1]
        return found[::-1]

    def next_call(self, operation: int) -> str | None:
        """Return the next other tool after an operation, by its number, as the program calls it; None if there
        is none.
        """
        return self._next_calls[operation - 1]


def edge_setting(program: Program, operation: Operation, register: int) -> str:
    """Return the cutting edge of an operation: ``register`` (ADJUST), where that is asked for, or the setting."""
    by_register = program.effective_setting("edge_from", operation) == "adjust" and register
    if by_register and program.control.setting_rule("edge").allows(str(register)):
        return str(register)
    return program.effective_setting("edge", operation)


def tool_text(call: str, tool: Tool, unit: float = 1.0) -> str:
    """Return a tool with its data, for the list of tools; ``unit`` is that of the program, mm."""
    known = tool.kind != "UNKNOWN"
    lengths = ("diameter", tool.diameter), ("corner", tool.corner_radius), ("length", tool.length)
    data = "".join(f", {what} {length / unit:g}" for what, length in lengths) if known else ""
    others = (
        ("upper corner", tool.upper_radius / unit),
        ("taper", tool.taper_angle),
        ("tip", tool.tip_angle),
        ("flute length", tool.flute_length / unit),
        ("stands out", tool.extension / unit),
        ("in the spindle", tool.set_length / unit),
    )
    data += "".join(f", {what} {value:g}" for what, value in others if value)
    holder = f", holder {tool.holder}" if tool.holder else ""
    name = f" {tool.name}" if tool.name and tool.name != call.strip('"') else ""
    return f"T{call}{name}{data}{holder}"
