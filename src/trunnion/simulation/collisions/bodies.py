"""Bodies as meshes on links: the machine's iron, fixtures and part, tools.

Frame: every mesh is in the machine frame with all axes at zero. Units: mm.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.definitions.extends import is_within
from trunnion.errors import InputError, Problem, unusable_file, warning
from trunnion.machines import BodyBox, BodyCylinder, BodyFile, Machine, MachineBody
from trunnion.machines.links import SPINDLE, WORKPIECE
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.simulation.meshes import TriangleMesh, box_mesh, cylinder_mesh, load_mesh, revolved_mesh
from trunnion.simulation.tools.profile import Element, ProfileArc, Section, ToolShape

#: How far the straight pieces of a round outline may be inside of it, mm; they are widened by as much.
_ARC_TOLERANCE: Final = 0.01

#: How far the flat sides of a round piece of iron may stand out, mm.
_IRON_EXCESS: Final = 0.1


class BodyKind(StrEnum):
    """What a body is; cutter, shank and holder are parts of one tool."""

    MACHINE = "machine"
    FIXTURE = "fixture"
    PART = "part"
    CUTTER = "cutter"
    SHANK = "shank"
    HOLDER = "holder"

    @property
    def is_tool(self) -> bool:
        """Whether it is a part of a tool."""
        return self in (BodyKind.CUTTER, BodyKind.SHANK, BodyKind.HOLDER)


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A body on a link of the machine.

    name  what findings call it
    link  what it moves with, a key of ``machines.link_transforms``
    mesh  in the machine frame with all axes at zero
    kind  what it is
    tool  of a part of a tool: the tool as the run calls it; empty: always there
    line  of a body of revolution: a point of its axis and its direction, (2, 3); None for others
    """

    name: str
    link: str
    mesh: TriangleMesh
    kind: BodyKind
    tool: str = ""
    line: Floats | None = None


def machine_bodies(machine: Machine, warn: Callable[[Problem], None] | None = None) -> tuple[Body, ...]:
    """Return the bodies of a machine's definition; meshes are read now.

    machine  the machine
    warn     takes what is odd about meshes, and that nobody knows where a head turns its spindle nose about

    Raises ``InputError`` if a mesh cannot be used, with file and line of the definition that names it.
    """
    found, problems = [], []
    for body in machine.bodies:
        try:
            mesh = _mesh(body, warn)
        except InputError as error:
            file, at = body.place
            problems += [
                Problem(file, at, each.wording.within("of_body", body=body.name, file=each.file))
                for each in error.problems
            ]
            continue
        pose = np.eye(4)
        if body.link == SPINDLE:
            pose[:3, 3] = machine.spindle_point
        line: Floats | None = None
        if isinstance(body.shape, BodyCylinder):
            line = np.array([np.array(body.shape.centre) + pose[:3, 3], body.shape.direction])
        found.append(Body(body.name, body.link, mesh.moved(pose).named(body.name), BodyKind.MACHINE, line=line))
    if problems:
        raise InputError(problems)
    if found and warn is not None and not machine.spindle_point_is_stated and machine.has_rotary_head:
        warn(warning(machine.files[0] if machine.files else machine.key, 0, Wording("SIM310", "no_spindle_gauge")))
    return tuple(found)


def fixture_body(mesh: TriangleMesh, machine: Machine) -> Body:
    """Return a fixture, whose mesh is in workpiece coordinates."""
    return Body(mesh.name, WORKPIECE, _on_workpiece(mesh, machine), BodyKind.FIXTURE)


def part_body(mesh: TriangleMesh, machine: Machine) -> Body:
    """Return the part as it will be, whose mesh is in workpiece coordinates: shanks and holders must not touch it."""
    return Body(mesh.name, WORKPIECE, _on_workpiece(mesh, machine), BodyKind.PART)


def tool_bodies(shape: ToolShape, machine: Machine, name: str, length: float) -> tuple[Body, ...]:
    """Return cutter, shank and holder of a tool in the spindle.

    shape    the tool
    machine  in whose spindle it is
    name     the tool as the run calls it
    length   from the tip to the gauge point, mm
    """
    axis, pose = np.array(machine.spindle_direction), tool_pose(machine, length)
    bodies = []
    for section in shape.sections:
        kind = BodyKind(section.role)
        called = f"{section.name or section.role} of {shape.name or name}"
        mesh = revolved_mesh(section_outline(section), called).moved(pose)
        bodies.append(Body(called, SPINDLE, mesh, kind, name, np.stack((pose[:3, 3], axis))))
    return tuple(bodies)


def tool_pose(machine: Machine, length: float) -> Floats:
    """Return the map (4, 4) from the frame of a tool, its tip at the origin, to the machine frame with axes at zero."""
    axis = np.array(machine.spindle_direction)
    pose = np.eye(4)
    pose[:3, :3] = _turned_to(axis)
    pose[:3, 3] = np.array(machine.spindle_point) - length * axis
    return pose


def _on_workpiece(mesh: TriangleMesh, machine: Machine) -> TriangleMesh:
    pose = np.eye(4)
    pose[:3, 3] = machine.workpiece_zero or (0.0, 0.0, 0.0)
    return mesh.moved(pose)


def _mesh(body: MachineBody, warn: Callable[[Problem], None] | None) -> TriangleMesh:
    shape, pose = body.shape, np.eye(4)
    if isinstance(shape, BodyBox):
        half = np.array(shape.size) / 2.0
        pose[:3, :3], pose[:3, 3] = _turn(shape.turn), shape.centre
        return box_mesh(-half, half, body.name).moved(pose)
    if isinstance(shape, BodyCylinder):
        pose[:3, :3], pose[:3, 3] = _turned_to(np.array(shape.direction)), shape.centre
        half_length = shape.length / 2.0
        return cylinder_mesh(shape.diameter, -half_length, half_length, body.name, _IRON_EXCESS).moved(pose)
    pose[:3, :3], pose[:3, 3] = _turn(shape.turn), shape.origin
    return load_mesh(_file_beside(shape), shape.unit, name=body.name, warn=warn).moved(pose)


def _file_beside(shape: BodyFile) -> Path:
    """Return the file of a mesh; a link must not lead out of the folder of the definition."""
    definition = Path(shape.of)
    path = definition.parent / shape.file
    if not definition.is_file():
        raise InputError(Problem(shape.file, 0, Wording("SIM312", "belongs_no_definition")))
    if not is_within(path, definition.parent):
        raise InputError(Problem(shape.file, 0, Wording("SIM312", "leads_out_folder")))
    if path.exists() and (unusable := unusable_file(path, phrase("file_of_mesh"))):
        raise InputError(replace(unusable, file=shape.file))
    return path


def _turn(degrees: tuple[float, float, float]) -> Floats:
    """Return the rotation about X, then Y, then Z, (3, 3)."""
    a, b, c = (math.radians(angle) for angle in degrees)
    x = np.array([[1.0, 0.0, 0.0], [0.0, math.cos(a), -math.sin(a)], [0.0, math.sin(a), math.cos(a)]])
    y = np.array([[math.cos(b), 0.0, math.sin(b)], [0.0, 1.0, 0.0], [-math.sin(b), 0.0, math.cos(b)]])
    z = np.array([[math.cos(c), -math.sin(c), 0.0], [math.sin(c), math.cos(c), 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(z @ y @ x)


def _turned_to(direction: Floats) -> Floats:
    """Return a rotation that takes Z to a unit vector, (3, 3)."""
    other = np.eye(3)[int(np.argmin(np.abs(direction)))]
    x = np.cross(other, direction)
    x /= np.linalg.norm(x)
    return np.stack((x, np.cross(direction, x), direction), axis=1)


def section_outline(section: Section) -> Floats:
    """Return radii and heights of a section, (k, 2), from the axis back to the axis, nowhere inside of the section."""
    points = [section.outline[0].start]
    for element in section.outline:
        points += _chords(element)
    outline = [(0.0, points[0][1])] if points[0][0] > 0.0 else []
    outline += points
    if points[-1][0] > 0.0:
        outline.append((0.0, points[-1][1]))
    return np.array(outline)


def _chords(element: Element) -> list[tuple[float, float]]:
    """Return the ends of the straight pieces of an element, after its start; those of an arc stand outside of it."""
    if not isinstance(element, ProfileArc):
        return [element.end]
    (x0, z0), (x1, z1), (x, z) = element.start, element.end, element.centre
    radius = element.radius
    first, last = math.atan2(z0 - z, x0 - x), math.atan2(z1 - z, x1 - x)
    step = 2.0 * math.acos(max(1.0 - _ARC_TOLERANCE / max(radius, _ARC_TOLERANCE), -1.0))
    count = max(1, math.ceil(abs(last - first) / step))
    wide = radius / math.cos((last - first) / count / 2.0)
    # Tangents meet between the ends of the pieces: the outline of tangents encloses the arc.
    middles = [first + (last - first) * (k + 0.5) / count for k in range(count)]
    return [*((max(x + wide * math.cos(a), 0.0), z + wide * math.sin(a)) for a in middles), element.end]
