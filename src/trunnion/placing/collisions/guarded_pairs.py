"""Which pieces of bodies are kept apart, and what changes how far apart they are."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum, auto
from itertools import product

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, Mount, link_transforms
from trunnion.machines.links import WORKPIECE, axes_between, is_nearer_the_tool
from trunnion.simulation.collisions.bodies import Body, BodyKind, tool_bodies, tool_pose
from trunnion.simulation.collisions.hull_pieces import HullPiece, mesh_pieces, section_pieces
from trunnion.simulation.collisions.pairs import may_meet, side_of
from trunnion.simulation.collisions.queries import Solid, touches
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.tools.profile import ToolShape


class Changes(Enum):
    """What changes how far two bodies are apart: the place of the zero, else the turn alone, or neither."""

    PLACE = auto()
    TURN = auto()
    NOTHING = auto()


@dataclass(frozen=True, slots=True, eq=False)
class Guarded:
    """A body that is kept apart from others.

    carried   whether it is clamped with the part: its mesh is in workpiece coordinates, and turns with the part
    is_stock  of the stock, which tools cut
    tool      number of the tool that it belongs to; -1: always there
    """

    body: Body
    pieces: tuple[HullPiece, ...]
    carried: bool = False
    is_stock: bool = False
    tool: int = -1


@dataclass(frozen=True, slots=True, eq=False)
class GuardedPair:
    """Two bodies: the second is nearer to the part along the chain of axes, and carried with it if either is."""

    one: Guarded
    other: Guarded
    changes: Changes

    @property
    def names(self) -> tuple[str, str]:
        """What results call them."""
        return self.one.body.name, self.other.body.name

    @property
    def tool(self) -> int:
        """The tool that one of them belongs to; -1: none."""
        return max(self.one.tool, self.other.tool)


def guarded_machine(bodies: Sequence[Body]) -> list[Guarded]:
    """Return the bodies of a machine's definition."""
    return [Guarded(body, mesh_pieces(body.mesh)) for body in bodies]


def guarded_tool(shape: ToolShape, machine: Machine, name: str, length: float, number: int) -> list[Guarded]:
    """Return cutter, shank and holder of a tool; length from the tip to the gauge point, mm."""
    pose = tool_pose(machine, length)
    bodies = tool_bodies(shape, machine, name, length)
    found = []
    for body, section in zip(bodies, shape.sections, strict=True):
        pieces = mesh_pieces(body.mesh)
        if len(pieces) != 1 or not pieces[0].exact:
            pieces = section_pieces(section, pose)
        found.append(Guarded(body, pieces, tool=number))
    return found


def guarded_on_part(mesh: TriangleMesh, kind: BodyKind, *, is_stock: bool = False) -> Guarded:
    """Return what is clamped with the part; its mesh is in workpiece coordinates, as the part is drawn."""
    return Guarded(Body(mesh.name, WORKPIECE, mesh, kind), mesh_pieces(mesh), carried=True, is_stock=is_stock)


def guarded_pairs(machine: Machine, bodies: Sequence[Guarded]) -> list[GuardedPair]:
    """Return the pairs that are kept apart: bodies of the spindle's side, of the table's and of the bed between them.

    The stock is kept apart from all but the tools, which cut it. Bodies of the machine whose links one axis joins, and
    those of bed and another link that overlap at home, touch by construction.
    """
    found = []
    for k, one in enumerate(bodies):
        for other in bodies[k + 1 :]:
            if is_nearer_the_tool(machine, one.body.link, other.body.link):
                found += _pair(machine, one, other)
            else:
                found += _pair(machine, other, one)
    return found


def piece_pairs(pair: GuardedPair) -> Iterator[tuple[HullPiece, HullPiece]]:
    """The pieces of a pair that are held against each other."""
    return product(pair.one.pieces, pair.other.pieces)


def _pair(machine: Machine, one: Guarded, other: Guarded) -> list[GuardedPair]:
    sides = side_of(machine, one.body.link), side_of(machine, other.body.link)
    if sides[0] is sides[1] or not may_meet(machine, one.body, other.body):
        return []
    if other.is_stock and one.body.kind.is_tool:
        return []
    of_machine = one.body.kind is other.body.kind is BodyKind.MACHINE
    if of_machine and None in sides and _touch_by_construction(machine, one.body, other.body):
        return []
    return [GuardedPair(one, other, _changes(machine, one, other))]


def _touch_by_construction(machine: Machine, one: Body, other: Body) -> bool:
    if len(axes_between(machine, one.link, other.link)) == 1:
        return True
    home = link_transforms(machine, machine.home[None])
    seen: Floats = np.linalg.inv(home[other.link][0]) @ home[one.link][0]
    return touches(Solid(one.mesh), Solid(other.mesh), seen)


def _changes(machine: Machine, one: Guarded, other: Guarded) -> Changes:
    between = set(axes_between(machine, one.body.link, other.body.link))
    slides = len(between & set(machine.linear))
    if (other.carried and slides < len(machine.linear)) or (not other.carried and slides):
        return Changes.PLACE
    return Changes.NOTHING if one.body.kind.is_tool and other.carried else Changes.TURN


def has_spindle_side(machine: Machine, bodies: Sequence[Guarded]) -> bool:
    """Whether some body moves with the spindle."""
    return any(side_of(machine, each.body.link) is Mount.TOOL for each in bodies)
