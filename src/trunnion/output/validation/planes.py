"""Tilted planes that the control cannot say by the command that is set."""

from trunnion.controls.vocabulary import PROJECTED_ANGLES
from trunnion.errors import Problem
from trunnion.model.motion import Motion
from trunnion.output.coordinates.plane_from_pose import plane_of_pose
from trunnion.output.printed_planes import needs_plane, out_of_level_plane
from trunnion.output.program import Program


def plane_problems(program: Program, motion: Motion) -> list[Problem]:
    """Return why the plane of a motion cannot be written."""
    motion = out_of_level_plane(program, motion)
    if motion.plane is None or not needs_plane(program, motion):
        return []
    settings = {**program.effective_settings(), PROJECTED_ANGLES: program.control.projected_angles}
    of_pose = plane_of_pose(program.machine_of(motion), motion.rotary[0]).matrix()
    wording = program.control.family.validate_plane(settings, motion.plane.matrix(), of_pose)
    if wording is None:
        return []
    return [Problem(program.file_of(motion.operation), motion.operation.line, wording)]
