"""Which pieces of bodies are kept apart, and what changes how far apart they are."""

from collections.abc import Iterator, Sequence
from enum import Enum, auto
from functools import lru_cache
from itertools import product
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine
from trunnion.machines.links import BED, WORKPIECE, axes_between, carrier, is_nearer_the_tool
from trunnion.records import dataclass
from trunnion.simulation.collisions.bodies import Body, BodyKind, tool_bodies, tool_pose
from trunnion.simulation.collisions.hull_pieces import HullPiece, mesh_pieces, section_pieces
from trunnion.simulation.collisions.pairs import are_on_one_side, body_pairs, may_meet, seen_at_home, side_of
from trunnion.simulation.collisions.queries import PairQuery, Solid, touches
from trunnion.simulation.meshes import TriangleMesh
from trunnion.simulation.tools.profile import ToolShape

#: Bodies of one side of the machine that slides move, and that are nearer to each other than this at home, mm, run
#: along each other: they count as so far apart there. Those that only rotary axes move count as so far apart as the
#: third. Nearer ones than the last count as if they were as far apart as that.
_RUNS: Final = 50.0
_FAR: Final = 1000.0
_FAR_TURNING: Final = 10_000.0
_LEAST: Final = 0.1


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
    """Two bodies: the second is nearer to the part along the chain of axes, and carried with it if either is.

    ``weight``: so many times as far apart as they are do they count as.
    """

    one: Guarded
    other: Guarded
    changes: Changes
    weight: float = 1.0

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


@dataclass(frozen=True, slots=True, eq=False)
class GuardedPairs:
    """Pairs that are kept apart, and the names of those of the machine that are no pair: they overlap at home."""

    kept: tuple[GuardedPair, ...]
    left_out: tuple[tuple[str, str], ...] = ()


def guarded_pairs(machine: Machine, bodies: Sequence[Guarded]) -> GuardedPairs:
    """Return the pairs that are kept apart: all that a simulation checks, wherever the part sits.

    What overlaps at home of one side of the machine touches by construction. That of what is clamped and of the iron
    below it is different at each place: ``standing`` says it of one. The stock, which no simulation checks against
    bodies, is kept apart from the spindle's side and the bed, but for the tools, which cut it.
    """
    still = [each for each in bodies if not each.carried]
    own = body_pairs(machine, [each.body for each in still])
    pairs = [(still[i], still[j]) for i, j in own.checked]
    pairs += [
        (one, other)
        for other in bodies
        if other.carried
        for one in still
        if may_meet(machine, one.body, other.body) and not _never_meets_stock(machine, one, other)
    ]
    left_out = tuple((still[i].body.name, still[j].body.name) for i, j in own.left_out)
    return GuardedPairs(tuple(_pair(machine, one, other) for one, other in pairs), left_out)


def standing(machine: Machine, pairs: Sequence[GuardedPair], turn: Floats, zero: Floats) -> list[GuardedPair]:
    """Return the pairs of what is clamped and the iron of the table's side that overlap with all axes at home.

    The part is turned by a matrix (3, 3), its zero (3,) is at a place: a simulation does not check these pairs there.
    """
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, zero
    found = list[GuardedPair]()
    for pair in pairs:
        one, other = pair.one, pair.other
        if not other.carried or not are_on_one_side(machine, one.body.link, other.body.link):
            continue
        seen = np.linalg.inv(pose) @ seen_at_home(machine, one.body.link, other.body.link)
        if touches(_solid(one), _solid(other), seen):
            found.append(pair)
    return found


@lru_cache(maxsize=32)  # large meshes take seconds, and several places are asked
def _solid(guarded: Guarded) -> Solid:
    return Solid(guarded.body.mesh)


def piece_pairs(pair: GuardedPair) -> Iterator[tuple[HullPiece, HullPiece]]:
    """Return the pieces of a pair that are held against each other."""
    return product(pair.one.pieces, pair.other.pieces)


def _pair(machine: Machine, one: Guarded, other: Guarded) -> GuardedPair:
    if not other.carried and not is_nearer_the_tool(machine, one.body.link, other.body.link):
        one, other = other, one
    weight = 1.0 if other.carried else _weight(machine, one.body, other.body)
    return GuardedPair(one, other, _changes(machine, one, other), weight)


def _weight(machine: Machine, one: Body, other: Body) -> float:
    """More than 1 for bodies of one side of the machine that run close to each other, as slides and cradles do.

    They count in proportion to how far they are apart at home. So do those that only rotary axes move: no place
    changes them. Those of the bed that two axes move count as they are.
    """
    links = one.link, other.link
    if not are_on_one_side(machine, *links):
        return 1.0
    if BED in (carrier(machine, link) for link in links) and len(axes_between(machine, *links)) > 1:
        return 1.0
    apart = PairQuery(Solid(one.mesh), Solid(other.mesh)).distance(seen_at_home(machine, *links))
    if not set(axes_between(machine, *links)) & set(machine.linear):
        return max(1.0, _FAR_TURNING / max(apart, _LEAST))
    return 1.0 if apart >= _RUNS else _FAR / max(apart, _LEAST)


def _never_meets_stock(machine: Machine, one: Guarded, other: Guarded) -> bool:
    below = side_of(machine, one.body.link) is side_of(machine, other.body.link)
    return other.is_stock and (below or one.body.kind.is_tool)


def _changes(machine: Machine, one: Guarded, other: Guarded) -> Changes:
    between = set(axes_between(machine, one.body.link, other.body.link))
    slides = len(between & set(machine.linear))
    if (other.carried and slides < len(machine.linear)) or (not other.carried and slides):
        return Changes.PLACE
    return Changes.NOTHING if one.body.kind.is_tool and other.carried else Changes.TURN
