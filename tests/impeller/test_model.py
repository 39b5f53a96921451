"""The impeller as a closed mesh, and what makes none."""

import re
from pathlib import Path

import numpy as np
import pytest
import trimesh

from tests.support import turbo3d
from tests.support.locations import SHARED
from trunnion.errors import InputError
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.impeller import build_impeller
from trunnion.impeller.meshing import solid
from trunnion.impeller.model import ImpellerModel, impeller_model, is_closed

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "impeller"
TEXT = (FOLDER / "impeller.toml").read_text("utf-8")
TURBO3D = SHARED / "seeds" / "turbo3d"
POINTS = (FOLDER / "blade_points.csv").read_text("utf-8")


def written(folder: Path, *changes: tuple[str, str], points: str = POINTS) -> Path:
    text = TEXT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "blade_points.csv").write_text(points, "utf-8")
    (folder / "part.toml").write_text(text, "utf-8")
    return folder / "part.toml"


def modelled(path: Path, tolerance: float = 0.05) -> ImpellerModel:
    return impeller_model(build_impeller(read_impeller(path)), tolerance)


def test_the_published_impeller_is_a_closed_solid_within_its_tolerance_and_stock() -> None:
    found = modelled(FOLDER / "impeller.toml")
    assert found.deviation <= 0.05
    assert found.volume == pytest.approx(83742.0, rel=2e-3)
    low, high = found.mesh.bounds
    np.testing.assert_allclose([*low, *high], [-45, -45, 0, 45, 45, 35], atol=0.06)
    mesh = trimesh.Trimesh(found.mesh.vertices.astype("f4"), found.mesh.faces)
    assert mesh.is_watertight
    assert mesh.euler_number == 2  # no channel is closed, and nothing floats
    body = solid(found.mesh)
    assert (body - body.rotate([0.0, 0.0, 60.0])).volume() < 1e-3 * found.volume


@pytest.mark.nightly
def test_splitters_round_trailing_edges_and_a_bore(tmp_path: Path) -> None:
    changes = (
        ('trailing_edge = "cut"', 'trailing_edge = "round"\nsplitter_start = 0.5'),
        ("fillet_mm = 2.0", "fillet_mm = 0.8"),
        ("height_mm = 35.0", "height_mm = 35.0\nbore_mm = 10.0"),
        ("hub_thickness_mm = 2.0", "hub_thickness_mm = 1.4"),
    )
    found = modelled(written(tmp_path, *changes), 0.2)
    assert found.deviation <= 0.2
    assert found.volume == pytest.approx(81580.0, rel=5e-2)


@pytest.mark.nightly
def test_a_mixed_flow_impeller_of_three_sections_with_splitters_has_no_holes_beside_its_fillets() -> None:
    found = modelled(FOLDER / "mixed_flow.toml")
    assert found.deviation <= 0.05
    assert found.volume == pytest.approx(177_090.0, rel=1e-3)
    mesh = trimesh.Trimesh(found.mesh.vertices.astype("f4"), found.mesh.faces)
    assert mesh.is_watertight
    assert mesh.euler_number == 0  # the bore goes through; a hole inside would add 2


@pytest.mark.nightly
def test_facets_keep_to_the_tolerance_where_hub_and_shroud_bend_both_ways_and_fillets_go_round_edges() -> None:
    found = modelled(FOLDER / "mixed_flow.toml", 0.01)  # 0.0112 and 0.0104 mm off with coarser facets
    assert found.deviation <= 0.01


def test_the_impeller_of_others_is_a_closed_solid() -> None:
    found = modelled(FOLDER / "turbo3d.toml")
    assert found.deviation <= 0.05
    assert found.volume == pytest.approx(70_020.0, rel=2e-3)
    mesh = trimesh.Trimesh(found.mesh.vertices.astype("f4"), found.mesh.faces)
    assert mesh.is_watertight
    assert mesh.euler_number == 0


@pytest.mark.skipif(not TURBO3D.is_dir(), reason="the files of others are not here")
def test_the_blade_of_others_is_where_its_published_flanks_are() -> None:
    patches = turbo3d.flanks(TURBO3D)
    assert turbo3d.table(patches) == (FOLDER / "turbo3d_points.csv").read_text("utf-8")
    blade = build_impeller(read_impeller(FOLDER / "turbo3d.toml")).blade
    w, v = (grid.ravel() for grid in np.meshgrid(np.linspace(0.05, 0.9, 21), np.linspace(0.0, 1.0, 9)))
    off = []
    for side in (-1.0, 1.0):
        centre, normal = blade.sides(w, v, side)
        points = centre + blade.halves(w, v)[:, None] * normal
        off.append(np.min([turbo3d.patch_distances(patch, points) for patch in patches], axis=0))
    # Thickness changes evenly here, and there by up to 0.1 mm along the blade.
    assert np.max(off) < 0.06


@pytest.mark.nightly
def test_facets_are_as_fine_as_a_small_fillet_wants(tmp_path: Path) -> None:
    found = modelled(written(tmp_path, ("fillet_mm = 2.0", "fillet_mm = 0.05")), 0.3)
    assert found.volume == pytest.approx(83_210.0, abs=40.0)  # its fillets are half a mm³
    assert trimesh.Trimesh(found.mesh.vertices.astype("f4"), found.mesh.faces).is_watertight


def test_a_model_that_misses_its_tolerance_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trunnion.impeller.model._SHARE", 8.0)
    with pytest.raises(InputError, match=r"mm off the exact surfaces, and 0\.1 mm are asked for"):
        modelled(FOLDER / "impeller.toml", 0.1)


def test_a_mesh_is_closed_where_each_edge_has_two_facets_that_go_along_it_both_ways() -> None:
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    assert is_closed(faces)
    assert not is_closed(faces[:3])
    assert not is_closed(faces[[0, 1, 2, 2]])
    assert not is_closed(np.vstack((faces[:3], faces[3:, ::-1])))
    two = np.vstack((faces, np.array([0, 1, 4, 5])[faces]))
    assert not is_closed(two)  # they share an edge
    assert not is_closed(faces[:0])


def mistakes(path: Path) -> list[tuple[int, str]]:
    with pytest.raises(InputError) as raised:
        modelled(path)
    return [(problem.line, problem.what) for problem in raised.value.problems]


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ("fillet_mm = 2.0", "fillet_mm = 9.0", "has no room between two blades near this point|finds no place"),
        ("fillet_mm = 2.0", "fillet_mm = 0.01", "hub.fillet_mm is 0.01"),
        ("number = 6", "number = 40", "blades overlap by"),
        ('["hub", "tip"]', '["tip", "hub"]', "the curve hub is 18.* mm below the curve tip, which is named before it"),
        ('["hub", "tip"]', '["hub", "shroud"]', "names 'shroud', which blade_points.csv has not"),
        ('["hub", "tip"]', '["hub"]', "are not at least two different curves"),
        ('"blade_points.csv"', '"../blade_points.csv"', "is '../blade_points.csv'"),
        ('"blade_points.csv"', '"none.csv"', "file not found"),
        ('"blade_points.csv"', '""', "blade.points is empty"),
        ("number = 6", "number = 1", "blade.number is 1"),
        ("scale = 0.75", "scale = 0.75\nscael = 2", "blade.scael is not a key that is known here"),
        ("diameter_mm = 90.0", "diameter_mm = -90.0", "stock.diameter_mm is -90"),
        ("height_mm = 35.0", "height_mm = 35.0\nbore_mm = 90.0", "not less than the diameter"),
        (
            "height_mm = 35.0",
            "height_mm = 35.0\nbore_mm = 25.9",
            "bore_mm is 25.9, and the hub is 25.871 mm in diameter",
        ),
        ("height_mm = 35.0", "height_mm = 34.8", "hub reaches height 35.011 here, and the stock ends at 34.8"),
        ("height_mm = 35.0", "height_mm = 35\nbottom_mm = 7", "down to height 6.486 here, and the stock begins at 7"),
        (
            "height_mm = 35.0",
            "height_mm = 35\nbottom_mm = -200",
            "hub reaches height 35.011 here, and the stock ends at",
        ),
        ("scale = 0.75", "scale = 0.9", "hub reaches height 42.014 here, and the stock ends at 35"),
        ("scale = 0.75", "scale = 19.05", "hub begins at a radius of 328.558 mm, outside of the stock"),
        ("scale = 0.75", "scale = 0.03", "the blade reaches a radius of 1.801 mm only, and that of the stock is 45"),
        (
            "diameter_mm = 90.0",
            "diameter_mm = 60",
            "tip begins at a radius of 31.175 mm, outside of the stock of 60 mm",
        ),
        ("diameter_mm = 90.0", "diameter_mm = 150", "straight on .* to the stock, and does not reach into the hub at"),
    ],
)
def test_what_makes_no_impeller_is_named(tmp_path: Path, old: str, new: str, what: str) -> None:
    found = mistakes(written(tmp_path, (old, new)))
    assert any(re.search(what, text) for _, text in found), found


def test_rows_of_the_points_are_named(tmp_path: Path) -> None:
    lines = POINTS.splitlines()
    doubled = "\n".join([*lines[:5], lines[4], *lines[5:]]) + "\n"
    assert (6, "the curve hub has the same point here as in line 5") in mistakes(written(tmp_path, points=doubled))
    swapped = "\n".join([*lines[:5], lines[8], *lines[6:8], lines[5], *lines[9:]]) + "\n"
    found = mistakes(written(tmp_path, points=swapped))
    assert {line for line, what in found if "turns back here" in what} >= {6, 9}


def test_points_are_not_read_through_a_link_that_leads_out(tmp_path: Path) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    path = written(inside)
    (inside / "blade_points.csv").rename(tmp_path / "points.csv")
    try:
        (inside / "blade_points.csv").symlink_to(tmp_path / "points.csv")
    except OSError:
        pytest.skip("this user may make no links")
    ((line, what),) = mistakes(path)
    assert (line, what) == (8, "blade.points is 'blade_points.csv', which leads out of the folder of the definition")


def test_a_fillet_without_a_place_has_the_row_of_its_point(tmp_path: Path) -> None:
    path = written(tmp_path, ("fillet_mm = 2.0", "fillet_mm = 10"))
    with pytest.raises(InputError) as raised:
        modelled(path)
    (problem,) = raised.value.problems
    assert (Path(problem.file).name, 2 <= problem.line <= 21) == ("blade_points.csv", True)
    assert problem.what == "a fillet of 10 mm finds no place between blade and hub near this point"


def test_a_trailing_edge_that_the_stock_cuts_short_is_told_and_one_that_is_round_is_refused(tmp_path: Path) -> None:
    short = ("diameter_mm = 90.0", "diameter_mm = 88.0")
    (remark,) = build_impeller(read_impeller(written(tmp_path, short))).remarks
    assert (remark.line, remark.severity) == (21, "warning")
    assert "goes on to a radius of 45.015 mm here" in remark.what
    ((line, what),) = mistakes(written(tmp_path, short, ('edge = "cut"', 'edge = "round"')))
    assert (line, "reaches a radius of 45.015 mm here" in what) == (21, True)


def test_rows_that_go_the_wrong_way_are_not_taken_for_a_wrong_order_of_curves(tmp_path: Path) -> None:
    head, *rows = POINTS.splitlines()
    found = mistakes(written(tmp_path, points="\n".join([head, *rows[::-1]])))
    assert [what.partition(":")[0] for _, what in found] == [
        f"the curve {name} goes upward or inward" for name in ("hub", "tip")
    ]
    cells = [row.split(",") for row in rows]
    turned = [",".join([*a[:1], *b[1:4], *a[4:]]) for a, b in zip(cells, cells[::-1], strict=True)]
    ((_, what),) = mistakes(written(tmp_path, points="\n".join([head, *turned])))
    assert what.startswith("the curve tip goes upward or inward")


@pytest.mark.parametrize(
    ("order", "what"),
    [
        ("hub tip middle", "middle is .* mm below the curve tip"),
        ("hub middle copy tip", "copy is the same here as the curve middle"),
    ],
)
def test_sections_are_in_their_order_all_the_way(tmp_path: Path, order: str, what: str) -> None:
    head, *rows = (FOLDER / "mixed_flow_points.csv").read_text("utf-8").splitlines()
    first = head.split(",").index("middle_x_mm")
    copied = [",".join([row, *row.split(",")[first : first + 3]]) for row in rows]
    points = "\n".join([f"{head},copy_x_mm,copy_y_mm,copy_z_mm", *copied])
    text = (FOLDER / "mixed_flow.toml").read_text("utf-8")
    (tmp_path / "mixed_flow_points.csv").write_text(points, "utf-8")
    curves = ", ".join(f'"{name}"' for name in order.split())
    (tmp_path / "part.toml").write_text(text.replace('"hub", "middle", "tip"', curves), "utf-8")
    assert any(re.search(what, text) for _, text in mistakes(tmp_path / "part.toml"))
