"""Settings that a CL file leaves to be stated, of all its operations at once.

In:     what validation refuses.
Out:    one message with every setting that is missing, as it is written, to be copied and filled in.
"""

from collections.abc import Iterable, Sequence
from typing import Final

from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.output.program import Program

#: Messages that a setting of one operation ends; the setting, and what stands for its value.
_ENDED_BY: Final = {
    ("CTL130", "tools_called_number"): ("tool", "NUMBER"),
    ("CTL130", "tool_name_quotation"): ("tool", "NUMBER"),
    ("CTL145", "operation_no_load"): ("tool", "NUMBER"),
    ("CTL510", "operation_cuts_while"): ("spindle", "RPM"),
}

#: Signs by which the entries of a setting are told apart.
_PARTING: Final = frozenset(",:")


def settings_to_fill(errors: Iterable[Problem], program: Program) -> list[Problem]:
    """Return a message with the settings that are missing, where more than one is; else none."""
    lacking = {"tool": list[str](), "spindle": list[str]()}
    for error in errors:
        setting, value = _ENDED_BY.get((error.code, error.wording.variant), ("", ""))
        name = _operation_of(error, program)
        if setting and name and not _PARTING & set(name) and f"{name}:{value}" not in lacking[setting]:
            lacking[setting].append(f"{name}:{value}")
    if sum(map(len, lacking.values())) < 2:
        return []
    file = program.file
    tools, speeds = (",".join(lacking[name]) for name in ("tool", "spindle"))
    if tools and speeds:
        return [Problem(file, 0, Wording("CTL570", "tools_and_speeds", tools=tools, speeds=speeds))]
    if tools:
        return [Problem(file, 0, Wording("CTL570", "tools", tools=tools))]
    return [Problem(file, 0, Wording("CTL570", "speeds", speeds=speeds))]


def _operation_of(error: Problem, program: Program) -> str:
    """Return the name of the operation that an error is about; empty if it is not known."""
    stated = error.wording.parameter("operation")
    operations = [motion.operation for motion in program.motions if motion.starts_operation]
    at: Sequence[str] = [
        each.name for each in operations if (program.file_of(each), each.line) == (error.file, error.line)
    ]
    return str(stated) if stated else next(iter(at), "")
