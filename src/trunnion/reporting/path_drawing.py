"""The set-up as a line drawing: tool path, zero and bodies, seen from the front, the right and above.

In:     the run of a program, and meshes of stock and part if there are any; workpiece frame, mm.
Out:    SVG of a bounded size, however long the program: lines that fall on each other are drawn once.
"""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.model.run import Run
from trunnion.model.subdivision import subdivide
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.reporting.html_text import escape
from trunnion.reporting.known_tips import KnownTips
from trunnion.reporting.page_words import label

#: Size of the drawing and its margin, in units of which a page is some 700 wide.
_WIDTH, _HEIGHT, _MARGIN = 720, 360, 50

#: Lines of the path, and edges of bodies, at most; the finest step of a drawing, and pieces of an arc.
_MOST_LINES: Final = 8000
_MOST_EDGES: Final = 4000
_FINEST: Final = 0.25
_ARC_PIECES: Final = 24

#: Pieces of all arcs, unless these are so many that each has four.
_MOST_ARC_PIECES: Final = 1 << 21

#: Rows that are looked at together.
_CHUNK: Final = 1 << 16

#: Facets that meet at a smaller angle than this, as its cosine, are one smooth face.
_SMOOTH: Final = 0.9

#: From the front (-Y), the right (+X) and above: rows are to the right, up and towards the viewer.
_TOWARDS = np.array([0.5, -0.8, 0.55])


@dataclass(frozen=True, slots=True, eq=False)
class DrawnBody:
    """A body: ``vertices`` (v, 3), mm, workpiece frame; ``faces`` (f, 3) int; ``kind`` stock, part or fixture."""

    kind: str
    vertices: Floats
    faces: Ints


def path_drawing(run: Run, bodies: Sequence[DrawnBody] = ()) -> str:
    """Return the drawing as an SVG element; empty if nothing is known of the path."""
    view = _view()
    tips, cutting = _known_tips(run)
    if not len(tips):
        return ""
    flat = tips @ view[:2].T
    edges = [(body.kind, _feature_edges(body) @ view[:2].T) for body in bodies]
    every = np.concatenate([flat, np.zeros((1, 2)), *(each.reshape(-1, 2) for _, each in edges)])
    every = every[np.isfinite(every).all(axis=1)]
    low, high = every.min(axis=0), every.max(axis=0)
    room = np.array([_WIDTH, _HEIGHT]) - 2 * _MARGIN
    scale = float(np.min(room / np.maximum(high - low, 1e-6)))
    centre = (low + high) / 2

    def placed(points: Floats) -> Floats:
        found: Floats = (points - centre) * (scale, -scale) + (_WIDTH / 2, _HEIGHT / 2)
        return found

    parts = [f'<path class="{escape(kind)}" d="{_edge_data(placed(each))}"/>' for kind, each in edges]
    for kind, data in _path_data(placed(flat), cutting):
        parts.append(f'<path class="{kind}" d="{data}"/>')
    parts += _triad(placed(np.zeros((1, 2)))[0], view)
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img"'
    return f'{head} aria-label="{escape(label("path_drawing"))}">' + "".join(parts) + "</svg>"


def _view() -> Floats:
    """Directions to the right, up and towards the viewer as rows, (3, 3)."""
    towards = _TOWARDS / np.linalg.norm(_TOWARDS)
    right = np.cross((0.0, 0.0, 1.0), towards)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


def _known_tips(run: Run) -> tuple[Floats, Ints]:
    """Tips along the path, (k, 3), NaN where it is broken; and 1 for those that a cut leads to, (k,)."""
    known, tips, cutting = KnownTips(run), [np.zeros((0, 3))], [np.zeros(0, np.int64)]
    of_arc = min(_ARC_PIECES, max(4, _MOST_ARC_PIECES // max(int(np.count_nonzero(run.kind == Kind.ARC)), 1)))
    for first in range(0, len(run), _CHUNK):
        rows = slice(first, min(first + _CHUNK, len(run)))
        kind = run.kind[rows]
        pieces = np.where(kind == Kind.ARC, of_arc, 1).astype(np.int64)
        samples = subdivide(run, pieces, rows)
        of = samples.row - first
        here = np.where(known.part(rows.start, rows.stop)[of, None], samples.tip, np.nan)
        tips.append(here)
        cutting.append((kind[of] != Kind.RAPID).astype(np.int64))
    found = np.concatenate(tips)
    return (found if np.isfinite(found).any() else np.zeros((0, 3))), np.concatenate(cutting)


def _path_data(points: Floats, cutting: Ints) -> Iterator[tuple[str, str]]:
    """Path data of rapids and of cuts, each line once, in steps that leave few enough."""
    step = _FINEST
    while True:
        lines, is_cut = _lines(points, cutting, step)
        if len(lines) <= _MOST_LINES:
            break
        step *= 2
    yield "rapid", _polylines(lines[np.flatnonzero(is_cut == 0)], step)
    yield "cut", _polylines(lines[np.flatnonzero(is_cut == 1)], step)


def _lines(points: Floats, cutting: Ints, step: float) -> tuple[Ints, Ints]:
    """Lines between points in whole steps, (k, 4), without those that are points or drawn already; 1 for cuts, (k,)."""
    finite = np.all(np.isfinite(points), axis=1)
    whole = np.rint(np.where(finite[:, None], points, 0.0) / step).astype(np.int64)
    lines = np.concatenate((whole[:-1], whole[1:]), axis=1)
    kept = finite[:-1] & finite[1:] & np.any(whole[:-1] != whole[1:], axis=1)
    lines, is_cut = lines[kept], cutting[1:][kept]
    back = (lines[:, 0] > lines[:, 2]) | ((lines[:, 0] == lines[:, 2]) & (lines[:, 1] > lines[:, 3]))
    turned = np.where(back[:, None], lines[:, [2, 3, 0, 1]], lines)
    base = int(whole.max(initial=0)) + 1  # points are within the drawing
    key = is_cut
    for column in turned.T:
        key = key * base + column
    order = np.sort(np.unique(key, return_index=True)[1])
    return lines[order], is_cut[order]


def _polylines(lines: Ints, step: float) -> str:
    """Path data of lines in whole steps, joined where one begins at the end of the one before."""
    parts, at = list[str](), None
    for x0, y0, x1, y1 in (lines * step).tolist():
        if at != (x0, y0):
            parts.append(f"M{x0:g} {y0:g}")
        parts.append(f"L{x1:g} {y1:g}")
        at = x1, y1
    return "".join(parts)


def _edge_data(edges: Floats) -> str:
    """Path data of single lines, (k, 2, 2); the longest ones if there are too many."""
    if len(edges) > _MOST_EDGES:
        length = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
        edges = edges[np.sort(np.argsort(-length, kind="stable")[:_MOST_EDGES])]
    return "".join(f"M{a[0]:.1f} {a[1]:.1f}L{b[0]:.1f} {b[1]:.1f}" for a, b in edges.tolist())


def _feature_edges(body: DrawnBody) -> Floats:
    """Edges at which two faces meet at an angle, or that belong to one face only, (k, 2, 3)."""
    faces, vertices = body.faces, body.vertices
    normal = np.cross(vertices[faces[:, 1]] - vertices[faces[:, 0]], vertices[faces[:, 2]] - vertices[faces[:, 0]])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-12)[:, None]
    ends = np.sort(np.concatenate((faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]])), axis=1)
    of = np.tile(np.arange(len(faces)), 3)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    ends, of = ends[order], of[order]
    twin = np.zeros(len(ends), np.bool_)
    twin[:-1] = np.all(ends[:-1] == ends[1:], axis=1)
    smooth = np.zeros(len(ends), np.bool_)
    pairs = np.flatnonzero(twin)
    smooth[pairs] = np.einsum("ij,ij->i", normal[of[pairs]], normal[of[pairs + 1]]) > _SMOOTH
    second = np.zeros(len(ends), np.bool_)
    second[1:] = twin[:-1]
    return vertices[ends[~smooth & ~second]]


def _triad(origin: Floats, view: Floats) -> Iterator[str]:
    """Yield the axes at the program zero, with their names."""
    yield f'<circle class="zero" cx="{origin[0]:.1f}" cy="{origin[1]:.1f}" r="3"/>'
    for k, name in enumerate("XYZ"):
        end = origin + 34.0 * view[:2, k] * (1.0, -1.0)
        text = origin + 43.0 * view[:2, k] * (1.0, -1.0)
        yield f'<path class="axis" d="M{origin[0]:.1f} {origin[1]:.1f}L{end[0]:.1f} {end[1]:.1f}"/>'
        yield f'<text x="{text[0]:.1f}" y="{text[1] + 4:.1f}">{name}</text>'
