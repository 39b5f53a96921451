"""A simulation of radius compensation with an unstated register never says that all is well."""

from pathlib import Path

import pytest

import trunnion
from tests.support.verifying import check
from trunnion.simulation.meshes import save_mesh
from trunnion.simulation.stock.solids import stock_shape

FOLDER = Path(__file__).parents[1] / "golden/compensation"

#: The contour of a pocket, and the path of the centre of its cutter of 12 mm.
CONTOUR, CENTRE = FOLDER / "contour_pocket.cls", FOLDER / "pocket.cls"
STOCK, TOOL = "box:120,80,10,-60,-40,-9", "1=flat:12,length=75,flutes=30"


@pytest.fixture(scope="module")
def programs(tmp_path_factory: pytest.TempPathFactory) -> dict[Path, Path]:
    folder = tmp_path_factory.mktemp("unstated")
    found = {cl: folder / f"{cl.stem}.mpf" for cl in (CONTOUR, CENTRE)}
    for cl, program in found.items():
        assert trunnion.post(cl, machine="yl569", output=program).passed
    return found


def wall(found: trunnion.SimulationResult) -> float:
    """Where the pocket ends along X, mm."""
    walls = [end for tile in found.simulation.stock.tiles if tile.bundle == 0 for end in tile.ends.ravel().tolist()]
    return max(end for end in walls if end < 59.0)


@pytest.mark.parametrize(
    ("cl", "given", "wide", "variant"),
    [
        # What the program says alone: the pocket would be larger by the radius.
        (CONTOUR, None, 52.0, "radius_compensation_programmed"),
        # The CL file says that the points are those of the contour, to which the operator enters the radius.
        (CONTOUR, CONTOUR, 46.0, "taken_for_radius"),
        (CENTRE, CENTRE, 46.0, "radius_compensation_programmed"),
    ],
)
def test_what_is_cut_is_not_checked(
    cl: Path, given: Path | None, wide: float, variant: str, programs: dict[Path, Path]
) -> None:
    def simulated(*, strict: bool) -> trunnion.SimulationResult:
        return trunnion.simulate(
            programs[cl], machine="yl569", stock=STOCK, tools=[TOOL], cell=2.0, cl=given or (), strict=strict
        )

    found = simulated(strict=False)
    assert wall(found) == pytest.approx(wide, abs=0.2)
    (why,) = found.cuts_not_checked
    assert "radius_register" in why
    assert "what is cut under radius compensation: not checked" in found.verdict
    assert [each.wording.variant for each in found.remarks if each.code == "SIM147"] == [variant]
    assert not simulated(strict=True).passed


def test_a_stated_register_is_checked(programs: dict[Path, Path]) -> None:
    found = trunnion.simulate(
        programs[CONTOUR], machine="yl569", stock=STOCK, tools=[TOOL], cell=2.0, radius_register="radius", strict=True
    )
    assert (found.cuts_not_checked, "not checked (nobody" in found.verdict) == ((), False)


def test_a_post_does_not_pass_its_gouges(tmp_path: Path) -> None:
    simulation = {"stock": "box:120,80,20,-60,-40,-19", "part": _box(tmp_path), "tools": [TOOL], "cell": 2.0}
    for holds, state in (("unknown", "not checked"), ("radius", "ok")):
        posted = trunnion.post(
            CONTOUR, machine="yl569", simulation=simulation, settings={"radius_register": holds},
            output=tmp_path / f"{holds}.mpf",
        )  # fmt: skip
        assert posted.verification is not None
        states = {key: check(posted.verification, key).state for key in ("removal", "gouge")}
        assert states == dict.fromkeys(states, state), holds


def _box(folder: Path) -> Path:
    """A part below the pocket, which nothing touches, as a mesh."""
    mesh = stock_shape("box:120,80,1,-60,-40,-19").as_mesh()
    save_mesh(mesh, folder / "part.stl")
    return folder / "part.stl"


def test_what_is_found_beside_inserted_rows_names_its_cl_line(tmp_path: Path) -> None:
    """Outside of the boss the control inserts circles at the corners."""
    boss, program, part = CONTOUR.with_name("contour_boss.cls"), tmp_path / "boss.mpf", tmp_path / "part.stl"
    trunnion.post(boss, machine="yl569", output=program)
    save_mesh(stock_shape("box:120,100,1,-60,-50,-9.5").as_mesh(), part)
    found = trunnion.simulate(
        program, machine="yl569", stock="box:120,100,20,-60,-50,-20", part=part, tools=[TOOL], cell=2.0, cl=boss,
        radius_register="radius",
    )  # fmt: skip
    lines = {each.cl_line for each in found.findings if each.kind == "gouge"}
    assert lines
    assert lines <= set(range(16, 27))
