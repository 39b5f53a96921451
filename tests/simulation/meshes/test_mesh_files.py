"""Meshes from files and into files."""

import io
import struct
import zipfile
from pathlib import Path

import numpy as np
import pytest

from trunnion.errors import InputError, Problem
from trunnion.simulation.meshes import TriangleMesh, box_mesh, load_mesh, save_mesh

ENDINGS = (".stl", ".ply", ".3mf", ".glb")

LOW, HIGH = np.array([-10.0, 5.0, 0.0]), np.array([20.0, 45.0, 12.5])


@pytest.fixture(scope="module")
def box() -> TriangleMesh:
    return box_mesh(LOW, HIGH, "block")


def ascii_stl(mesh: TriangleMesh) -> str:
    lines = ["solid block"]
    for corners in mesh.vertices[mesh.faces].tolist():
        lines += ["facet normal 0 0 0", " outer loop"]
        lines += [f"  vertex {x} {y} {z}" for x, y, z in corners]
        lines += [" endloop", "endfacet"]
    return "\n".join([*lines, "endsolid block", ""])


def obj(mesh: TriangleMesh) -> str:
    lines = ["mtllib /etc/passwd", *(f"v {x} {y} {z}" for x, y, z in mesh.vertices.tolist())]
    return "\n".join([*lines, *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in mesh.faces.tolist()), ""])


def refusal(path: Path, **how: bool) -> str:
    with pytest.raises(InputError) as caught:
        load_mesh(path, **how)  # type: ignore[arg-type]
    return str(caught.value)


@pytest.mark.parametrize("ending", ENDINGS)
def test_what_is_written_is_read_again(ending: str, box: TriangleMesh, tmp_path: Path) -> None:
    said: list[Problem] = []
    save_mesh(box, tmp_path / f"block{ending}")
    found = load_mesh(tmp_path / f"block{ending}", closed=True, warn=said.append)
    np.testing.assert_allclose(found.bounds, [LOW, HIGH], atol=2e-6)
    assert (len(found.vertices), len(found.faces), said) == (8, 12, [])
    assert found.volume == pytest.approx(30.0 * 40.0 * 12.5, rel=1e-6)


@pytest.mark.parametrize("ending", ENDINGS)
def test_the_same_mesh_gives_the_same_bytes(ending: str, box: TriangleMesh, tmp_path: Path) -> None:
    for name in ("one", "two"):
        save_mesh(box, tmp_path / f"{name}{ending}")
    assert (tmp_path / f"one{ending}").read_bytes() == (tmp_path / f"two{ending}").read_bytes()


def test_text_formats_are_read_and_no_other_file_with_them(box: TriangleMesh, tmp_path: Path) -> None:
    (tmp_path / "block.stl").write_text(ascii_stl(box), encoding="ascii")
    (tmp_path / "block.obj").write_text(obj(box), encoding="ascii")
    for name in ("block.stl", "block.obj"):
        found = load_mesh(tmp_path / name, closed=True)
        np.testing.assert_array_equal(found.bounds, [LOW, HIGH])
        assert found.name == name


@pytest.mark.parametrize(("unit", "factor"), [("mm", 1.0), ("inch", 25.4), ("m", 1000.0)])
def test_the_unit_is_that_of_the_numbers(unit: str, factor: float, tmp_path: Path) -> None:
    save_mesh(box_mesh(np.zeros(3), np.array([2.0, 3.0, 4.0])), tmp_path / "small.stl")
    np.testing.assert_allclose(load_mesh(tmp_path / "small.stl", unit).bounds[1], np.array([2.0, 3.0, 4.0]) * factor)


def test_3mf_says_its_unit_and_places_its_items(tmp_path: Path) -> None:
    save_mesh(box_mesh(np.zeros(3), np.ones(3)), tmp_path / "one.3mf")
    with zipfile.ZipFile(tmp_path / "one.3mf") as archive:
        model = archive.read("3D/3dmodel.model").decode()
    model = model.replace("millimeter", "inch").replace(
        '<item objectid="1"/>', '<item objectid="1" transform="0 1 0 -1 0 0 0 0 1 5 0 0"/>'
    )
    with zipfile.ZipFile(tmp_path / "two.3mf", "w") as archive:
        archive.writestr("3D/3dmodel.model", model)
    found = load_mesh(tmp_path / "two.3mf", closed=True)
    np.testing.assert_allclose(found.bounds, np.array([[4.0, 0.0, 0.0], [5.0, 1.0, 1.0]]) * 25.4)


def test_a_mesh_that_leaks_warns_with_the_place_and_is_refused_where_it_must_be_closed(
    box: TriangleMesh, tmp_path: Path
) -> None:
    said: list[Problem] = []
    save_mesh(TriangleMesh(box.vertices, box.faces[:-1]), tmp_path / "open.stl")
    assert len(load_mesh(tmp_path / "open.stl", warn=said.append).faces) == 11
    assert "leaks: 3 edges of its surface are open, at X20" in str(said[0])
    assert "close the surface" in refusal(tmp_path / "open.stl", closed=True)


def test_a_facet_that_is_turned_is_no_inside(box: TriangleMesh, tmp_path: Path) -> None:
    faces = box.faces.copy()
    faces[0] = faces[0, ::-1]
    save_mesh(TriangleMesh(box.vertices, faces), tmp_path / "turned.stl")
    assert "at 3 edges, facets are seen from different sides" in refusal(tmp_path / "turned.stl", closed=True)


def test_a_mesh_that_is_inside_out_is_turned_with_a_warning(box: TriangleMesh, tmp_path: Path) -> None:
    said: list[Problem] = []
    save_mesh(box.turned_out(), tmp_path / "inside.ply")
    assert load_mesh(tmp_path / "inside.ply", closed=True, warn=said.append).volume > 0.0
    assert ["inside out" in str(problem) for problem in said] == [True]


def test_numbers_that_look_like_metres_are_told(tmp_path: Path) -> None:
    said: list[Problem] = []
    save_mesh(box_mesh(np.zeros(3), np.array([0.1, 0.2, 0.05])), tmp_path / "small.stl")
    load_mesh(tmp_path / "small.stl", warn=said.append)
    told = "is 0.2 mm large: its numbers look like metres; export it in mm"
    assert told in str(said[0])
    assert told in refusal(tmp_path / "small.stl", closed=True)
    said.clear()
    load_mesh(tmp_path / "small.stl", "m", warn=said.append)
    assert said == []


def binary_stl(promised: int, facets: int, number: float = 1.0) -> bytes:
    facet = struct.pack("<12fH", 0, 0, 0, 0, 0, 0, number, 0, 0, 0, 1, 0, 0)
    return b"\0" * 80 + promised.to_bytes(4, "little") + facet * facets


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("empty.stl", b"", "has 0 bytes"),
        ("none.stl", binary_stl(0, 0), "is empty"),
        ("flat.stl", binary_stl(1, 1, 0.0), "is empty"),
        ("short.stl", binary_stl(5, 3), "promises 5 facets, and it holds 3"),
        ("huge.stl", binary_stl(4_000_000_000, 1), "promises 4000000000 facets"),
        ("nan.stl", binary_stl(1, 1, float("nan")), "no number, at facet 1"),
        ("far.stl", binary_stl(1, 1, 1e30), "holds a coordinate of 1e+30 mm"),
        ("cut.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "cut.stl:4: error: is cut short"),
        ("bad.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n", "bad.stl:4: error: is no vertex"),
        ("two.stl", b"solid a\nfacet\nouter loop\nvertex 0 0 0\nendloop\nendfacet\nendsolid\n", "not three corners"),
        ("bad.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 9\n", "is damaged"),
        ("bad.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n", "is damaged"),
        ("bad.glb", b"glTF\2\0\0\0", "is damaged"),
        ("bad.3mf", b"PK\3\4", "is damaged"),
        ("part.iges", b"S      1", "is not read; export it as STEP"),
        ("part.x", b"", 'ends in ".x"'),
    ],
)  # fmt: skip
def test_a_file_that_is_no_mesh_is_refused(name: str, content: bytes, words: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(content)
    assert words in refusal(tmp_path / name)


@pytest.mark.parametrize(
    "model",
    [
        b'<!DOCTYPE m [<!ENTITY a "b">]><model><resources/></model>',
        b'<model unit="league"><build/></model>',
        b'<model><resources><object id="1"><components><component objectid="1"/></components></object></resources>'
        b'<build><item objectid="1"/></build></model>',
        b"<model><resources>",
    ],
)
def test_a_3mf_of_bad_content_is_refused(model: bytes, tmp_path: Path) -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("3D/3dmodel.model", model)
    (tmp_path / "bad.3mf").write_bytes(packed.getvalue())
    assert "bad.3mf: error: " in refusal(tmp_path / "bad.3mf")


def test_what_cannot_be_written_is_said_and_leaves_the_old_file(box: TriangleMesh, tmp_path: Path) -> None:
    (tmp_path / "old.stl").write_bytes(b"old")
    for mesh, name in ((TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64)), "old.stl"), (box, "old.obj")):
        with pytest.raises(InputError):
            save_mesh(mesh, tmp_path / name)
    with pytest.raises(InputError, match=r"old\.stl"):
        save_mesh(box, tmp_path / "old.stl", inputs=[tmp_path / "old.stl"])
    assert [path.name for path in tmp_path.iterdir()] == ["old.stl"]
    assert (tmp_path / "old.stl").read_bytes() == b"old"


@pytest.mark.parametrize("ending", [".3mf", ".glb", ".ply", ".stl", ".obj"])
def test_a_file_with_any_damaged_byte_is_read_or_refused(ending: str, box: TriangleMesh, tmp_path: Path) -> None:
    path = tmp_path / f"box{ending}"
    if ending == ".obj":
        path.write_text(obj(box))
    else:
        save_mesh(box, path)
    whole = path.read_bytes()
    refused = 0
    for at in range(0, len(whole), 3):
        damaged = bytearray(whole)
        damaged[at] ^= 0x55
        path.write_bytes(damaged)
        try:
            load_mesh(path)
        except InputError:
            refused += 1
    assert refused > 0
