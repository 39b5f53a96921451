"""Pictures of meshes: what is nearer is seen, light comes from above, and the file is a PNG."""

import struct
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from trunnion.simulation.meshes import TriangleMesh, box_mesh, picture, save_mesh

SIZE = (64, 48)


def pixels(data: bytes) -> NDArray[np.uint8]:
    """Red, green and blue of a PNG with a palette, (h, w, 3); every chunk is whole."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    found, at = dict[bytes, bytes](), 8
    while at < len(data):
        (length,) = struct.unpack_from(">I", data, at)
        kind, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        assert struct.unpack_from(">I", data, at + 8 + length) == (zlib.crc32(kind + body),)
        found[kind] = body
        at += 12 + length
    width, height = struct.unpack_from(">II", found[b"IHDR"])
    rows = np.frombuffer(zlib.decompress(found[b"IDAT"]), np.uint8).reshape(height, width + 1)
    assert not rows[:, 0].any()
    return np.asarray(np.frombuffer(found[b"PLTE"], np.uint8).reshape(-1, 3)[rows[:, 1:]])


def boxes(*given: tuple[tuple[float, float, float], tuple[float, float, float]]) -> TriangleMesh:
    """Boxes by their sizes and their centres."""
    halves = [(0.5 * np.array(size), np.array(centre)) for size, centre in given]
    meshes = [box_mesh(centre - half, centre + half) for half, centre in halves]
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return TriangleMesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + k for k, mesh in zip(first, meshes, strict=False)]),
    )


def test_a_box_is_seen_from_where_it_is_looked_at() -> None:
    mesh = boxes(((40, 20, 20), (0, 0, 0)))
    above = pixels(picture(mesh, azimuth=-90.0, elevation=90.0, size=SIZE))
    body = above.min(axis=2) < 250
    # 40 by 20 mm fill 94 percent of the width: 60 by 30 pixels, in the middle.
    assert np.flatnonzero(body.any(axis=0))[[0, -1]].tolist() == [2, 61]
    assert np.flatnonzero(body.any(axis=1))[[0, -1]].tolist() == [9, 38]
    aside = pixels(picture(mesh, azimuth=-90.0, elevation=30.0, size=SIZE)).astype(int)
    lit = [row for row in aside[:, 32, 0] if row < 250]
    assert lit[3] > lit[-3] + 20  # its top has more light than its front


def test_what_is_nearer_hides_what_is_behind_and_both_have_their_colours() -> None:
    mesh = boxes(((20, 2, 20), (0, -10, 0)), ((40, 2, 10), (0, 10, 0)))
    red, blue = np.tile((1.0, 0.0, 0.0), (8, 1)), np.tile((0.0, 0.0, 1.0), (8, 1))
    seen = pixels(picture(mesh, colours=np.concatenate((red, blue)), azimuth=-90.0, elevation=0.0, size=SIZE))
    middle, side = seen[24, 32].astype(int), seen[24, 6].astype(int)
    assert middle[0] > middle[2] + 100
    assert side[2] > side[0] + 100
    behind = pixels(picture(mesh, colours=np.concatenate((red, blue)), azimuth=90.0, elevation=0.0, size=SIZE))
    assert behind[24, 32, 2] > behind[24, 32, 0]


def test_a_picture_is_saved_by_its_ending(tmp_path: Path) -> None:
    mesh = boxes(((40, 20, 20), (0, 0, 0)))
    save_mesh(mesh, tmp_path / "box.png")
    assert pixels((tmp_path / "box.png").read_bytes()).shape == (720, 960, 3)
    assert (tmp_path / "box.png").read_bytes() == picture(mesh)
