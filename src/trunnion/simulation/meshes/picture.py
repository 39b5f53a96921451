"""Pictures of meshes as PNG, drawn without a screen: triangles into a depth buffer, light by their normals.

In:     a mesh, the direction from which it is seen, and the colours of its vertices if they are not to be plain.
Out:    the bytes of a PNG file with at most 256 colours.
Units:  mm; angles in degrees. The picture is parallel, without perspective: equal lengths are equal everywhere.
"""

import math
import struct
import zlib
from typing import Annotated, Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Floats2, Ints2
from trunnion.jit import kernel
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh

#: The facet at each pixel, -1 for none.
Facets2: TypeAlias = Annotated[NDArray[np.int32], 2]

#: Width and height of a picture, pixels, and how many times finer it is drawn.
SIZE: Final = (960, 720)
_FINER: Final = 2

#: Part of the picture that the body fills.
_FILLED: Final = 0.94

#: Colour of plain metal, and of the ground.
_METAL: Final = (0.77, 0.77, 0.77)
_GROUND: Final = (1.0, 1.0, 1.0)

#: Light that comes from everywhere, from over the left shoulder, and from the right; directions right, up, to the eye.
_AMBIENT: Final = 0.30
_LIGHTS: Final = (((-0.45, 0.65, 0.62), 0.62), ((0.80, 0.10, 0.55), 0.22))

#: Steps of a colour in the file, of 255.
_STEP: Final = 2

#: How much hollows are darkened, and over what part of the picture's width they are looked for.
_HOLLOW: Final = 0.55
_REACH: Final = 0.02


def picture(
    mesh: TriangleMesh,
    *,
    colours: Floats | None = None,
    azimuth: float = -60.0,
    elevation: float = 35.0,
    size: tuple[int, int] = SIZE,
) -> bytes:
    """Draw a mesh.

    mesh                with at least one facet, seen from outside; its Z points up in the picture
    colours             of its vertices, (n, 3), red, green and blue from 0 to 1; by default plain metal
    azimuth, elevation  from where it is seen: 0 is from +X, 90 from +Y; 90 is from above
    size                width and height in pixels
    """
    width, height = size[0] * _FINER, size[1] * _FINER
    seen = mesh.vertices @ _view(azimuth, elevation).T
    low, high = seen.min(axis=0), seen.max(axis=0)
    scale = _FILLED * min(width / max(high[0] - low[0], 1e-9), height / max(high[1] - low[1], 1e-9))
    middle = 0.5 * (low + high)
    points = np.empty_like(seen)
    points[:, 0] = 0.5 * width + scale * (seen[:, 0] - middle[0])
    points[:, 1] = 0.5 * height - scale * (seen[:, 1] - middle[1])
    points[:, 2] = scale * (seen[:, 2] - low[2])
    depth, facet = np.zeros((height, width)), np.full((height, width), -1, np.int32)
    draw_triangles(points, mesh.faces, depth, facet)
    hit = facet >= 0
    corners = seen[mesh.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    light = np.full(len(normal), _AMBIENT)
    for direction, strength in _LIGHTS:
        light += strength * np.maximum(normal @ (np.array(direction) / np.linalg.norm(direction)), 0.0)
    own = np.tile(_METAL, (len(normal), 1)) if colours is None else colours[mesh.faces].mean(axis=1)
    image = np.tile(np.array(_GROUND), (height, width, 1))
    image[hit] = (own * light[:, None])[facet[hit]] * _open(depth, hit, max(2, int(_REACH * width)))[:, None]
    fine = np.clip(image, 0.0, 1.0).reshape(size[1], _FINER, size[0], _FINER, 3).mean(axis=(1, 3))
    return _png(np.round(255.0 * fine).astype(np.uint8))


def _view(azimuth: float, elevation: float) -> Floats:
    """Return the directions right, up and towards the eye, (3, 3)."""
    a, e = math.radians(azimuth), math.radians(elevation)
    right = (-math.sin(a), math.cos(a), 0.0)
    up = (-math.sin(e) * math.cos(a), -math.sin(e) * math.sin(a), math.cos(e))
    return np.array([right, up, (math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))])


def _open(depth: Floats, hit: NDArray[np.bool_], reach: int) -> Floats:
    """How much light reaches each pixel of the body: less where what is around it is nearer to the eye."""
    around, wide = depth, 2 * reach + 1
    for _ in range(2):  # along columns, then along rows
        padded = np.pad(around, ((reach + 1, reach), (0, 0)), mode="edge")
        total = np.cumsum(padded, axis=0)
        around = ((total[wide:] - total[:-wide]) / wide).T
    return np.asarray(1.0 - _HOLLOW * np.clip((around - depth)[hit] / (2.0 * reach), 0.0, 1.0))


def _png(pixels: NDArray[np.uint8]) -> bytes:
    """Return a picture of (h, w, 3) as PNG: the most frequent colours are its palette, the others become the nearest
    ones.
    """
    coarse = (np.minimum(np.round(pixels / _STEP) * _STEP, 255.0)).astype(np.int64)
    keys, index, count = np.unique(coarse @ np.array((65536, 256, 1)), return_inverse=True, return_counts=True)
    colours = np.column_stack((keys >> 16, keys >> 8 & 255, keys & 255))
    palette = colours[np.argsort(-count, kind="stable")[:256]]
    apart = np.stack([np.square(colours[:, k, None] - palette[None, :, k]) for k in range(3)]).sum(axis=0)
    index = apart.argmin(axis=1)[index]
    height, width = pixels.shape[:2]
    rows = np.zeros((height, width + 1), np.uint8)  # each begins with its filter: none
    rows[:, 1:] = index.reshape(height, width)
    chunks = (
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)),
        (b"PLTE", palette.astype(np.uint8).tobytes()),
        (b"IDAT", zlib.compress(rows.tobytes(), 9)),
        (b"IEND", b""),
    )
    parts = (
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


@kernel(writes="depth facet")
def draw_triangles(points: Floats2, faces: Ints2, depth: Floats2, facet: Facets2) -> None:
    """Draw triangles seen from outside: the nearest facet at each pixel, and its height; y goes down in ``points``."""
    height, width = depth.shape
    for f in range(len(faces)):
        x0, y0, z0 = points[faces[f, 0]]
        x1, y1, z1 = points[faces[f, 1]]
        x2, y2, z2 = points[faces[f, 2]]
        area = (x2 - x0) * (y1 - y0) - (x1 - x0) * (y2 - y0)
        if area <= 1e-12:
            continue
        for y in range(
            max(0, math.ceil(min(y0, y1, y2) - 0.5)), min(height - 1, math.floor(max(y0, y1, y2) - 0.5)) + 1
        ):
            for x in range(
                max(0, math.ceil(min(x0, x1, x2) - 0.5)), min(width - 1, math.floor(max(x0, x1, x2) - 0.5)) + 1
            ):
                px, py = x + 0.5, y + 0.5
                a = ((x2 - x1) * (py - y1) - (px - x1) * (y2 - y1)) / -area
                b = ((x0 - x2) * (py - y2) - (px - x2) * (y0 - y2)) / -area
                c = 1.0 - a - b
                if a < -1e-9 or b < -1e-9 or c < -1e-9:
                    continue
                z = a * z0 + b * z1 + c * z2
                if facet[y, x] < 0 or z > depth[y, x]:
                    depth[y, x] = z
                    facet[y, x] = f
