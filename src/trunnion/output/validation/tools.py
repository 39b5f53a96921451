"""Operations that call one tool although their CL data describe several."""

from collections.abc import Iterator, Sequence

from trunnion.controls.setting_rules import tool_number
from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.model.tool_faults import tool_differences
from trunnion.model.toolpath import LoadTool, Operation
from trunnion.output.compensation_entries import entries_of, motions_by_operation
from trunnion.output.program import Program
from trunnion.output.tool_calls import ToolCalls, edge_setting


def tool_conflicts(program: Program, *, uses_length_numbers: bool) -> list[Problem]:
    """Return errors where operations call one tool and state different ones; warnings where only the names differ.

    The operator puts one cutter under a number or a name: the program would run with it in both operations.

    program              tools of it can be called: it has passed ``check_program``
    uses_length_numbers  the program selects tool lengths by registers: two tools may not have the same one

    Raises ``InputError`` if an operation has nothing to call its tool by.
    """
    problems: list[Problem] = []
    known: dict[str, list[Operation]] = {}
    registers: dict[int, str] = {}
    calls = ToolCalls(program).calls
    for call, register, operation in calls:
        file = program.file_of(operation)
        other = registers.setdefault(register or tool_number(call) or 0, call)
        if uses_length_numbers and other != call:
            problems.append(
                Problem(
                    file,
                    operation.line,
                    Wording(
                        "CTL710",
                        "tool_operation_length",
                        call=call,
                        operation=operation.name,
                        register=register or call,
                        other=other,
                    ),
                )
            )
        loads = [event for event in operation.events if isinstance(event, LoadTool)]
        if not uses_length_numbers and loads and register not in (0, loads[-1].number):
            problems += _lost_register(program, operation, loads[-1])
        before = known.setdefault(call, [])
        if operation.tool in (other.tool for other in before):
            continue
        problems += _conflict(call, before, operation, file)
        before.append(operation)
    return [*problems, *_shared_radius_registers(program, calls)]


def _shared_radius_registers(program: Program, calls: Sequence[tuple[str, int, Operation]]) -> Iterator[Problem]:
    """Yield errors for registers of the radius that hold that of another tool; warnings for those that hold the length
    of another, if both are in one table, as the setting suggests.
    """
    one_table = any(program.effective_setting("radius_offset", operation) not in ("", "0") for *_, operation in calls)
    lengths = {register or tool_number(call) or 0: call for call, register, _ in calls} if one_table else {}
    radii: dict[int, str] = {}
    for motions, (call, _, operation) in zip(motions_by_operation(program), calls, strict=True):
        for register in dict.fromkeys(entry.register for entry in entries_of(program, motions, call) if entry.register):
            other = radii.setdefault(register, call)
            variant = "tool_operation_radius"
            if other == call:
                other, variant = lengths.get(register, call), "tool_operation_table"
            if other != call:
                said = {"call": call, "operation": operation.name, "register": register, "other": other}
                place = program.file_of(operation), operation.line
                found = Problem(*place, Wording("CTL710", variant, **said))
                yield found if other == radii[register] else warning(*place, found.wording)


def _lost_register(program: Program, operation: Operation, load: LoadTool) -> Iterator[Problem]:
    """Yield a warning of a register for the length that the control does not take, nor the operation as its edge."""
    edge, said = edge_setting(program, operation, load.adjust), {"tool": load.number, "register": load.adjust}
    if edge == str(load.adjust):
        return
    wording = (
        Wording("CTL715", "length_is_that_of_edge", control=program.control.name, edge=edge, **said)
        if edge
        else Wording("CTL715", "length_is_that_of_tool", control=program.control.name, **said)
    )
    yield warning(program.file_of(operation), load.line, wording)


def _conflict(call: str, before: Sequence[Operation], operation: Operation, file: str) -> Iterator[Problem]:
    """Yield what an operation states of a tool otherwise than those before it that call it."""
    for other in before:
        differing = list(tool_differences(other.tool, operation.tool))
        if differing:
            yield Problem(
                file,
                operation.line,
                Wording(
                    "CTL710",
                    "operations_both_call",
                    other=other.name,
                    operation=operation.name,
                    call=call,
                    differing=tuple(differing),
                ),
            )
            return
    name = operation.tool.name
    named = next((other for other in before if other.tool.name and other.tool.name != name), None)
    if name and named is not None and all(other.tool.name != name for other in before):
        yield warning(
            file,
            operation.line,
            Wording(
                "CTL710",
                "tool_operation",
                call=call,
                tool=named.tool.name,
                named=named.name,
                name=name,
                operation=operation.name,
            ),
        )
