"""Impellers as STEP files: read back by the project's own reader, and compared with mesh and exact surfaces."""

import json
import platform
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trunnion
from tests.support.example_impellers import EXAMPLES, changed
from trunnion.cli import main
from trunnion.impeller.deviation import off_surfaces
from trunnion.impeller.fillet import root_fillet, root_stations
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.meshing import solid
from trunnion.impeller.solid import making
from trunnion.impeller.solid.impeller_body import impeller_body
from trunnion.impeller.solid.making import ImpellerSolid
from trunnion.impeller.solid.order import Made, Order, Refusal
from trunnion.impeller.solid.root_loop import Density
from trunnion.simulation.meshes import TriangleMesh, judge_mesh, load_mesh

pytestmark = pytest.mark.skipif(
    sys.platform == "linux" and platform.machine() != "x86_64", reason="Open CASCADE has no wheels for it"
)

FEW = (("number = 5", "number = 2"), ('name = "MIXED FLOW"', """name = "L'AUBE É" """))


def areas(mesh: TriangleMesh, heights: list[float]) -> list[float]:
    """Areas of sections across Z, mm²."""
    body = solid(mesh)
    return [body.slice(height).area() for height in heights]


def off(impeller: Impeller, mesh: TriangleMesh) -> float:
    """How far vertices of a mesh are off the exact surfaces at most, mm."""
    stations = root_stations(801, 101, round_trailing=True)
    blades = [blade for blade in (impeller.blade, impeller.splitter) if blade is not None]
    fillets = [(one, root_fillet(one, impeller.hub, impeller.definition.fillet, stations)) for one in blades]
    return float(off_surfaces(impeller, mesh.vertices, fillets).max())


@pytest.mark.nightly
def test_an_impeller_with_splitters_is_written_and_read_back(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    solids = []

    def kept(*arguments: Any, **options: Any) -> ImpellerSolid:
        solids.append(trunnion.write_impeller_step(*arguments, **options))
        return solids[-1]

    monkeypatch.setattr("trunnion.cli.impeller.write_impeller_step", kept)
    definition = changed(tmp_path, "mixed_flow", *FEW)
    file = tmp_path / "part.stp"
    assert main(["impeller", "model", str(definition), "--output", str(file), "--json"]) == 0
    out, err = capfd.readouterr()
    data = json.loads(out)
    assert err == ""
    assert (data["blades"], data["splitters"], data["deviation_mm"] < 0.001) == (2, 2, True)
    step = file.read_bytes()
    assert step.isascii()
    assert rb"= PRODUCT('L''AUBE \X4\000000C9\X0\'" in step
    assert b"'1970-01-01T00:00:00'" in step
    assert len(re.findall(rb"= ADVANCED_FACE\(", step)) == data["faces"]

    impeller = trunnion.load_impeller(definition)
    found = solids[0].mesh
    read = load_mesh(file, closed=True, deviation=0.02)
    assert judge_mesh(read).is_closed
    assert read.volume == pytest.approx(data["volume_mm3"], rel=3e-4)
    assert found.volume == pytest.approx(data["volume_mm3"], rel=1e-3)
    heights = [-3.0, 2.0, 8.0, 14.0, 20.0, 26.0, 30.0, 35.0, 37.5]
    np.testing.assert_allclose(areas(read, heights), areas(found, heights), rtol=1e-3, atol=0.1)
    assert off(impeller, read) < 0.001
    np.testing.assert_allclose(read.bounds, [data["extents"][0], data["extents"][1]], atol=0.03)


@pytest.mark.nightly
def test_the_published_impeller_is_one_solid_of_exact_surfaces(tmp_path: Path) -> None:
    files = [tmp_path / "one.step", tmp_path / "other.stp"]
    found = trunnion.write_impeller_step(EXAMPLES / "impeller.toml", files[0])
    assert found.deviation < 0.001
    assert found.volume == pytest.approx(83_753.0, rel=1e-4)
    step = files[0].read_bytes()
    assert step == found.step
    assert step.count(b"= MANIFOLD_SOLID_BREP(") == 1
    # Six blades of up to twelve patches, six channels, six tips; the rest are planes and the stock's cylinder.
    patches, turned, planes = (
        len(re.findall(rb"= %s\(" % kind, step))
        for kind in (b"B_SPLINE_SURFACE_WITH_KNOTS", b"SURFACE_OF_REVOLUTION", b"PLANE")
    )
    assert (patches, turned, planes) == (48, 12, 2)
    assert b"CYLINDRICAL_SURFACE(" in step


def test_the_same_order_gives_the_same_bytes(tmp_path: Path) -> None:
    changes = (("number = 6", "number = 2"), ("fillet_mm = 2.0", "fillet_mm = 1.0"))
    impeller = trunnion.load_impeller(changed(tmp_path, "impeller", *changes))
    body, angles = impeller_body(impeller, FEW_POINTS)
    order = Order(body, impeller.definition.stock, making._free_angle(angles), "PART")
    one, other = making._asked(order), making._asked(order)
    assert isinstance(one, Made)
    assert isinstance(other, Made)
    assert one.step == other.step


#: Points of patches, of which there are few.
FEW_POINTS = Density(33, 5, 5, 4)


@pytest.fixture(scope="module")
def published() -> Impeller:
    return trunnion.load_impeller(EXAMPLES / "impeller.toml")


@pytest.fixture
def with_few_points(monkeypatch: pytest.MonkeyPatch, kept: dict[str, Any]) -> None:
    """The published impeller has one body of few points, and one mesh, which are made once."""

    def once(name: str) -> None:
        make = getattr(making, name)
        monkeypatch.setattr(making, name, lambda *given: kept.get(name) or kept.setdefault(name, make(*given)))

    monkeypatch.setattr(making, "_DENSITIES", (FEW_POINTS,))
    once("impeller_body")
    once("impeller_model")


@pytest.fixture(scope="module")
def kept() -> dict[str, Any]:
    return {}


@pytest.mark.usefixtures("with_few_points")
@pytest.mark.parametrize(
    ("answer", "what"),
    [
        (Refusal("it falls into 2 bodies"), "makes no solid of exact surfaces: it falls into 2 bodies"),
        (Made(b"step", 70_000.0, 1, np.array([[45.0, 0.0, 1.0]])), r"its solid has 70000.0 mm³, its mesh 83\d"),
        (Made(b"step", 83_750.0, 1, np.array([[44.0, 0.0, 1.0]])), r"its faces are 1\.0000 mm off"),
    ],
)
def test_what_is_no_such_solid_leaves_no_file(
    answer: Made | Refusal, what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(making, "_asked", lambda _order: answer)
    file = tmp_path / "part.stp"
    file.write_text("older", "utf-8")
    with pytest.raises(trunnion.InputError, match=what):
        trunnion.write_impeller_step(EXAMPLES / "impeller.toml", file)
    assert file.read_text("utf-8") == "older"


@pytest.mark.usefixtures("with_few_points")
@pytest.mark.parametrize(
    ("child", "what"),
    [
        ("import sys\nprint('no libGL', file=sys.stderr)\nsys.exit(3)", "cannot load Open CASCADE: no libGL; pip"),
        ("import os\nos._exit(9)", "Open CASCADE fails: it ends with 9"),
        ("import time\ntime.sleep(60)", "Open CASCADE makes no solid of IMPELLER within 0.5 s"),
    ],
)  # fmt: skip
def test_a_kernel_that_fails_is_told(
    child: str, what: str, published: Impeller, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(making, "_CHILD", child)
    monkeypatch.setattr(making, "_LONGEST", 0.5 if "sleep" in child else 60.0)
    with pytest.raises(trunnion.InputError, match=re.escape(what)):
        making._within(published, 0.005)


def test_without_the_extra_its_installation_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "OCP", None)
    with pytest.raises(
        trunnion.InputError, match=r'needs OCP, which is not installed; run ".+" -m pip install .trunnion.cad'
    ):
        trunnion.write_impeller_step(EXAMPLES / "impeller.toml", tmp_path / "part.stp")


def test_a_name_of_another_format_is_refused(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError, match=r"is not the name of a STEP file; end it in \.stp or \.step"):
        trunnion.write_impeller_step(EXAMPLES / "impeller.toml", tmp_path / "part.stl")
