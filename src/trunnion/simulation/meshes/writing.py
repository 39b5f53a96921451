"""Meshes into files: STL, PLY, 3MF and GLB, or a picture of it as PNG, whole or not at all."""

import json
import os
import struct
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.errors import InputError, Problem
from trunnion.files import atomic_file
from trunnion.messages import Wording
from trunnion.simulation.meshes.picture import picture
from trunnion.simulation.meshes.stl import write_stl
from trunnion.simulation.meshes.three_mf import write_three_mf
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh

_GLB_ARRAY: Final = 34962
_GLB_ELEMENTS: Final = 34963


def check_mesh_name(path: str | Path, others: Sequence[str] = ()) -> None:
    """Raise ``InputError`` if the ending of a name says no format that is written; ``others`` are written elsewhere."""
    ending = Path(path).suffix.lower()
    if ending not in (*_WRITERS, *others):
        raise InputError(
            Problem(
                str(path),
                0,
                Wording("SIM218", "ends_format_not", suffix=Path(path).suffix, writers=(*_WRITERS, *others))
                if ending
                else Wording("SIM218", "no_ending_names", writers=(*_WRITERS, *others)),
            )
        )


def save_mesh(mesh: TriangleMesh, path: str | Path, *, inputs: Iterable[str | os.PathLike[str]] = ()) -> None:
    """Write a mesh; the ending of the name says in which format: .stl, .ply, .3mf or .glb, or .png for a picture.

    Lengths are mm, in GLB metres with Y upwards, as that format wants them. STL, PLY and GLB have single precision.

    mesh    with at least one facet
    path    the file; an older one stays if the new one cannot be written whole
    inputs  files that are read: none of them is written over

    Raises ``InputError`` if the ending is another, the mesh is empty, or the file cannot be written.
    """
    check_mesh_name(path)
    ending = Path(path).suffix.lower()
    if not len(mesh.faces):
        raise InputError(Problem(str(path), 0, Wording("SIM219", "would_empty_nothing")))
    data = _WRITERS[ending](mesh)
    with atomic_file(path, inputs=inputs) as stream:
        stream.write(data)


def _ply(mesh: TriangleMesh) -> bytes:
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(mesh.vertices)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(mesh.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, mesh.faces
    return head.encode("ascii") + mesh.vertices.astype("<f4").tobytes() + faces.tobytes()


def _glb(mesh: TriangleMesh) -> bytes:
    x, y, z = mesh.vertices.T / 1000.0
    points = np.stack((x, z, -y), axis=1).astype("<f4")
    corners = mesh.faces.astype("<u4")
    binary = points.tobytes() + corners.tobytes()
    text = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": mesh.name}],
        "meshes": [{"name": mesh.name, "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {
                "bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                "min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist(),
            },
            {"bufferView": 1, "componentType": 5125, "count": corners.size, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes, "target": _GLB_ARRAY},
            {"buffer": 0, "byteOffset": points.nbytes, "byteLength": corners.nbytes, "target": _GLB_ELEMENTS},
        ],
        "buffers": [{"byteLength": len(binary)}],
    }  # fmt: skip
    head = json.dumps(text, separators=(",", ":")).encode()
    head += b" " * (-len(head) % 4)
    chunks = struct.pack("<II", len(head), 0x4E4F534A) + head + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


_WRITERS: Final[dict[str, Callable[[TriangleMesh], bytes]]] = {
    ".stl": write_stl,
    ".ply": _ply,
    ".3mf": write_three_mf,
    ".glb": _glb,
    ".png": picture,
}
