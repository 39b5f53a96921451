"""Meshes from files: STL, OBJ, PLY, 3MF and GLB, and facets of the exact surfaces of STEP.

In:     a path, and the unit of its numbers.
Out:    a ``TriangleMesh`` in mm whose facets share their vertices and are seen from outside.

A file is untrusted: it is refused if it is too large, damaged or holds numbers that no body has, and it cannot have
other files read.
"""

from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.errors import InputError, Problem, Severity, unusable_file, warning
from trunnion.messages import Wording, phrase
from trunnion.simulation.meshes.findings import LARGEST_EXTENT, SMALLEST_EXTENT, MeshFindings, judge_mesh
from trunnion.simulation.meshes.step import STEP_ENDINGS, read_step
from trunnion.simulation.meshes.stl import read_stl
from trunnion.simulation.meshes.three_mf import read_three_mf
from trunnion.simulation.meshes.triangle_mesh import TriangleMesh
from trunnion.simulation.meshes.trimesh_formats import read_by_trimesh
from trunnion.wording import position

#: Larger files are refused unread, bytes.
MAX_BYTES: Final = 1_000_000_000

#: Meshes of more facets are refused: their memory and time are more than any body needs.
MAX_FACETS: Final = 8_000_000

#: No coordinate of a body on a machine is greater, mm.
MAX_COORDINATE: Final = 1e6

#: Endings of the files that are read.
MESH_FORMATS: Final = (".stl", ".obj", ".ply", ".3mf", ".glb", *STEP_ENDINGS)

#: Formats whose numbers have no unit: they are taken for mm.
_WITHOUT_UNIT: Final = (".stl", ".obj", ".ply")

_CAD_FORMATS: Final = (".iges", ".igs", ".brep", ".x_t", ".x_b", ".sat", ".prt", ".sldprt", ".catpart", ".ipt")

#: How far the facets of exact surfaces are off them where nobody says, mm.
DEVIATION: Final = 0.005

#: glTF counts in metres with Y upwards; a machine has Z there.
_Y_UP_TO_Z_UP: Final = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


class MeshUnit(StrEnum):
    """The unit of the numbers in a file."""

    MM = "mm"
    INCH = "inch"
    M = "m"

    @property
    def in_mm(self) -> float:
        """Its length, mm."""
        return {MeshUnit.MM: 1.0, MeshUnit.INCH: 25.4, MeshUnit.M: 1000.0}[self]


def load_mesh(
    path: str | Path,
    unit: MeshUnit | str | None = None,
    *,
    name: str = "",
    closed: bool = False,
    deviation: float = DEVIATION,
    warn: Callable[[Problem], None] | None = None,
) -> TriangleMesh:
    """Read a mesh.

    path       a file whose name ends in one of ``MESH_FORMATS``
    unit       of its numbers; None: what the format says (3MF states one, GLB counts in m), else mm. STEP states its
               own
    name       what messages call it; empty: the name of the file
    closed     refuse a mesh with open edges, which has no inside, and one that seems to be in metres
    deviation  how far facets may be off the surfaces of a STEP file, mm
    warn       takes what is odd and does not stop the work

    TriangleMesh  in mm; facets without area are left out

    Raises ``InputError`` if the file cannot be read, is damaged, too large, empty or, with ``closed``, leaks.
    """
    file = Path(path)
    label = str(path)
    ending = file.suffix.lower()
    _check_file(file, label, ending)
    stated = None if unit is None else MeshUnit(unit)
    data = _bytes(file, label)
    vertices, faces, own_unit = _read(data, label, ending, deviation)
    if len(faces) > MAX_FACETS:
        raise InputError(too_many_facets(label, len(faces)))
    if stated is not None and ending in STEP_ENDINGS:
        raise InputError(Problem(label, 0, Wording("SIM215", "step_file_states")))
    scale = own_unit if stated is None else stated.in_mm
    mesh = _shared_vertices(vertices * scale, faces, name or file.name, label)
    findings = judge_mesh(mesh)
    guessed = stated is None and ending in _WITHOUT_UNIT
    problems = list(_problems(mesh, findings, label, guessed, refused=closed))
    refused = [problem for problem in problems if problem.severity is Severity.ERROR]
    if refused:
        raise InputError(refused)
    for problem in problems:
        if warn is not None:
            warn(problem)
    return mesh.turned_out() if findings.inside_out else mesh


def _check_file(file: Path, label: str, ending: str) -> None:
    if ending in _CAD_FORMATS:
        raise InputError(Problem(label, 0, Wording("SIM211", "cad_file_format")))
    if ending not in MESH_FORMATS:
        raise InputError(
            Problem(
                label,
                0,
                Wording("SIM211", "ends", suffix=file.suffix, mesh_formats=tuple(MESH_FORMATS))
                if ending
                else Wording("SIM211", "no_ending_names", mesh_formats=tuple(MESH_FORMATS)),
            )
        )
    unusable = unusable_file(file, phrase("file_of_mesh"))
    if unusable:
        raise InputError(unusable)


def _bytes(file: Path, label: str) -> bytes:
    try:
        with file.open("rb") as stream:
            data = stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise InputError(
            Problem(label, 0, Wording("SIM210", "cannot_read", strerror=error.strerror or error))
        ) from None
    if len(data) > MAX_BYTES:
        raise InputError(Problem(label, 0, Wording("SIM212", "more_mb", max_bytes=MAX_BYTES // 1000000)))
    return data


def _read(data: bytes, label: str, ending: str, deviation: float) -> tuple[Floats, Ints, float]:
    if ending in STEP_ENDINGS:
        return *read_step(data, label, deviation), MeshUnit.MM.in_mm
    return _READERS[ending](data, label)


def _read_stl(data: bytes, label: str) -> tuple[Floats, Ints, float]:
    corners = read_stl(data, label, MAX_FACETS)
    return corners, np.arange(len(corners)).reshape(-1, 3), MeshUnit.MM.in_mm


def _read_three_mf(data: bytes, label: str) -> tuple[Floats, Ints, float]:
    return read_three_mf(data, label, MAX_BYTES // 2, MAX_FACETS)


def _read_obj(data: bytes, label: str) -> tuple[Floats, Ints, float]:
    return *read_by_trimesh(data, "obj", label), MeshUnit.MM.in_mm


def _read_ply(data: bytes, label: str) -> tuple[Floats, Ints, float]:
    return *read_by_trimesh(data, "ply", label), MeshUnit.MM.in_mm


def _read_glb(data: bytes, label: str) -> tuple[Floats, Ints, float]:
    vertices, faces = read_by_trimesh(data, "glb", label)
    return vertices @ _Y_UP_TO_Z_UP.T, faces, MeshUnit.M.in_mm


def too_many_facets(label: str, facets: int) -> Problem:
    """Return the problem of a mesh of too many facets."""
    return Problem(label, 0, Wording("SIM212", "facets_more", facets=facets, max_facets=MAX_FACETS))


_READERS: Final[dict[str, Callable[[bytes, str], tuple[Floats, Ints, float]]]] = {
    ".stl": _read_stl,
    ".3mf": _read_three_mf,
    ".obj": _read_obj,
    ".ply": _read_ply,
    ".glb": _read_glb,
}


def _shared_vertices(vertices: Floats, faces: Ints, name: str, label: str) -> TriangleMesh:
    """Return the mesh with equal vertices made one, without facets that have no area."""
    if not np.isfinite(vertices).all():
        where = int(np.flatnonzero(~np.isfinite(vertices).all(axis=1))[0])
        facet = np.flatnonzero((faces == where).any(axis=1))
        raise InputError(
            Problem(
                label,
                0,
                Wording("SIM210", "holds_coordinate_no", facet=facet[0] + 1)
                if len(facet)
                else Wording("SIM210", "holds_coordinate_no_number", where=where + 1),
            )
        )
    if len(vertices) and float(np.abs(vertices).max()) > MAX_COORDINATE:
        raise InputError(Problem(label, 0, Wording("SIM213", "holds_coordinate_mm", max=float(np.abs(vertices).max()))))
    # -0.0 and 0.0 are one coordinate.
    whole = np.ascontiguousarray(vertices + 0.0)
    order = np.lexsort(whole.T)
    ordered = whole[order]
    new = np.ones(len(order), np.bool_)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    index = np.empty(len(order), np.int64)
    index[order] = np.cumsum(new) - 1
    found = index[faces]
    flat = (found == np.roll(found, -1, axis=1)).any(axis=1)
    found = found[~flat]
    if not len(found):
        raise InputError(Problem(label, 0, Wording("SIM216", "empty_holds_no")))
    used = np.zeros(int(new.sum()), np.bool_)
    used[found] = True
    return TriangleMesh(ordered[new][used], (np.cumsum(used) - 1)[found], name)


def _problems(mesh: TriangleMesh, findings: MeshFindings, label: str, guessed: bool, *, refused: bool) -> list[Problem]:
    problems = []
    severity = Severity.ERROR if refused else Severity.WARNING
    if findings.open_edges:
        problems.append(
            Problem(
                label,
                0,
                Wording(
                    "SIM214",
                    "leaks_edges_surface",
                    open_edges=findings.open_edges,
                    places=tuple(map(position, findings.places)),
                ),
                severity=severity,
            )
        )
    if findings.turned:
        problems.append(
            Problem(label, 0, Wording("SIM214", "not_one_piece", turned=findings.turned), severity=severity)
        )
    if findings.inside_out:
        problems.append(warning(label, 0, Wording("SIM214", "inside_out_facets")))
    low, high = mesh.bounds
    extent = float((high - low).max())
    if extent < SMALLEST_EXTENT:
        # Stock of 0.1 mm is missed by every tool, and a part of 0.1 mm passes whatever is left.
        problems.append(
            Problem(
                label,
                0,
                Wording("SIM213", "mm_large_numbers" if guessed else "mm_large", extent=extent),
                severity=severity if guessed else Severity.WARNING,
            )
        )
    elif extent > LARGEST_EXTENT:
        problems.append(warning(label, 0, Wording("SIM213", "m_large", extent=extent / 1000.0)))
    return problems
