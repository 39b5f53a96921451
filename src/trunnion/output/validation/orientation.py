"""Tool vectors that could mislead the control, and surface normals that it cannot use."""

import numpy as np

from trunnion.errors import Problem, Severity
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Kind
from trunnion.output.coordinates.tool_vectors import first_row_at_other_pose
from trunnion.output.program import Program
from trunnion.wording import counted


def tool_vector_problems(program: Program, motion: Motion) -> list[Problem]:
    """Warn of an operation that is written with rotary words, though tool vectors are set."""
    if not program.control.uses_tool_vectors(program.settings):
        return []
    row = first_row_at_other_pose(program.machine, motion, program.block_words(motion))
    if row < 0:
        return []
    what = "for the tool's vector here the control could choose another rotary position than the planned one: operation"
    what = f"{what} {motion.operation.name} is written with rotary positions"
    cure = "no change is needed; orientation=angles writes all operations so"
    return [
        Problem(
            program.file_of(motion.operation),
            int(motion.operation.moves.line[row]),
            what,
            cure,
            Severity.WARNING,
            code="CTL560",
        )
    ]


def normal_problems(program: Program, motion: Motion) -> list[Problem]:
    """Return why an operation cannot have surface normals, and where it has none."""
    operation, problems = motion.operation, list[Problem]()
    moves = operation.moves
    if moves.normal is None or not np.isfinite(moves.normal).any():
        return []
    location, name = (program.file_of(operation), operation.line), operation.name
    if motion.mode is MachiningMode.WITHOUT_TCP:
        what = f"operation {name}: surface normals without TCP, where X, Y and Z are axis positions"
        problems.append(Problem(*location, what, "leave the setting normals out", code="CTL610"))
    if motion.mode is MachiningMode.TCP and program.effective_setting("orientation") != "vector":
        what = f"operation {name}: with TCP the control would align the tool with the surface normal"
        problems.append(
            Problem(*location, what, "setting orientation=vector writes the tool axis as well", code="CTL610")
        )
    if len(operation.arcs.row):
        what = "a circle, which can have no surface normal: the control would not compensate the tool there"
        problems.append(
            Problem(
                program.file_of(operation),
                int(moves.line[operation.arcs.row[0]]),
                what,
                "output lines only",
                code="CTL610",
            )
        )
    missing = (moves.kind == Kind.LINEAR) & ~np.isfinite(moves.normal[:, 0])
    inserted = missing[:-1] & (moves.line[:-1] == moves.line[1:]) & np.isfinite(moves.normal[1:, 0])
    if inserted.any():
        what = "a point between CL points, where the surface normal is not known"
        line = int(moves.line[int(np.argmax(inserted))])
        problems.append(
            Problem(program.file_of(operation), line, what, "leave the setting axis_tolerance out", code="CTL610")
        )
    elif missing.any():
        what = f"operation {name}: no contact point at {int(missing.sum())} of {counted(len(moves), 'point')}"
        effect = "the control does not compensate the tool there"
        problems.append(Problem(*location, what, effect, Severity.WARNING, code="CTL620"))
    return problems
