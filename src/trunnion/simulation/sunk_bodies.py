"""Stock and fixtures that overlap what carries them: no motion shows it, since nothing moves one into the other.

Frame: the machine frame with all axes at home. Units: mm.
"""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trunnion.errors import Problem, warning
from trunnion.machines import Machine
from trunnion.machines.links import WORKPIECE
from trunnion.messages import Wording
from trunnion.simulation.body_names import body_said
from trunnion.simulation.collisions import fixture_body, machine_bodies
from trunnion.simulation.collisions.pairs import are_on_one_side, seen_at_home
from trunnion.simulation.collisions.queries import PairQuery, Solid, touches
from trunnion.simulation.meshes import TriangleMesh

#: What is less deep stands on it: sides of round iron stand out by as much.
_STANDS: Final = 0.1


def jaws_in_stock(stock: TriangleMesh, fixtures: Sequence[TriangleMesh]) -> Iterator[Problem]:
    """Yield a warning for each fixture that is inside of the stock, all in workpiece coordinates."""
    solid = Solid(stock)
    for fixture in fixtures:
        other = Solid(fixture)
        if touches(solid, other, np.eye(4)):
            depth, _ = PairQuery(solid, other).depth(np.eye(4))
            if depth > _STANDS:
                yield warning(fixture.name, 0, Wording("SIM314", "in_stock", depth=depth))


def sunk_bodies(machine: Machine, meshes: Sequence[TriangleMesh]) -> Iterator[Problem]:
    """Yield a warning for each of some bodies in workpiece coordinates that is inside of what carries it.

    Those of other links count as well where they overlap at home: they are no pair of the check of collisions. It needs
    the workpiece zero, and neither gauge point nor tool length.
    """
    if machine.workpiece_zero is None:
        return
    iron = [
        (body.name, seen_at_home(machine, WORKPIECE, body.link), Solid(body.mesh))
        for body in machine_bodies(machine)
        if are_on_one_side(machine, WORKPIECE, body.link)
    ]
    for mesh in meshes:
        solid = Solid(fixture_body(mesh, machine).mesh)
        found = []
        for name, pose, other in iron:
            if touches(solid, other, pose):
                depth, _ = PairQuery(solid, other).depth(np.asarray(pose))
                found.append((depth, name))
        depth, name = max(found, default=(0.0, ""))
        if depth > _STANDS:
            yield warning(mesh.name, 0, Wording("SIM313", "sunk_in", depth=depth, body=body_said(name)))
