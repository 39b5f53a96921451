"""Which bodies are checked against each other, and which are not, and why.

No pair are bodies of one link, a cutter and the part, two tools, and bodies on one side of the machine that overlap
with all axes at home (table and cradle, head and ram): these touch by construction. What overlaps there from different
sides is checked all the same. Where the definition does not say where the spindle nose stands, what is at the nose and
the rest of the machine are no pair either: nobody knows how far apart they are.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from trunnion.machines import Machine, Mount, link_transforms
from trunnion.machines.links import BED, SPINDLE, axes_between, carrier
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
    home = {link: poses[0] for link, poses in link_transforms(machine, machine.home[None]).items()}
    for i, j in combinations(range(len(bodies)), 2):
        one, other = bodies[i], bodies[j]
        if not may_meet(machine, one, other):
            continue
        if _on_one_side(machine, one, other):
            for k in (i, j):
                solids.setdefault(k, Solid(bodies[k].mesh))
            seen = np.linalg.inv(home[other.link]) @ home[one.link]
            if touches(solids[i], solids[j], seen):
                left_out.append((i, j))
                continue
        checked.append((i, j))
    return BodyPairs(tuple(checked), tuple(left_out))


def may_meet(machine: Machine, one: Body, other: Body) -> bool:
    """Return whether two bodies move against each other, must not touch, and stand where the definition says."""
    if not axes_between(machine, one.link, other.link) or _never_meet(one, other):
        return False
    return not _is_apart_unknown(machine, one, other)


def _never_meet(one: Body, other: Body) -> bool:
    """Whether two bodies are tools, or a cutter and what it is there to cut."""
    if one.kind.is_tool and other.kind.is_tool:
        return True
    return {one.kind, other.kind} == {BodyKind.CUTTER, BodyKind.PART}


def _is_apart_unknown(machine: Machine, one: Body, other: Body) -> bool:
    """Whether one of two bodies is at a spindle nose of unknown place, and the other is of the rest of the machine."""
    if machine.spindle_point_is_stated:
        return False
    at_nose = [body.link == SPINDLE for body in (one, other)]
    rest = [body.kind is BodyKind.MACHINE and body.link != SPINDLE for body in (one, other)]
    return any(at_nose) and any(rest)


def _on_one_side(machine: Machine, one: Body, other: Body) -> bool:
    sides = {side_of(machine, one.link), side_of(machine, other.link)}
    return len(sides - {None}) < 2


def side_of(machine: Machine, link: str) -> Mount | None:
    """Return the side of a link; None for the bed, which is on both."""
    name = carrier(machine, link)
    return None if name == BED else machine.axis(name).mount
