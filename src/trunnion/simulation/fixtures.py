"""Fixtures from what states them: a mesh, a box, a cylinder, a chuck or a vice.

    chuck:160,height=70,grip=60,jaw=45x30x40,at=0/0/-20
    vice:125,opening=80,jaw=40x50,base=300x60

In:     a text, mm and degrees, as the workpiece counts.
Out:    convex meshes: one for each solid piece. The grammar is in ``docs/simulation.md``.
"""

import math
import re
from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.definitions.messages import meant_word
from trunnion.errors import InputError, argument_problem
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.simulation.meshes import TriangleMesh, box_mesh, cylinder_mesh
from trunnion.simulation.stock.solids import stock_shape

#: Words before the colon with which a text states a fixture instead of a file; the first two as stock has them.
KINDS: Final = ("box", "cylinder", "chuck", "vice")

#: Sizes that a number may have, mm or degrees, and texts of a fixture, letters.
_LARGEST: Final = 1e5
_LONGEST: Final = 1000

_NUMBER: Final = re.compile(r"[+-]?(\d{1,9}(\.\d{0,12})?|\.\d{1,12})", re.ASCII)
_FEWEST_JAWS, _MOST_JAWS = 2, 8


@dataclass(frozen=True, slots=True)
class _Size:
    """One size of a fixture: how many numbers it has, between which signs, and what they are where it is not stated."""

    example: str
    count: int = 1
    sign: str = "x"
    default: tuple[float, ...] = ()
    is_signed: bool = False


_AT: Final = _Size("0/0/-20", 3, "/", (0.0, 0.0, 0.0), is_signed=True)
_TURN: Final = _Size("90", default=(0.0,), is_signed=True)

#: Kind -> its sizes; the first stands behind the colon without its name.
_SIZES: Final[Mapping[str, Mapping[str, _Size]]] = {
    "chuck": {
        "diameter": _Size("160"), "height": _Size("70"), "grip": _Size("60"), "jaw": _Size("45x30x40", 3),
        "jaws": _Size("3", default=(3.0,)), "at": _AT, "turn": _TURN,
    },
    "vice": {
        "width": _Size("125"), "opening": _Size("80"), "jaw": _Size("40x50", 2), "base": _Size("300x60", 2),
        "at": _AT, "turn": _TURN,
    },
}  # fmt: skip


class _SizeError(Exception):
    """What is wrong with a text."""

    def __init__(self, variant: str, **parameters: object) -> None:
        super().__init__(variant)
        self.wording = Wording("SIM123", variant, **parameters)


def is_stated_fixture(text: str) -> bool:
    """Whether a text states a fixture by its sizes; else it names a file with a mesh."""
    return text.partition(":")[0] in KINDS and ":" in text


def stated_fixture(text: str) -> list[TriangleMesh]:
    """Return the pieces of a fixture that a text states by its sizes, each convex and with its name.

    box, cylinder  as a stock is stated
    chuck          a cylinder whose face is at ``at``, with ``jaws`` (2 to 8, by default 3) that stand on the face and
                   grip outside on the diameter ``grip``; ``jaw`` is the length of each outwards, its width, its height
    vice           a bed at ``at``, as wide along X as the jaws, on a base; the jaws are ``opening`` apart along Y;
                   ``jaw`` is the thickness and height above the bed of each, ``base`` its length along Y and its height
    at             X/Y/Z in the middle of face or bed, by default 0/0/0
    turn           about Z through that point, degrees

    Raises ``InputError`` if the text states none, with the cure.
    """
    kind, _, rest = text.partition(":")
    try:
        if len(text) > _LONGEST:
            raise _SizeError("too_long", count=len(text))
        if kind not in _SIZES:
            return [stock_shape(text).as_mesh().named(kind)]
        sizes = _read(kind, rest)
    except _SizeError as error:
        shown = text if len(text) <= 60 else text[:57] + "..."
        raise InputError(argument_problem("fixtures", error.wording.within("of_quoted", text=shown))) from None
    except InputError as error:  # of the stock's grammar
        raise InputError([argument_problem("fixtures", each.wording) for each in error.problems]) from None
    pieces = list(_chuck(sizes) if kind == "chuck" else _vice(sizes))
    return [piece.moved(_pose(sizes["at"], sizes["turn"][0])) for piece in pieces]


def _read(kind: str, text: str) -> dict[str, tuple[float, ...]]:
    """Return the numbers of each size."""
    known = _SIZES[kind]
    found: dict[str, tuple[float, ...]] = {}
    for place, part in enumerate(text.split(",")):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals and place == 0:
            name, value = next(iter(known)), name
        elif not equals:
            raise _SizeError("no_name", kind=kind, value=name, known=tuple(known)[1:])
        if name not in known:
            near = meant_word(name, tuple(known))
            if near:
                raise _SizeError("no_size_but_near", kind=kind, name=name, near=near)
            raise _SizeError("no_size", kind=kind, name=name, known=tuple(known))
        if name in found:
            raise _SizeError("size_twice", name=name)
        found[name] = _numbers(name, known[name], value)
    missing = tuple(f"{name}={size.example}" for name, size in known.items() if name not in found and not size.default)
    if missing:
        raise _SizeError("missing", kind=kind, missing=missing)
    if kind == "chuck" and not (
        found.get("jaws", (3.0,))[0].is_integer() and _FEWEST_JAWS <= found.get("jaws", (3.0,))[0] <= _MOST_JAWS
    ):
        raise _SizeError("no_jaws", fewest=_FEWEST_JAWS, most=_MOST_JAWS)
    sizes = {name: size.default for name, size in known.items()} | found
    (_check_chuck if kind == "chuck" else _check_vice)(sizes)
    return sizes


def _check_chuck(sizes: Mapping[str, tuple[float, ...]]) -> None:
    """Refuse jaws that stand beside the chuck, or in each other."""
    (diameter,), (grip,), width, jaws = sizes["diameter"], sizes["grip"], sizes["jaw"][1], sizes["jaws"][0]
    if grip >= diameter:
        raise _SizeError("grip_beyond", grip=grip, diameter=diameter)
    widest = grip * math.tan(math.pi / jaws) if jaws > _FEWEST_JAWS else math.inf
    if width > widest:
        raise _SizeError("jaws_overlap", width=width, jaws=int(jaws), grip=grip, widest=math.floor(10 * widest) / 10)


def _check_vice(sizes: Mapping[str, tuple[float, ...]]) -> None:
    """Refuse jaws that stand beside the base."""
    length, needed = sizes["base"][0], sizes["opening"][0] + 2 * sizes["jaw"][0]
    if needed > length:
        raise _SizeError("jaws_beyond_base", length=length, needed=needed)


def _numbers(name: str, size: _Size, text: str) -> tuple[float, ...]:
    words = [word.strip() for word in text.split(size.sign)] if size.count > 1 else [text]
    if len(words) != size.count or not all(_NUMBER.fullmatch(word) for word in words):
        raise _SizeError("no_numbers", name=name, value=text, example=size.example)
    numbers = tuple(float(word) for word in words)
    if any(abs(number) > _LARGEST for number in numbers):
        raise _SizeError("number_beyond", name=name, value=text, largest=_LARGEST)
    if not size.is_signed and min(numbers) <= 0.0:
        raise _SizeError("not_above_zero", name=name, value=text, example=size.example)
    return numbers


def _chuck(sizes: Mapping[str, tuple[float, ...]]) -> Iterator[TriangleMesh]:
    """Yield the body below its face at Z0, and the jaws on it."""
    (diameter,), (height,), (grip,) = sizes["diameter"], sizes["height"], sizes["grip"]
    yield cylinder_mesh(diameter, -height, 0.0, "chuck")
    length, width, above = sizes["jaw"]
    jaw = box_mesh(np.array([grip / 2, -width / 2, 0.0]), np.array([grip / 2 + length, width / 2, above]))
    count = int(sizes["jaws"][0])
    for number in range(count):
        yield jaw.moved(_pose((0.0, 0.0, 0.0), 360.0 * number / count)).named(f"chuck jaw {number + 1}")


def _vice(sizes: Mapping[str, tuple[float, ...]]) -> Iterator[TriangleMesh]:
    """Yield the base below the bed at Z0, and the two jaws on it."""
    half = sizes["width"][0] / 2
    (thick, above), (length, height), gap = sizes["jaw"], sizes["base"], sizes["opening"][0] / 2
    yield box_mesh(np.array([-half, -length / 2, -height]), np.array([half, length / 2, 0.0]), "vice")
    yield box_mesh(np.array([-half, -gap - thick, 0.0]), np.array([half, -gap, above]), "vice jaw Y-")
    yield box_mesh(np.array([-half, gap, 0.0]), np.array([half, gap + thick, above]), "vice jaw Y+")


def _pose(at: tuple[float, ...], turn: float) -> Floats:
    """Return a turn about Z and then a shift, (4, 4)."""
    angle = math.radians(turn)
    pose = np.eye(4)
    pose[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
    pose[:3, 3] = at
    return pose
