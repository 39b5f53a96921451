"""Cures of messages about meshes that are read and written."""

import io
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from subprocess import CompletedProcess, TimeoutExpired
from tempfile import TemporaryDirectory
from typing import Final
from unittest.mock import patch

import numpy as np

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended, file_of, limited, whole
from tests.support.step_files import StepFile
from trunnion.simulation.meshes import TriangleMesh, box_mesh, load_mesh, reading, save_mesh
from trunnion.simulation.meshes.stl import write_stl
from trunnion.simulation.meshes.three_mf import write_three_mf

_MESH: Final = box_mesh(np.zeros(3), np.array([20.0, 30.0, 10.0]), "block")


def _text(mesh: TriangleMesh, facets: int = 12) -> str:
    """A mesh as STL of letters."""
    lines = ["solid block"]
    for corners in mesh.vertices[mesh.faces].tolist()[:facets]:
        vertices = [f"vertex {x:g} {y:g} {z:g}" for x, y, z in corners]
        lines += ["facet normal 0 0 0", "outer loop", *vertices, "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid block", ""])


def _sized(factor: float) -> str:
    return _text(TriangleMesh(_MESH.vertices * factor, _MESH.faces))


def _archive(**files: str) -> str:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return packed.getvalue().decode("latin-1")


def _of_mesh(mesh: TriangleMesh) -> str:
    return write_three_mf(mesh).decode("latin-1")


def _letters(mesh: TriangleMesh) -> str:
    """A mesh as OBJ."""
    vertices = [f"v {x:g} {y:g} {z:g}\n" for x, y, z in mesh.vertices]
    return "".join([*vertices, *("f " + " ".join(str(each + 1) for each in face) + "\n" for face in mesh.faces)])


_TWO_BODIES: Final = TriangleMesh(
    np.concatenate((_MESH.vertices, _MESH.vertices + 50.0)), np.concatenate((_MESH.faces, _MESH.faces + 8))
)
_STL: Final = _text(_MESH)
_BINARY: Final = write_stl(_MESH).decode("latin-1")
_3MF: Final = _of_mesh(_MESH)
with zipfile.ZipFile(io.BytesIO(write_three_mf(_MESH))) as _archived:
    _MODEL: Final = _archived.read("3D/3dmodel.model").decode()
_OBJ: Final = _letters(_MESH)
_PLY: Final = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n9 0 0\n0 9 0\n0 0 9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"
)
_LEAKING: Final = _text(_MESH, 11)
_FLIPPED: Final = _text(TriangleMesh(_MESH.vertices, np.concatenate((_MESH.faces[:-1], _MESH.faces[-1:, ::-1]))))


_STEP: Final = StepFile().text()
_read: Final = partial(file_of, read=load_mesh, warns=True, closed=True)
_AS_STL: Final = _read("part.stl")


def _encrypted(text: str) -> str:
    data = text.encode("latin-1")
    at = data.index(b"PK\x01\x02") + 8
    return (data[:at] + b"\x01" + data[at + 1 :]).decode("latin-1")


def _named(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Have a file of a name read."""
    return file_of(text, load_mesh, closed=True)(_BINARY if text.endswith(".stl") else _3MF, settings, folder)


def _saved(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Write a mesh into a file of a name."""
    return ended(lambda: save_mesh(_MESH, folder / text))


def _unreadable(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    (folder / "part.stl").write_text(text, encoding="utf-8")
    with patch.object(Path, "open", side_effect=OSError(5, "Input/output error")):
        return ended(lambda: load_mesh(folder / "part.stl"))


def _by_process(error: TimeoutExpired | None = None, said: bytes = b"", made: bytes = b"") -> Trial:
    """Return what has a STEP file read; its process is not started, and ends as is said."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        done = CompletedProcess("step", not made, made, said)
        with patch.object(subprocess, "run", side_effect=error, return_value=done):
            return _read("part.step")(text, settings, folder)

    return tried


def _without_guesses(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    with patch.dict(sys.modules, chardet=None, charset_normalizer=None):
        return _read("part.obj")(text, settings, folder)


def _glb(mesh: TriangleMesh) -> bytes:
    with TemporaryDirectory() as folder:
        save_mesh(mesh, Path(folder) / "part.glb")
        return (Path(folder) / "part.glb").read_bytes()


def _exported(code: str, variant: str, trial: Trial, text: str) -> Cure:
    """A file of another format that is exported as STL."""
    return Cure(code, variant, trial, text, ((text, _STL),), cured_by=_AS_STL)


_stl: Final = whole("SIM210", _AS_STL)
_three_mf: Final = whole("SIM210", _read("part.3mf"))
_large: Final = whole("SIM212", limited(_AS_STL, reading, "MAX_FACETS", 15))
_leaks: Final = whole("SIM214", _AS_STL)
_named_mesh: Final = whole("SIM211", _named)
_size: Final = whole("SIM213", _AS_STL)
_TWO: Final = _text(_TWO_BODIES, 24)

CURES: Final = (
    _stl("holds_coordinate_no", _STL.replace("vertex 20 30 10", "vertex nan 30 10", 1), _STL),
    Cure(
        "SIM210", "holds_coordinate_no_number", _read("part.obj"), _OBJ + "v nan 0 0\n", ((_OBJ + "v nan 0 0\n", _OBJ),)
    ),
    Cure("SIM210", "", _unreadable, _STL, (), cured_by=_AS_STL),
    _exported("SIM210", "damaged", _by_process(said=b"no header"), "no STEP at all"),
    _exported("SIM212", "not_made_facets", _by_process(TimeoutExpired("step", 600.0)), "ISO-10303-21;"),
    _stl("damaged_bytes_fewer", _BINARY[:50], _BINARY),
    _stl("damaged_head_promises", _BINARY[:-10], _BINARY),
    _stl("cut_short_end", _STL.removesuffix("endsolid block\n"), _STL),
    _stl("no_vertex_three", _STL.replace("vertex 20 30 10", "vertex 20 30", 1), _STL),
    _stl("ends_facet_not", _STL.replace("vertex 20 30 10\n", "", 1), _STL),
    _stl("no_line_stl", _STL.replace("outer loop", "inner loop", 1), _STL),
    _three_mf(
        "declares_entities_no",
        _archive(**{"a.model": _MODEL.replace("<model", '<!DOCTYPE a [<!ENTITY b "c">]><model')}),
        _3MF,
    ),
    _three_mf("damaged_file", _3MF[:-40], _3MF),
    _three_mf("cannot_unpacked", _encrypted(_archive(**{"a.model": _MODEL})), _3MF),
    Cure(
        "SIM217",
        "holds_models_where",
        _read("part.3mf"),
        _archive(**{"a.model": _MODEL, "b.model": _MODEL}),
        ((_archive(**{"a.model": _MODEL, "b.model": _MODEL}), _3MF),),
    ),
    Cure(
        "SIM210",
        "damaged_mesh",
        _read("part.ply"),
        "ply\nformat none\n",
        (("ply\nformat none\n", _3MF),),
        cured_by=_read("part.3mf"),
    ),
    Cure("SIM210", "damaged_text_not", _without_guesses, "v \xff\xfe 0 0\n", (("v \xff\xfe 0 0\n", _OBJ),)),
    Cure(
        "SIM210",
        "damaged_facet_names",
        _read("part.ply"),
        _PLY.replace("3 0 2 1", "3 0 2 9"),
        (("3 0 2 9", "3 0 2 1"),),
    ),
    _exported("SIM210", "body_whose_surface", _by_process(said=b"shape without geometry", made=b"glb"), _STEP),
    Cure(
        "SIM212",
        "facets_more",
        limited(_read("part.obj"), reading, "MAX_FACETS", 15),
        _letters(_TWO_BODIES),
        ((_letters(_TWO_BODIES), _OBJ),),
    ),
    Cure(
        "SIM212",
        "more_facets",
        limited(_read("part.3mf"), reading, "MAX_FACETS", 15),
        _of_mesh(_TWO_BODIES),
        ((_of_mesh(_TWO_BODIES), _3MF),),
    ),
    Cure("SIM212", "more_mb", limited(_AS_STL, reading, "MAX_BYTES", 1000), _STL, ((_STL, _BINARY),)),
    Cure(
        "SIM212",
        "unpacks_more_mb",
        limited(_read("part.3mf"), reading, "MAX_BYTES", 2 * len(_MODEL) + 200),
        _of_mesh(_TWO_BODIES),
        ((_of_mesh(_TWO_BODIES), _3MF),),
    ),
    Cure(
        "SIM213",
        "mm_large",
        _read("part.3mf"),
        _archive(**{"a.model": _MODEL.replace("millimeter", "micron")}),
        ((_archive(**{"a.model": _MODEL.replace("millimeter", "micron")}), _3MF),),
    ),
    _named_mesh("cad_file_format", "part.iges", "part.stl"),
    _named_mesh("ends", "part.dxf", "part.stl"),
    _named_mesh("no_ending_names", "part", "part.3mf"),
    _large("too_many_facets", _TWO, _STL),
    _size("mm_large_numbers", _sized(0.001), _STL),
    _size("holds_coordinate_mm", _sized(1e6), _STL),
    _leaks("leaks_edges_surface", _LEAKING, _STL),
    _leaks("not_one_piece", _FLIPPED, _STL),
    _leaks("inside_out_facets", _text(TriangleMesh(_MESH.vertices, _MESH.faces[:, ::-1])), _STL),
    _size("m_large", _sized(5000.0), _STL),
    Cure("SIM215", "step_file_states", _by_process(made=_glb(_MESH)), _STEP, ({"unit": None},), {"unit": "mm"}),
    Cure("SIM216", "empty_holds_no", _AS_STL, _text(_MESH, 0), ((_text(_MESH, 0), _STL),)),
    Cure(
        "SIM217",
        "parts_other_files",
        _by_process(made=_glb(_MESH)),
        _STEP.replace("ENDSEC;\nEND-ISO", "#999=DOCUMENT_FILE('a','','');\nENDSEC;\nEND-ISO"),
        (("#999=DOCUMENT_FILE('a','','');\n", ""),),
    ),
    Cure("SIM218", "ends_format_not", _saved, "part.obj", ((".obj", ".stl"),)),
    Cure("SIM218", "no_ending_names", _saved, "part", (("part", "part.3mf"),)),
)
