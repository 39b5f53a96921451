"""The bodies of a machine: what iron is on which link of its chain, as its definition states it.

Frame: the machine frame with all axes at zero. Units: mm and degrees. Files of meshes are named here and opened by
whoever asks for them (``trunnion.simulation``), never when a definition is loaded.
"""

from typing import Final, TypeAlias

from trunnion.records import dataclass

Vector: TypeAlias = tuple[float, float, float]

#: Colour of a body whose definition states none.
PLAIN_COLOUR: Final = "#9aa0a6"


@dataclass(frozen=True, slots=True)
class BodyBox:
    """A box: its size along X, Y and Z, its middle, and how it is turned about its middle."""

    size: Vector
    centre: Vector
    turn: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class BodyCylinder:
    """A cylinder: its diameter, its length along ``direction`` (a unit vector), and its middle."""

    diameter: float
    length: float
    centre: Vector
    direction: Vector = (0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class BodyFile:
    """A mesh in a file: where its origin is, and how it is turned about it.

    file  as the definition writes it, below the folder of ``of``
    of    the file of the definition that names it
    unit  "mm", "inch" or "m"; None: what the format says
    """

    file: str
    of: str
    origin: Vector = (0.0, 0.0, 0.0)
    turn: Vector = (0.0, 0.0, 0.0)
    unit: str | None = None


@dataclass(frozen=True, slots=True)
class MachineBody:
    """A body on a link.

    name    what findings call it
    link    what it moves with: an axis by its name, "bed", "workpiece" (what carries the part) or "spindle"
    shape   turns go about X, then Y, then Z of the machine, right-handed, degrees
    colour  "#rrggbb"
    place   file and line of the definition where it stands
    """

    name: str
    link: str
    shape: BodyBox | BodyCylinder | BodyFile
    colour: str = PLAIN_COLOUR
    place: tuple[str, int] = ("", 0)
