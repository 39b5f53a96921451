"""Which bodies are checked against each other, and which are not, and why.

No pair are bodies of one link, a cutter and the part, two tools, and bodies on one side of the machine that overlap
with all axes at home (table and cradle, head and ram): these touch by construction. What overlaps there from different
sides is checked all the same. Where the definition does not say where the spindle nose stands, what is at the nose and
the rest of the machine are apart as work offset and tool length say, and a pair there: not where a block names
positions of the machine. With rotary axes in the head they are no pair at all: its pivot length is not known.
"""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, Mount, link_transforms
from trunnion.machines.links import BED, SPINDLE, axes_between, carrier
from trunnion.records import dataclass
from trunnion.simulation.collisions.bodies import Body, BodyKind
from trunnion.simulation.collisions.queries import Solid, touches


@dataclass(frozen=True, slots=True)
class BodyPairs:
    """Pairs of bodies by their indices, and those that are no pair since they overlap at home."""

    checked: tuple[tuple[int, int], ...]
    left_out: tuple[tuple[int, int], ...]


def body_pairs(machine: Machine, bodies: Sequence[Body]) -> BodyPairs:
    """Return which bodies are checked against each other."""
    checked, left_out = [], []
    solids: dict[int, Solid] = {}
    for i, j in combinations(range(len(bodies)), 2):
        one, other = bodies[i], bodies[j]
        if not may_meet(machine, one, other):
            continue
        if are_on_one_side(machine, one.link, other.link):
            for k in (i, j):
                solids.setdefault(k, Solid(bodies[k].mesh))
            if touches(solids[i], solids[j], seen_at_home(machine, one.link, other.link)):
                left_out.append((i, j))
                continue
        checked.append((i, j))
    return BodyPairs(tuple(checked), tuple(left_out))


def seen_at_home(machine: Machine, link: str, other: str) -> Floats:
    """Return the map (4, 4) from the frame of a link to that of another, all axes at home."""
    home = link_transforms(machine, machine.home[None])
    return np.asarray(np.linalg.inv(home[other][0]) @ home[link][0])


def may_meet(machine: Machine, one: Body, other: Body) -> bool:
    """Return whether two bodies move against each other, must not touch, and stand where the definition says."""
    if not axes_between(machine, one.link, other.link) or _never_meet(one, other):
        return False
    return not (stands_on_work_offset(machine, one, other) and machine.has_rotary_head)


def stands_on_work_offset(machine: Machine, one: Body, other: Body) -> bool:
    """Return whether two bodies are as far apart as work offset and tool length say, and nobody knows it otherwise.

    One of them is at a spindle nose of unknown place, the other is of the rest of the machine.
    """
    if machine.spindle_point_is_stated:
        return False
    at_nose = [body.link == SPINDLE for body in (one, other)]
    rest = [body.kind is BodyKind.MACHINE and body.link != SPINDLE for body in (one, other)]
    return any(at_nose) and any(rest)


def _never_meet(one: Body, other: Body) -> bool:
    """Whether two bodies are tools, or a cutter and what it is there to cut."""
    if one.kind.is_tool and other.kind.is_tool:
        return True
    return {one.kind, other.kind} == {BodyKind.CUTTER, BodyKind.PART}


def are_on_one_side(machine: Machine, link: str, other: str) -> bool:
    """Return whether two links are on the same side; the bed is on both."""
    sides = {side_of(machine, link), side_of(machine, other)}
    return len(sides - {None}) < 2


def side_of(machine: Machine, link: str) -> Mount | None:
    """Return the side of a link; None for the bed, which is on both."""
    name = carrier(machine, link)
    return None if name == BED else machine.axis(name).mount
