"""Reads the ``[[body]]`` tables of a machine definition, and notes every mistake with its line."""

import math
import re
from collections.abc import Sequence
from pathlib import PurePosixPath
from typing import Final

from trunnion.definitions import Table, TextForm
from trunnion.machines.bodies import PLAIN_COLOUR, BodyBox, BodyCylinder, BodyFile, MachineBody, Vector
from trunnion.machines.links import FIXED_LINKS
from trunnion.messages import Wording, phrase

#: More bodies make no machine clearer, and the pairs of them grow with their square.
MAX_BODIES: Final = 64

SHAPES: Final = ("box", "cylinder", "file")

#: Endings of meshes that a body may be.
MESH_ENDINGS: Final = (".stl", ".obj", ".ply", ".3mf", ".glb")

_COLOUR: Final = "#[0-9a-fA-F]{6}"

#: The keys of each shape besides those that every body has.
_OF_SHAPE: Final = {
    "box": {"size_mm", "centre_mm", "turn_deg"},
    "cylinder": {"diameter_mm", "length_mm", "centre_mm", "direction"},
    "file": {"file", "unit", "origin_mm", "turn_deg"},
}
_ALL_SHAPES: Final = frozenset().union(*_OF_SHAPE.values())


def read_bodies(table: Table, axis_names: Sequence[str]) -> tuple[MachineBody, ...]:
    """Return the bodies of a definition; mistakes become problems of the table."""
    entries = table.tables("body")
    if len(entries) > MAX_BODIES:
        table.add_problem("body", Wording("DEF450", "tables", count=len(entries), max_bodies=MAX_BODIES))
        return ()
    bodies = [_body(entry, axis_names) for entry in entries]
    seen: dict[str, int] = {}
    for k, body in enumerate(bodies):
        if body.name and body.name.casefold() in seen:
            file, line = entries[seen[body.name.casefold()]].location("name")
            entries[k].add_problem("name", Wording("DEF430", "name_another_body", body=body.name, file=file, line=line))
        seen.setdefault(body.name.casefold(), k)
    return tuple(bodies)


def _body(entry: Table, axis_names: Sequence[str]) -> MachineBody:
    name = entry.text("name")
    if name != name.strip() or any(not letter.isprintable() for letter in name):
        entry.add_problem("name", Wording("DEF430", "begins_ends_blanks"))
    link = entry.text("link", one_of=(*axis_names, *FIXED_LINKS))
    colour = entry.text("colour", PLAIN_COLOUR, written=TextForm(phrase("colour"), _COLOUR))
    shape = entry.text("shape", one_of=SHAPES)
    made = _solid(entry, shape)
    entry.report_unread_keys()
    return MachineBody(name, link, made, colour, entry.location("name"))


def _solid(entry: Table, shape: str) -> BodyBox | BodyCylinder | BodyFile:
    """Return what a body is made of: the keys of its shape; those of other shapes are mistakes."""
    if shape not in _OF_SHAPE:
        entry.mark_read(*_ALL_SHAPES)  # what is missing or foreign is not known
        return BodyBox((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    foreign = _ALL_SHAPES - _OF_SHAPE[shape]
    for key in entry.keys():  # noqa: SIM118 -- a table is no dict
        if key in foreign:
            entry.add_problem(key, Wording("DEF450", "given_shape", shape=shape))
            entry.mark_read(key)
    if shape == "cylinder":
        diameter, length = entry.number("diameter_mm", above=0), entry.number("length_mm", above=0)
        centre, direction = entry.vector("centre_mm", 3), entry.vector("direction", 3, None)
        return BodyCylinder(diameter or 1.0, length or 1.0, _vector(centre), _unit_vector(entry, direction))
    if shape == "file":
        file = entry.text("file", written=TextForm(phrase("name_of_mesh_file")))
        unit = entry.text("unit", None, one_of=("mm", "inch", "m"))
        _check_file(entry, file)
        origin, turn = entry.vector("origin_mm", 3, None), entry.vector("turn_deg", 3, None)
        return BodyFile(file, entry.location("file")[0], _vector(origin), _vector(turn), unit)
    before = len(entry.problems)
    size, centre = entry.vector("size_mm", 3), entry.vector("centre_mm", 3)
    if min(size) <= 0.0 and len(entry.problems) == before:
        entry.add_problem("size_mm", Wording("DEF450", "side_not_above"))
    return BodyBox(_vector(size), _vector(centre), _vector(entry.vector("turn_deg", 3, None)))


def _check_file(entry: Table, file: str) -> None:
    if not file:
        return
    pure = PurePosixPath(file)
    if pure.is_absolute() or ".." in pure.parts or re.search(r"[\\:\x00-\x1f]", file) or len(file) > 1000:
        entry.add_problem("file", Wording("DEF455", "leads_out_folder", mesh_endings=tuple(MESH_ENDINGS)))
    elif pure.suffix.lower() not in MESH_ENDINGS:
        entry.add_problem("file", Wording("DEF455", "is", file=file, mesh_endings=tuple(MESH_ENDINGS)))


def _unit_vector(entry: Table, numbers: Sequence[float] | None) -> Vector:
    """Return the unit vector along a direction; Z where there is none."""
    if numbers is None:
        return 0.0, 0.0, 1.0
    largest = max(map(abs, numbers))
    if largest == 0.0:
        entry.add_problem("direction", Wording("DEF420", "of_0_0"))
        return 0.0, 0.0, 1.0
    x, y, z = (number / largest for number in numbers)
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def _vector(numbers: Sequence[float] | None) -> Vector:
    x, y, z = numbers or (0.0, 0.0, 0.0)
    return x, y, z
