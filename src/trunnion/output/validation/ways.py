"""Ways between operations that are not those that the settings ask for."""

from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.output.passages import Passage, Passages
from trunnion.output.program import Program
from trunnion.output.tool_calls import ToolCalls


def way_problems(program: Program, *, subprograms: bool) -> list[Problem]:
    """Warn of operations between which the tool goes home or retracts, though the setting asks for a shorter way.

    subprograms  each operation is one of its own
    """
    problems = []
    for before, motion, way in Passages(program, ToolCalls(program), subprograms=subprograms).ways():
        if way.hindrance is None:
            continue
        operation = motion.operation
        wording = Wording(
            "CTL458",
            "goes_home" if way.passage is Passage.HOME else "retracts",
            asked=program.effective_setting("same_tool", before.operation),
            before=before.operation.name,
            operation=operation.name,
            why=way.hindrance,
        )
        problems.append(warning(program.file_of(operation), operation.line, wording))
    return problems
