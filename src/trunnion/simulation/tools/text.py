"""A tool as one word, as it is written on a command line.

    3=ball:10,length=60,flutes=20,shank=10,holder=40x50/60x30

In:     the text, and diameters that a tool table gives for the numbers of tools.
Out:    a ``ToolShape``. The grammar is in ``docs/tool-libraries.md``.
"""

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any, Final

from trunnion.definitions.messages import meant_word
from trunnion.errors import InputError, argument_problem
from trunnion.messages import Wording
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.shapes import shape_faults, tool_shape
from trunnion.simulation.tools.sizes import OF_BODY, OF_KIND, OTHER_KINDS, BodyPiece, ToolKind, ToolSizes

#: Longer texts are no tool.
_LONGEST: Final = 1000

#: The sizes that stand behind the kind without a name, in their order.
_IN_ORDER: Final[Mapping[ToolKind, tuple[str, ...]]] = {
    ToolKind.FLAT: ("diameter",),
    ToolKind.BALL: ("diameter",),
    ToolKind.BULL: ("diameter", "corner_radius"),
    ToolKind.TAPER: ("diameter", "side_angle", "corner_radius"),
    ToolKind.TAPER_BALL: ("diameter", "side_angle"),
    ToolKind.DRILL: ("diameter", "tip_angle"),
    ToolKind.CHAMFER: ("diameter", "side_angle", "tip_diameter"),
    ToolKind.LOLLIPOP: ("diameter", "neck_diameter"),
    ToolKind.T_SLOT: ("diameter", "flute_length", "neck_diameter"),
    ToolKind.THREAD_MILL: ("diameter", "pitch"),
    ToolKind.BARREL: ("diameter", "profile_radius", "widest_height"),
}

#: Name of a size in the text -> field of ``ToolSizes``.
_NAMES: Final[Mapping[str, str]] = {
    "diameter": "diameter",
    "corner": "corner_radius",
    "upper_corner": "upper_radius",
    "side_angle": "side_angle",
    "tip_angle": "tip_angle",
    "tip": "tip_diameter",
    "profile": "profile_radius",
    "widest": "widest_height",
    "pitch": "pitch",
    "crest": "crest",
    "thread_angle": "thread_angle",
    "flutes": "flute_length",
    "length": "length",
    "shank": "shank_diameter",
    "neck": "neck_diameter",
    "neck_length": "neck_length",
    "gauge": "gauge_length",
    "holder": "holder",
}
_NAME_OF: Final = {field: name for name, field in _NAMES.items()}

_NUMBER: Final = re.compile(r"\d{1,9}(\.\d{0,12})?|\.\d{1,12}", re.ASCII)
_PIECE: Final = re.compile(r"(?P<low>[\d.]+)(-(?P<high>[\d.]+))?x(?P<height>[\d.]+)", re.ASCII)
_TOOL_NUMBER: Final = re.compile(r"\d{1,9}", re.ASCII)


class _TextError(Exception):
    """What is wrong with a text."""

    def __init__(self, variant: str, **parameters: object) -> None:
        super().__init__(variant)
        self.wording = Wording("SIM153", variant, **parameters)


def parse_tool(text: str, diameters: Mapping[int, float] | None = None) -> ToolShape:
    """Return the tool that a text describes.

    text       ``NUMBER=KIND:SIZES`` or ``NAME=KIND:SIZES``, mm and degrees
    diameters  diameters of tools by their number, mm, for those that the text does not state

    Raises ``InputError`` if the text is none of a tool, with everything that is wrong.
    """
    shown = text if len(text) <= 60 else text[:57] + "..."
    try:
        called, sizes = _read(text, diameters or {})
    except _TextError as error:
        raise InputError(argument_problem("tools", error.wording.within("of_quoted", text=shown))) from None
    if faults := shape_faults(sizes):
        named = ((_NAME_OF.get(size, size), wording) for size, wording in faults)
        raise InputError(
            [argument_problem("tools", wording.of_key(name).within("of_quoted", text=shown)) for name, wording in named]
        )
    if _TOOL_NUMBER.fullmatch(called):
        return tool_shape(sizes, int(called))
    return tool_shape(sizes, None, called)


def _read(text: str, diameters: Mapping[int, float]) -> tuple[str, ToolSizes]:
    """Return the number or name of a tool, and its sizes."""
    if len(text) > _LONGEST:
        raise _TextError("too_long", count=len(text))
    called, equals, described = (part.strip() for part in text.partition("="))
    if not equals or not called:
        raise _TextError("no_number_of_tool" if equals else "no_equals")
    word, _, rest = described.partition(":")
    kind = _kind(word.strip())
    given = dict(_sizes(kind, rest))
    if "diameter" not in given and _TOOL_NUMBER.fullmatch(called) and int(called) in diameters:
        given["diameter"] = diameters[int(called)]
    return called, ToolSizes(kind, given.pop("diameter", 0.0), **given)


def _kind(word: str) -> ToolKind:
    try:
        return ToolKind(word)
    except ValueError:
        near = meant_word(word, ToolKind, OTHER_KINDS)
        if near:
            raise _TextError("no_kind_but_near", word=word, near=near, kinds=tuple(ToolKind)) from None
        raise _TextError("no_kind", word=word, kinds=tuple(ToolKind)) from None


def _sizes(kind: ToolKind, text: str) -> Iterator[tuple[str, Any]]:
    """Yield the sizes of a tool: first those without a name, then those with one."""
    order = _IN_ORDER[kind]
    seen: set[str] = set()
    names = False
    parts = text.split(",") if text.strip() else []
    for place, part in enumerate(parts):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals:
            if names or place >= len(order):
                least = tuple(_NAME_OF[field] for field in order)
                raise _TextError("size_without_name", value=name, kind=kind, first=least)
            field, value = order[place], name
        else:
            names, field = True, _field(kind, name)
        if field in seen:
            raise _TextError("size_twice", size=_NAME_OF[field])
        seen.add(field)
        yield from _value(field, value)


def _field(kind: ToolKind, name: str) -> str:
    needed, others = OF_KIND[kind]
    known = [_NAME_OF[field] for field in dict.fromkeys((*needed, *others, *OF_BODY, "holder"))]
    if name not in known:
        near = meant_word(name, known)
        if near:
            raise _TextError("no_size_but_near", kind=kind, name=name, near=near, known=tuple(known))
        raise _TextError("no_size", kind=kind, name=name, known=tuple(known))
    return _NAMES[name]


def _value(field: str, text: str) -> Iterator[tuple[str, Any]]:
    if field == "holder":
        yield "holder", _pieces(field, text)
    elif field == "shank_diameter" and "x" in text:
        yield "shank", _pieces("shank", text)
    else:
        yield field, _number(_NAME_OF[field], text)


def _number(name: str, text: str) -> float:
    if not _NUMBER.fullmatch(text) or not math.isfinite(float(text)) or float(text) == 0.0:
        raise _TextError("no_angle" if name.endswith("angle") else "no_length", name=name, value=text)
    return float(text)


def _pieces(name: str, text: str) -> tuple[BodyPiece, ...]:
    """Pieces of a holder or a shank from below to above: 40x50 a cylinder, 30-40x20 a cone."""
    found = []
    for part in text.split("/"):
        match = _PIECE.fullmatch(part.strip())
        if not match:
            raise _TextError("no_piece", name=name, piece=part)
        low = _number(name, match["low"])
        high = _number(name, match["high"]) if match["high"] else low
        found.append(BodyPiece(low, high, _number(name, match["height"])))
    return tuple(found)
