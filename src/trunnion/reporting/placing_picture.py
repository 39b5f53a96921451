"""A picture of where a part may sit, as SVG.

In:     a ``Placement``.
Out:    the text of the picture: to the left the margin over X and Y of the zero at the height and the turn of the best
        place, to the right the best margin over the turns.

Margins are bands of a scale from dark blue to yellow, which people see alike whatever colours they see; where the part
does not fit it is grey, and hatched.
"""

from collections.abc import Iterator
from html import escape
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.placing.placement import Placement
from trunnion.reporting.page_words import label

_WIDTH: Final = 980.0
_HEIGHT: Final = 484.0
_SIDE: Final = 380.0
_LEFT: Final = 62.0
_TOP: Final = 44.0

#: Fields of the map along each side.
_FIELDS: Final = 72

#: The scale, from a margin of 0 to the largest one (cividis).
_BANDS: Final = ("#00224e", "#213d6b", "#4c556c", "#6c6e72", "#8d8878", "#b1a570", "#d6c35d", "#fee838")

#: How far a map reaches where the region is open, mm.
_OPEN: Final = 500.0

_STYLE: Final = """<style>
svg { background: #fff; font: 13px sans-serif; fill: #222 }
.frame { fill: none; stroke: #777; stroke-width: 0.8 }
.curve { fill: none; stroke: #1b5e9e; stroke-width: 1.8 }
.zero { stroke: #c62828; stroke-width: 1; stroke-dasharray: 5 3 }
.best { fill: none; stroke: #fff; stroke-width: 2.4 }
.ring { fill: none; stroke: #000; stroke-width: 1.2 }
.note { fill: #555; font-size: 11px }
.out { stroke: #c62828; stroke-width: 1.4 }
</style>
<defs><pattern id="no" width="7" height="7" patternUnits="userSpaceOnUse">
<rect width="7" height="7" fill="#d9d9d9"/><path d="M0 7L7 0" stroke="#aaa" stroke-width="1"/></pattern></defs>"""


def placing_picture(found: Placement) -> str:
    """Return the picture; ``found`` has a best place."""
    assert found.best is not None
    body = "".join((*_map(found), *_turns(found)))
    size = f'width="{_WIDTH:g}" height="{_HEIGHT:g}" viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n{_STYLE}\n{body}</svg>\n'


def map_margins(found: Placement, fields: int = _FIELDS) -> tuple[Floats, Floats, Floats]:
    """X (k,) and Y (k,) of the fields of the map, mm, and the margins there, (k, k) by Y and X."""
    best = found.best
    assert best is not None
    zero = np.array(best.zero_mm)
    low, high = zero[:2] - 0.5 * _OPEN, zero[:2] + 0.5 * _OPEN
    if found.region is not None:
        low = np.where(np.isfinite(found.region.low[:2]), found.region.low[:2], low)
        high = np.where(np.isfinite(found.region.high[:2]), found.region.high[:2], high)
    side = 1.12 * max(float((high - low).max()), 1.0)
    x, y = ((low[k] + high[k]) / 2.0 + side * ((np.arange(fields) + 0.5) / fields - 0.5) for k in range(2))
    margins = np.array(
        [
            [found.margin_at((a, b, best.zero_mm[2]), best.turn_deg, best.tilt_deg) for a in x.tolist()]
            for b in y.tolist()
        ]
    )
    return x, y, margins


def _map(found: Placement) -> Iterator[str]:
    best = found.best
    assert best is not None
    x, y, margins = map_margins(found)
    step = float(x[1] - x[0])
    top = max(float(margins.max()), best.margin_mm, 1e-9)
    place = {"machine": found.machine, "z": best.zero_mm[2], "turn": best.turn_deg}
    title = label("margin_tilted", tilt=best.tilt_deg, **place) if best.tilt_deg else label("margin_turned", **place)
    yield f'<text x="{_LEFT:g}" y="24">{escape(title)}</text>\n'
    size = _SIDE / len(x)
    band = np.where(margins < 0.0, -1, np.minimum(len(_BANDS) * margins / top, len(_BANDS) - 1).astype(np.int64))
    for k, row in enumerate(band):
        ends = np.flatnonzero(np.append(np.diff(row) != 0, True)) + 1
        first = 0
        for end in ends.tolist():
            fill = "url(#no)" if row[first] < 0 else _BANDS[int(row[first])]
            side, below = _LEFT + first * size, _TOP + _SIDE - (k + 1) * size
            yield _field(side, below, (end - first) * size + 0.4, size + 0.4, fill)
            first = end
    yield f'<rect class="frame" x="{_LEFT:g}" y="{_TOP:g}" width="{_SIDE:g}" height="{_SIDE:g}"/>\n'

    def at(a: float, b: float) -> tuple[float, float]:
        return _LEFT + ((a - float(x[0])) / step + 0.5) * size, _TOP + _SIDE - ((b - float(y[0])) / step + 0.5) * size

    px, py = at(best.zero_mm[0], best.zero_mm[1])
    for mark, radius in (("best", 6.0), ("ring", 7.6)):
        yield f'<circle class="{mark}" cx="{px:.1f}" cy="{py:.1f}" r="{radius:g}"/>\n'
    if found.present is not None:
        px, py = at(found.present.zero_mm[0], found.present.zero_mm[1])
        inside = _LEFT <= px <= _LEFT + _SIDE and _TOP <= py <= _TOP + _SIDE
        if inside:
            cross = f"M{px - 6:.1f} {py - 6:.1f}l12 12m0 -12l-12 12"
            yield f'<path class="best" d="{cross}"/><path class="ring" d="{cross}"/>\n'
    yield from _scales(x, y)
    yield from _legend(top, found.present is not None)


def _scales(x: Floats, y: Floats) -> Iterator[str]:
    size = _SIDE / len(x)
    for value in _ticks(float(x[0]), float(x[-1])):
        px = _LEFT + ((value - x[0]) / (x[1] - x[0]) + 0.5) * size
        yield f'<text class="note" x="{px:.1f}" y="{_TOP + _SIDE + 15:g}" text-anchor="middle">{value:g}</text>\n'
    for value in _ticks(float(y[0]), float(y[-1])):
        py = _TOP + _SIDE - ((value - y[0]) / (y[1] - y[0]) + 0.5) * size
        yield f'<text class="note" x="{_LEFT - 6:g}" y="{py + 4:.1f}" text-anchor="end">{value:g}</text>\n'
    end = f'x="{_LEFT + _SIDE:g}" y="{_TOP + _SIDE + 30:g}" text-anchor="end"'
    yield f'<text class="note" {end}>{escape(label("x_of_zero"))}</text>\n'
    yield f'<text class="note" x="{_LEFT - 50:g}" y="{_TOP - 6:g}">Y, mm</text>\n'


def _legend(top: float, present: bool) -> Iterator[str]:
    """Yield the bands with their margins, and the marks."""
    left, width = _LEFT + _SIDE + 14.0, 14.0
    height = _SIDE / (len(_BANDS) + 1)
    for k, colour in enumerate(_BANDS):
        below = _TOP + _SIDE - (k + 2) * height
        yield _field(left, below, width, height, colour)
        yield f'<text class="note" x="{left + 19:g}" y="{below + height + 4:.1f}">{top * k / len(_BANDS):.3g}</text>\n'
    yield _field(left, _TOP + _SIDE - height, width, height, "url(#no)")
    yield f'<text class="note" x="{left + 19:g}" y="{_TOP + 4:g}">{top:.3g}</text>\n'
    marks = escape(label("place_marks_with_present" if present else "place_marks"))
    yield f'<text class="note" x="{_LEFT:g}" y="{_TOP + _SIDE + 48:g}">{marks}</text>\n'


def _turns(found: Placement) -> Iterator[str]:
    """Yield the best margin over the turns; marks at the foot where rotary axes do not reach the path."""
    left, right, top, low = _LEFT + _SIDE + 120.0, _WIDTH - 24.0, _TOP, _TOP + _SIDE
    tilt = 0.0 if found.best is None else found.best.tilt_deg
    tried = [turn for turn in found.turns if turn.tilt_deg == tilt]
    turns = [turn for turn in tried if turn.margin_mm is not None]
    margins = np.array([turn.margin_mm for turn in turns], np.float64)
    yield f'<text x="{left:g}" y="24">{escape(label("best_margin_over_turn"))}</text>\n'
    yield f'<path class="frame" d="M{left:g} {top:g}V{low:g}H{right:g}"/>\n'
    if not len(margins):
        return
    least, most = min(float(margins.min()), 0.0), max(float(margins.max()), 0.0)
    room = max(0.08 * (most - least), 1e-6)
    least, most = least - room, most + room
    begin, end = tried[0].turn_deg, max(tried[-1].turn_deg, tried[0].turn_deg + 1e-9)

    def at(turn: float, margin: float) -> str:
        px = left + (turn - begin) / (end - begin) * (right - left)
        return f"{px:.1f} {low - (margin - least) / (most - least) * (low - top):.1f}"

    yield f'<path class="zero" d="M{at(begin, 0.0)}L{at(end, 0.0)}"/>\n'
    path, draws = "", "M"
    for turn in tried:
        if turn.margin_mm is None:
            draws = "M"
            px = at(turn.turn_deg, least).split()[0]
            yield f'<path class="out" d="M{px} {low - 7:g}v7"/>\n'
            continue
        path += draws + at(turn.turn_deg, turn.margin_mm)
        draws = "L"
    yield f'<path class="curve" d="{path}"/>\n'
    if found.best is not None:
        px, py = at(found.best.turn_deg, found.best.margin_mm).split()
        yield f'<circle class="ring" cx="{px}" cy="{py}" r="5"/>\n'
    for value in _ticks(least, most):
        py = at(begin, value).split()[1]
        yield f'<text class="note" x="{left - 6:g}" y="{float(py) + 4:.1f}" text-anchor="end">{value:g}</text>\n'
    for value in _ticks(begin, end):
        px = at(value, 0.0).split()[0]
        yield f'<text class="note" x="{px}" y="{low + 15:g}" text-anchor="middle">{value:g}</text>\n'
    text = escape(label("turn_about_z"))
    yield f'<text class="note" x="{right:g}" y="{low + 30:g}" text-anchor="end">{text}</text>\n'


def _field(x: float, y: float, width: float, height: float, fill: str) -> str:
    return f'<rect x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}" fill="{fill}"/>\n'


def _ticks(low: float, high: float) -> list[float]:
    """Return a few round numbers between two."""
    span = max(high - low, 1e-9)
    step = 10.0 ** np.floor(np.log10(span / 4.0))
    step *= next(factor for factor in (1.0, 2.0, 5.0, 10.0) if span / (step * factor) <= 6.0)
    return [float(round(k * step, 9)) + 0.0 for k in range(int(np.ceil(low / step)), int(np.floor(high / step)) + 1)]
