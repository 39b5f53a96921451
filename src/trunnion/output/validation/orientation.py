"""Tool vectors that could mislead the control, and surface normals that it cannot use."""

import numpy as np

from trunnion.errors import Problem, warning
from trunnion.messages import Wording
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Kind
from trunnion.output.coordinates.tool_vectors import first_row_at_other_pose
from trunnion.output.program import Program


def tool_vector_problems(program: Program, motion: Motion) -> list[Problem]:
    """Warn of an operation that is written with rotary words, though tool vectors are set."""
    if not program.control.uses_tool_vectors(program.settings):
        return []
    row = first_row_at_other_pose(program.machine, motion, program.block_words(motion))
    if row < 0:
        return []
    return [
        warning(
            program.file_of(motion.operation),
            int(motion.operation.moves.line[row]),
            Wording("CTL560", "tool_s_vector", operation=motion.operation.name),
        )
    ]


def normal_problems(program: Program, motion: Motion) -> list[Problem]:
    """Return why an operation cannot have surface normals, and where it has none."""
    operation, problems = motion.operation, list[Problem]()
    moves = operation.moves
    if moves.normal is None or not np.isfinite(moves.normal).any():
        return []
    location, name = (program.file_of(operation), operation.line), operation.name
    if motion.mode.goes_straight:
        problems.append(Problem(*location, Wording("CTL610", "operation_surface_normals", name=name)))
    if motion.mode is MachiningMode.TCP and program.effective_setting("orientation") != "vector":
        problems.append(Problem(*location, Wording("CTL610", "operation_tcp_control", name=name)))
    if len(operation.arcs.row):
        problems.append(
            Problem(
                program.file_of(operation), int(moves.line[operation.arcs.row[0]]), Wording("CTL610", "circle_can_have")
            )
        )
    missing = (moves.kind == Kind.LINEAR) & ~np.isfinite(moves.normal[:, 0])
    inserted = missing[:-1] & (moves.line[:-1] == moves.line[1:]) & np.isfinite(moves.normal[1:, 0])
    if inserted.any():
        line = int(moves.line[int(np.argmax(inserted))])
        problems.append(Problem(program.file_of(operation), line, Wording("CTL610", "point_between_cl")))
    elif missing.any():
        problems.append(
            warning(
                *location,
                Wording("CTL620", "operation_no_contact", name=name, sum=int(missing.sum()), count=len(moves)),
            )
        )
    return problems
