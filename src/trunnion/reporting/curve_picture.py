"""A picture of curves with their curvature combs, as SVG.

In:     ``CurveFit`` of each curve.
Out:    the text of the picture: to the left each curve in the plane in which it is widest, to the right its curvature
        over its length.

A tooth of the comb stands on the outer side of the bend, as long as the curvature times a factor that the picture
tells. Teeth and peaks are cut off where they would leave it, and then drawn in red.
"""

from collections.abc import Iterator, Sequence
from html import escape
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.geometry.fitting import CurveFit
from trunnion.records import dataclass
from trunnion.reporting.page_words import label

_WIDTH: Final = 1040.0
_HEIGHT: Final = 340.0
_VIEW: Final = 460.0
_MARGIN: Final = 48.0

_SAMPLES: Final = 600

#: One sample in so many has a tooth.
_EVERY: Final = 4

#: Part of the view that a tooth takes for the curvature that one sample in twenty exceeds, and the most of any.
_TOOTH: Final = 0.12
_LONGEST: Final = 0.28

_USUAL: Final = 95.0

_STYLE: Final = """<style>
svg { background: #fff; font: 13px sans-serif; fill: #222 }
.curve { fill: none; stroke: #1b5e9e; stroke-width: 1.6 }
.comb { stroke: #8fb7d9; stroke-width: 0.7 }
.cut { stroke: #c62828; stroke-width: 0.9 }
.polygon { fill: none; stroke: #999; stroke-width: 0.7; stroke-dasharray: 4 3 }
.axis { fill: none; stroke: #777; stroke-width: 0.8 }
.point { fill: #222 }
.note { fill: #555; font-size: 11px }
</style>"""


@dataclass(frozen=True, slots=True, eq=False)
class _Samples:
    """A curve at many parameters: places, curvature vectors and lengths from the start."""

    points: Floats
    curvatures: Floats
    lengths: Floats

    @property
    def bend(self) -> Floats:
        """Curvatures, 1/mm."""
        return np.asarray(np.linalg.norm(self.curvatures, axis=1))

    @property
    def usual(self) -> float:
        """The curvature that few samples exceed, 1/mm."""
        return max(float(np.percentile(self.bend, _USUAL)), 1e-9)


def curve_picture(fits: Sequence[CurveFit]) -> str:
    """Return the picture of curves, one below the other."""
    height = _HEIGHT * len(fits)
    rows = "\n".join(
        f'<g transform="translate(0 {k * _HEIGHT:g})">\n{"".join(_row(one))}</g>' for k, one in enumerate(fits)
    )
    size = f'width="{_WIDTH:g}" height="{height:g}" viewBox="0 0 {_WIDTH:g} {height:g}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>\n{_STYLE}\n{rows}\n</svg>\n'


def _row(fitted: CurveFit) -> Iterator[str]:
    at = np.linspace(0.0, 1.0, _SAMPLES + 1)
    curve = fitted.curve
    samples = _Samples(curve.points(at), curve.curvatures(at), np.r_[0.0, np.cumsum(curve.lengths(at))])
    count = len(fitted.curve.control_points)
    name = fitted.name or label("curve_without_name")
    title = label("curve_points", name=name, points=len(fitted.points), count=count, length=fitted.length)
    yield f'<text x="{_MARGIN:g}" y="22">{escape(title)}</text>\n'
    yield from _view(fitted, samples)
    yield from _graph(samples)


def _view(fitted: CurveFit, samples: _Samples) -> Iterator[str]:
    """Yield the curve in its plane, with points, control polygon and comb."""
    middle = samples.points.mean(axis=0)
    plane = np.linalg.svd(samples.points - middle, full_matrices=False)[2][:2]
    flat = (samples.points - middle) @ plane.T
    room = np.array([_VIEW, _HEIGHT]) - 2.0 * _MARGIN
    scale = float((room * (1.0 - _TOOTH) / np.maximum(np.ptp(flat, axis=0), 1e-9)).min())
    centre = np.array([_VIEW, _HEIGHT + _MARGIN / 2.0]) / 2.0
    lowest, highest = flat.min(axis=0), flat.max(axis=0)

    def place(points: Floats) -> Floats:
        return np.asarray(((points - middle) @ plane.T - (lowest + highest) / 2.0) * scale * [1.0, -1.0] + centre)

    longest = _LONGEST * float(room.min())
    factor = _TOOTH * float(room.min()) / samples.usual
    teeth = -samples.curvatures @ plane.T * factor * [1.0, -1.0]
    size = np.linalg.norm(teeth, axis=1)
    teeth *= np.minimum(1.0, longest / np.maximum(size, 1e-12))[:, None]
    foot = place(samples.points)
    for kind, chosen in (("comb", size <= longest), ("cut", size > longest)):
        drawn = np.flatnonzero(chosen)[:: 1 if kind == "cut" else _EVERY]
        lines = "".join(
            f"M{x:.2f} {y:.2f}l{dx:.2f} {dy:.2f}" for (x, y), (dx, dy) in zip(foot[drawn], teeth[drawn], strict=True)
        )
        if lines:
            yield f'<path class="{kind}" d="{lines}"/>\n'
    yield f'<path class="polygon" d="{_path(place(fitted.curve.control_points))}"/>\n'
    yield f'<path class="curve" d="{_path(foot)}"/>\n'
    for x, y in place(fitted.points):
        yield f'<circle class="point" cx="{x:.2f}" cy="{y:.2f}" r="2"/>\n'
    note = escape(label("curve_tooth", curvature=10.0 * scale / factor))
    yield f'<text class="note" x="{_MARGIN:g}" y="{_HEIGHT - 8:g}">{note}</text>\n'


def _graph(samples: _Samples) -> Iterator[str]:
    """Curvature over length."""
    left, right, top, low = _VIEW + _MARGIN, _WIDTH - _MARGIN / 2.0, 40.0, _HEIGHT - 40.0
    highest = 1.6 * samples.usual
    x = left + samples.lengths / max(float(samples.lengths[-1]), 1e-12) * (right - left)
    y = low - np.minimum(samples.bend / highest, 1.0) * (low - top)
    yield f'<path class="axis" d="M{left:g} {top:g}V{low:g}H{right:g}"/>\n'
    yield f'<path class="curve" d="{_path(np.column_stack((x, y)))}"/>\n'
    beyond = samples.bend > highest
    if beyond.any():
        marks = "".join(f"M{each:.2f} {top - 6:g}v6" for each in x[beyond])
        yield f'<path class="cut" d="{marks}"/>\n'
        text = escape(label("curve_up_to", curvature=samples.bend.max()))
        yield f'<text class="note" x="{right:g}" y="{top - 10:g}" text-anchor="end">{text}</text>\n'
    text = escape(label("curve_top", curvature=highest))
    yield f'<text class="note" x="{left + 4:g}" y="{top + 10:g}">{text}</text>\n'
    yield f'<text class="note" x="{right:g}" y="{low + 16:g}" text-anchor="end">{samples.lengths[-1]:.3f} mm</text>\n'


def _path(places: Floats) -> str:
    return "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in places)
