"""Defects other than gouges: of tools, stock, fixtures, rapids and the spindle. See ``recall``."""

import math
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from tests.support.recall import Defect, Sound, moved_all, program
from tests.support.sweeps import CUBE, CUBE_FACES
from trunnion.model.toolpath import Kind
from trunnion.simulation.meshes import TriangleMesh

GOLDEN: Final = Path(__file__).parents[1] / "golden" / "yl569"
_LONG: Final = "length=75,flutes=40"

#: How far the tool of the contour stands out of its holder, mm: less than the contour is deep.
_HELD: Final = (18, 18.5, 19)

#: Stock of which the contour's first level leaves nothing outside: holders meet the flank only.
_TURNED: Final = "cylinder:98,30,-30"

#: The clamp beside the contour: its bolt, its half width, and how far it reaches from the bolt, mm.
_BOLT, _HALF, _REACH, _TAIL = 66.0, 6.0, 24.0, 6.0


def golden_programs(folder: Path) -> list[Sound]:
    """The published programs of the YL569, each with a stock that it may cut."""
    return [
        program(name, "yl569", (GOLDEN / file).read_text(encoding="utf-8"), stock, [f"{tool},{_LONG}"], cell, folder)
        for name, file, stock, tool, cell in (
            ("YL569 contour", "1_contour_rough.expected.mpf", "cylinder:108,30,-30", "1=flat:16", 1.0),
            ("YL569 hub", "2_hub_rough.expected.mpf", "box:18.5,24,26,30,4,-34", "2=ball:10", 0.5),
            ("YL569 blade", "3_blade_finish.expected.mpf", "box:25,50,34,27,-49,-34", "2=ball:10", 0.5),
        )
    ]


def impeller(text: str, folder: Path, lines: int = 400) -> Sound:
    """The first blade of the LinuxCNC impeller; its tool is taken for a ball mill of 6 mm."""
    beginning = "\n".join([*text.splitlines()[:lines], "M2"])
    return program("LinuxCNC impeller", "xyzac_trt", beginning, "cylinder:80,34,-8", [f"0=ball:6,{_LONG}"], 0.5, folder)


def _feeds(sound: Sound, count: int) -> list[int]:
    """Some moves at feed between others at feed."""
    moves = sound.moves
    rows = [
        k for k in range(3, len(moves) - 3) if all(each.kind == Kind.LINEAR for each in moves[k - 1 : k + 2])
    ]  # fmt: skip
    return rows[:: max(1, len(rows) // count)][:count]


def _all_lines(sound: Sound) -> tuple[int, int]:
    return 1, len(sound.lines)


def wrong_tools(sound: Sound) -> Iterator[Defect]:
    """Yield tools that are too long, and wider ones in their places."""
    lines = moved_all(sound, lambda move: -0.1 * move.axis)
    too_long = replace(sound, lines=lines)
    yield Defect("tool 0.1 mm too long", math.nan, too_long, _all_lines(sound), accuracy=0.02, mm=0.1)
    radius, is_ball = sound.radius(sound.tools[0].partition("=")[0])
    number = sound.tools[0].partition("=")[0]
    for wider in (1.0, 2.0, 4.0):
        form = f"{'ball' if is_ball else 'flat'}:{2.0 * radius + 2.0 * wider:g}"
        swapped = replace(sound, tools=(f"{number}={form},{_LONG}", *sound.tools[1:]))
        yield Defect("swapped tools", math.nan, swapped, _all_lines(sound), ("gouge", "rapid through stock"))


def rapids(sound: Sound, depths: dict[int, float], count: int) -> Iterator[Defect]:
    """Yield rapids in place of a feed, where the sound program cuts by ``depths`` (move -> mm)."""
    deep = [row for row in _feeds(sound, len(sound.moves)) if depths.get(row, 0.0) > 0.5 * sound.cell]
    for row in deep[:: max(1, len(deep) // count)][:count]:
        lines, at, after = list(sound.lines), sound.moves[row].line, sound.moves[row + 1].line
        if sound.is_cl:
            lines[after:after] = ["FEDRAT/MMPM,200.0"]
            lines[at:at] = ["RAPID"]
            right = at + 2, at + 2
        else:
            lines[at], lines[after] = _with_verb(lines[at], "G0"), _with_verb(lines[after], "G1")
            right = at + 1, at + 1
        yield Defect(
            "rapid in place of a feed", math.nan, replace(sound, lines=tuple(lines)), right, ("rapid through stock",)
        )


def _with_verb(line: str, verb: str) -> str:
    number = re.match(r"(N\d+ )?", line)
    start = number.group() if number else ""
    return f"{start}{verb} {re.sub(r'^G0?[01](?![0-9])', '', line[len(start) :]).strip()}"


def standing(sound: Sound, count: int) -> Iterator[Defect]:
    """Yield programs that stop the spindle on the way."""
    if sound.is_cl:
        return
    for row in _feeds(sound, count):
        lines, at = list(sound.lines), sound.moves[row].line
        lines.insert(at, "M5")
        right = at + 1, len(lines)
        told = ("cuts with the spindle off",)
        yield Defect("spindle off", math.nan, replace(sound, lines=tuple(lines)), right, told)


def setups_of_plate(sound: Sound) -> Iterator[Defect]:
    """Yield what a plate's set-up may have wrong: stock that stands too high, retracts that are missing."""
    whole = _all_lines(sound)
    for higher in (4.0, 5.0, 6.0, 8.0):
        shifted = replace(sound, stock=f"box:80,60,{20 + higher:g},-40,-30,-20")
        yield Defect("shifted stock", math.nan, shifted, whole, ("rapid through stock",))
    for aside in (14.0, 18.0, 22.0):
        shifted = replace(sound, stock=f"box:80,60,45,{-40 + aside:g},{-30 + aside:g},-20")
        yield Defect("shifted stock", math.nan, shifted, whole, ("rapid through stock",))
    moves = sound.moves
    for row in range(1, len(moves) - 1):
        before, move, after = moves[row - 1 : row + 2]
        if move.kind == after.kind == Kind.RAPID and before.kind != Kind.RAPID and move.tool == after.tool:
            lines = list(sound.lines)
            if abs(after.tip[2] - 3.0) > 1e-9:
                continue
            del lines[move.line - 1 : move.line + 1]
            at = after.line - 1
            right = at - 1, at
            yield Defect(
                "missing retract", math.nan, replace(sound, lines=tuple(lines)), right, ("rapid through stock",)
            )


def clamp(turned: float) -> TriangleMesh:
    """A clamp beside the contour, turned by an angle about its bolt, deg: at 0 its long end points away."""
    low, high = np.array((-_TAIL, -_HALF, -30.0)), np.array((_REACH, _HALF, 2.0))
    corners = low + CUBE * (high - low)
    c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    x, y = corners[:, 0].copy(), corners[:, 1].copy()
    corners[:, 0], corners[:, 1] = _BOLT + c * x - s * y, s * x + c * y
    return TriangleMesh(corners, CUBE_FACES, "clamp")


def setups_of_contour(sound: Sound) -> Iterator[Defect]:
    """Yield turned fixtures and wide holders at the contour.

    Its flank leans: a holder of 20 mm clears it (``sound_contour_setups``), 16 mm from the tool's axis is stock.
    Shorter tools bring any holder into stock, as the program leaves out the levels between Z-2.97 and Z-18.8.
    """
    whole = _all_lines(sound)
    for turned in (150, 160, 165, 170, 175, 180, 185, 190, 195, 200):
        yield Defect("turned fixture", math.nan, sound, whole, ("collision",), (clamp(turned),))
    for length in _HELD:
        for wide in (32, 40, 50):
            held = replace(sound, stock=_TURNED, tools=(f"1=flat:16,length={length},flutes={length},holder={wide}x50",))
            yield Defect("holder too large", math.nan, held, whole, ("holder into stock",))


def sound_contour_setups(sound: Sound) -> Iterator[Sound]:
    """Yield the contour with holders of the right size: none may be told."""
    for length in _HELD:
        yield replace(sound, stock=_TURNED, tools=(f"1=flat:16,length={length},flutes={length},holder=20x50",))
