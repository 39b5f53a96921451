"""A picture of what a machine reaches, as SVG.

In:     ``ReachPicture``.
Out:    the text of the picture: to the left the sphere of tool axes as seen along the workpiece's Z, tilts as rings and
        azimuths around them; to the right the volume of tips over the tilt.
"""

import math
from collections.abc import Iterator, Sequence
from html import escape
from typing import Final

from trunnion.records import dataclass
from trunnion.reporting.page_words import label

_WIDTH: Final = 1040.0
_HEIGHT: Final = 480.0
_CENTRE: Final = (240.0, 246.0)
_RADIUS: Final = 184.0

#: The graph: left, right, top and bottom.
_GRAPH: Final = (540.0, 1010.0, 70.0, 430.0)

#: Tilts that have a ring and a mark, degrees.
_MARKS: Final = (30, 60, 90, 120, 150, 180)

_LITRE: Final = 1e6

_STYLE: Final = """<style>
svg { background: #fff; font: 13px sans-serif; fill: #222 }
.none { fill: #eceff1 } .one { fill: #8fb7d9 } .two { fill: #1b5e9e }
.ring { fill: none; stroke: #fff; stroke-width: 0.8 }
.axis { fill: none; stroke: #777; stroke-width: 0.8 }
.grid { fill: none; stroke: #ddd; stroke-width: 0.7 }
.some { stroke: #1b5e9e } .every { stroke: #b26a00 } .pose { stroke: #777; stroke-dasharray: 4 3 }
.line { fill: none; stroke-width: 1.8 }
.band-some { fill: #1b5e9e; opacity: 0.18 } .band-every { fill: #b26a00; opacity: 0.22 }
.path { fill: none; stroke: #c62828; stroke-width: 1.4 }
.note { fill: #555; font-size: 11px }
</style>"""


@dataclass(frozen=True, slots=True)
class TiltOfPicture:
    """One tilt, degrees: branches at azimuths from 0 degrees on, and volumes, mm^3, as (least, likely, most)."""

    tilt: float
    branches: Sequence[int]
    one_pose: float
    some: tuple[float, float, float] | None
    every: tuple[float, float, float] | None


@dataclass(frozen=True, slots=True)
class ReachPicture:
    """What the picture shows.

    title  of the whole
    tilts  from 0 to 180 degrees
    step   degrees between them
    paths  names of CL files, and their least and greatest tilt
    """

    title: str
    tilts: Sequence[TiltOfPicture]
    step: float
    paths: Sequence[tuple[str, float, float]] = ()


def reach_picture(content: ReachPicture) -> str:
    """Return the picture."""
    size = f'width="{_WIDTH:g}" height="{_HEIGHT:g}" viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}"'
    body = "".join((*_sphere(content), *_graph(content)))
    title = f'<text x="28" y="26">{escape(content.title)}</text>\n'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n{_STYLE}\n{title}{body}</svg>\n'


def _sphere(content: ReachPicture) -> Iterator[str]:
    """Yield the sphere of tool axes, all of it in one disc: the distance from the middle is the tilt."""
    x, y = _CENTRE
    yield f'<circle class="none" cx="{x:g}" cy="{y:g}" r="{_RADIUS:g}"/>\n'
    for each in content.tilts:
        low, high = max(each.tilt - content.step / 2.0, 0.0), min(each.tilt + content.step / 2.0, 180.0)
        for first, last, count in _runs(each.branches):
            if count:
                outline = _sector(low, high, first, last, len(each.branches))
                yield f'<path class="{"one" if count == 1 else "two"}" fill-rule="evenodd" d="{outline}"/>\n'
    for mark in _MARKS:
        yield f'<circle class="ring" cx="{x:g}" cy="{y:g}" r="{_ring(mark):.2f}"/>\n'
        yield f'<text class="note" x="{x + 3:g}" y="{y - _ring(mark) + 11:.2f}">{mark}°</text>\n'
    for _, least, most in content.paths:
        yield f'<circle class="path" cx="{x:g}" cy="{y:g}" r="{_ring(most):.2f}"/>\n'
        if least > 0.0:
            yield f'<circle class="path" cx="{x:g}" cy="{y:g}" r="{_ring(least):.2f}"/>\n'
    yield f'<text class="note" x="{x + _RADIUS + 4:g}" y="{y + 4:g}">+X</text>\n'
    yield f'<text class="note" x="{x - 8:g}" y="{y - _RADIUS - 5:g}">+Y</text>\n'
    notes = [escape(label("reach_sphere"))]
    notes += [escape(label("reach_paths"))] if content.paths else []
    for k, note in enumerate(notes):
        yield f'<text class="note" x="28" y="{_HEIGHT - 24 + 14 * k:g}">{note}</text>\n'


def _runs(branches: Sequence[int]) -> Iterator[tuple[int, int, int]]:
    """First azimuth, the one after the last, and the number, of each run of the same number of branches."""
    start = 0
    for k in range(1, len(branches) + 1):
        if k == len(branches) or branches[k] != branches[start]:
            yield start, k, branches[start]
            start = k


def _ring(tilt: float) -> float:
    return _RADIUS * tilt / 180.0


def _sector(low: float, high: float, first: int, last: int, count: int) -> str:
    """Return the outline of a piece of a ring; azimuths stand for half a step to both sides."""
    inner, outer = _ring(low), _ring(high)
    if last - first == count:
        return _circle(outer) + (_circle(inner) if inner else "")
    begin, end = (2.0 * math.pi * (each - 0.5) / count for each in (first, last))
    large = int(end - begin > math.pi)
    return (
        f"M{_at(outer, begin)}A{outer:.2f} {outer:.2f} 0 {large} 0 {_at(outer, end)}"
        f"L{_at(inner, end)}A{inner:.2f} {inner:.2f} 0 {large} 1 {_at(inner, begin)}Z"
    )


def _circle(radius: float) -> str:
    """Return a whole circle in two halves; of two circles the even-odd rule fills what is between them."""
    return f"M{_at(radius, 0.0)}A{radius:.2f} {radius:.2f} 0 1 0 {_at(radius, math.pi)}" + (
        f"A{radius:.2f} {radius:.2f} 0 1 0 {_at(radius, 0.0)}Z"
    )


def _at(radius: float, azimuth: float) -> str:
    return f"{_CENTRE[0] + radius * math.cos(azimuth):.2f} {_CENTRE[1] - radius * math.sin(azimuth):.2f}"


def _graph(content: ReachPicture) -> Iterator[str]:
    """Volumes over the tilt."""
    left, right, top, bottom = _GRAPH
    drawn = [each for each in content.tilts if each.some is not None and each.every is not None]
    if not drawn:
        yield f'<text class="note" x="{left:g}" y="{top:g}">{escape(label("reach_no_volumes"))}</text>\n'
        return
    most = max(each.some[2] for each in drawn if each.some is not None) or 1.0
    top_value = _round_up(most / _LITRE)

    def place(tilt: float, volume: float) -> str:
        x = left + tilt / 180.0 * (right - left)
        return f"{x:.2f} {bottom - volume / _LITRE / top_value * (bottom - top):.2f}"

    for part in range(5):
        value = top_value * part / 4.0
        y = bottom - part / 4.0 * (bottom - top)
        yield f'<path class="grid" d="M{left:g} {y:.2f}H{right:g}"/>\n'
        yield f'<text class="note" x="{left - 6:g}" y="{y + 4:.2f}" text-anchor="end">{value:g} l</text>\n'
    for mark in (0, *_MARKS):
        x = left + mark / 180.0 * (right - left)
        yield f'<text class="note" x="{x:.2f}" y="{bottom + 16:g}" text-anchor="middle">{mark}°</text>\n'
    yield f'<path class="axis" d="M{left:g} {top:g}V{bottom:g}H{right:g}"/>\n'
    for stretch in _stretches(drawn):
        for kind in ("some", "every"):
            values = [(each.tilt, each.some if kind == "some" else each.every) for each in stretch]
            known = [(tilt, volume) for tilt, volume in values if volume is not None]
            upper = [place(tilt, volume[2]) for tilt, volume in known]
            lower = [place(tilt, volume[0]) for tilt, volume in reversed(known)]
            yield f'<path class="band-{kind}" d="M{"L".join(upper + lower)}Z"/>\n'
            yield f'<path class="line {kind}" d="M{"L".join(place(tilt, volume[1]) for tilt, volume in known)}"/>\n'
        yield f'<path class="line pose" d="M{"L".join(place(each.tilt, each.one_pose) for each in stretch)}"/>\n'
    legend = (("some", "reach_some"), ("every", "reach_every"), ("pose", "reach_pose"))
    for k, (kind, name) in enumerate(legend):
        x = left + 150.0 * k
        yield f'<path class="line {kind}" d="M{x:g} {top - 22:g}h22"/>\n'
        yield f'<text class="note" x="{x + 28:g}" y="{top - 18:g}">{escape(label(name))}</text>\n'
    note = escape(label("reach_volumes"))
    yield f'<text class="note" x="{left:g}" y="{_HEIGHT - 24:g}">{note}</text>\n'


def _stretches(tilts: Sequence[TiltOfPicture]) -> Iterator[list[TiltOfPicture]]:
    """Tilts one after the other that can be had."""
    stretch: list[TiltOfPicture] = []
    for each in tilts:
        if any(each.branches):
            stretch.append(each)
        elif stretch:
            yield stretch
            stretch = []
    if stretch:
        yield stretch


def _round_up(value: float) -> float:
    """Return the next number above of few digits."""
    if value <= 0.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(
        factor * power
        for factor in (1.0, 1.6, 2.0, 2.4, 3.2, 4.0, 6.0, 8.0, 10.0)
        if factor * power >= value * (1.0 - 1e-12)
    )
