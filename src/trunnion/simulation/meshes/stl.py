"""STL, binary and ASCII."""

import array
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh

_FACET: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEADER: Final = 84


def read_stl(data: bytes, label: str, max_facets: int) -> Floats:
    """Return the corners of all facets, (3 m, 3), in the unit of the file.

    Raises ``InputError`` if the file is cut short, holds something else, or too many facets.
    """
    count = int.from_bytes(data[80:84], "little") if len(data) >= _HEADER else -1
    if count >= 0 and len(data) == _HEADER + count * _FACET.itemsize:
        _check_count(count, label, max_facets)
        facets = np.frombuffer(data, _FACET, count, _HEADER)
        return facets["corners"].reshape(-1, 3).astype(np.float64)
    # Binary files may begin with "solid" too: only text holds facets in words.
    if data[:512].lstrip()[:5].lower() == b"solid" and b"\0" not in data[:512]:
        return _read_text(data, label, max_facets)
    there = (len(data) - _HEADER) / _FACET.itemsize
    raise InputError(
        Problem(
            label,
            0,
            Wording("SIM210", "damaged_bytes_fewer", count=len(data))
            if count < 0
            else Wording("SIM210", "damaged_head_promises", count=count, there=there),
        )
    )


def _check_count(count: int, label: str, max_facets: int) -> None:
    if count > max_facets:
        raise InputError(Problem(label, 0, Wording("SIM212", "too_many_facets", count=count, max_facets=max_facets)))


def _read_text(data: bytes, label: str, max_facets: int) -> Floats:
    numbers = array.array("d")
    facets = ends = 0
    line = 0
    last = b""
    for line, text in enumerate(data.splitlines(), start=1):
        words = text.split()
        if not words:
            continue
        last = words[0].lower()
        if last == b"vertex":
            try:
                x, y, z = map(float, words[1:])
            except ValueError:
                raise InputError(Problem(label, line, Wording("SIM210", "no_vertex_three"))) from None
            numbers.extend((x, y, z))
        elif last == b"facet":
            facets += 1
            _check_count(facets, label, max_facets)
        elif last == b"endfacet":
            ends += 1
            if len(numbers) != 9 * ends or ends != facets:
                raise InputError(Problem(label, line, Wording("SIM210", "ends_facet_not")))
        elif last not in (b"solid", b"outer", b"endloop", b"endsolid"):
            raise InputError(Problem(label, line, Wording("SIM210", "no_line_stl")))
    if last != b"endsolid" or facets != ends:
        raise InputError(Problem(label, line, Wording("SIM210", "cut_short_end")))
    return np.frombuffer(numbers, np.float64).reshape(-1, 3).copy() if numbers else np.zeros((0, 3))


def write_stl(mesh: TriangleMesh) -> bytes:
    """Return a binary file, lengths in mm."""
    corners = mesh.vertices[mesh.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1)
    facets = np.zeros(len(corners), _FACET)
    facets["normal"] = normal / np.where(length > 0.0, length, 1.0)[:, None]
    facets["corners"] = corners
    return b"\0" * 80 + len(facets).to_bytes(4, "little") + facets.tobytes()
