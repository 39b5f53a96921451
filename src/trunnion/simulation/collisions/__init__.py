"""Collisions: bodies on the links of a machine, and which of them come near each other while a run goes on.

``check_collisions`` is the whole of it. Stock that is being cut is no body: what tool and holder do to it is removal's.
"""

from trunnion.simulation.collisions.bodies import (
    Body,
    BodyKind,
    fixture_body,
    machine_bodies,
    part_body,
    tool_bodies,
)
from trunnion.simulation.collisions.checking import check_collisions
from trunnion.simulation.collisions.pairs import BodyPairs, body_pairs

__all__ = [
    "Body",
    "BodyKind",
    "BodyPairs",
    "body_pairs",
    "check_collisions",
    "fixture_body",
    "machine_bodies",
    "part_body",
    "tool_bodies",
]
