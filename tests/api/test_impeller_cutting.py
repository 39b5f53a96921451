"""Impellers, machined: CL files, one proven program, and what it leaves."""

from pathlib import Path
from typing import Never

import numpy as np
import pytest

import trunnion
from trunnion.api.impeller_cutting import reachable_axes
from trunnion.arrays import Floats
from trunnion.impeller.impeller import Impeller, rotated
from trunnion.model.toolpath import Kind, Phase

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "impeller"
TEXT = (FOLDER / "impeller.toml").read_text("utf-8")

#: What the balls of the posted programs may be in a surface: tolerance of the step, and the decimals of the program.
SLACK = 0.005 + 0.0015


def definition(folder: Path, text: str) -> Path:
    (folder / "blade_points.csv").write_bytes((FOLDER / "blade_points.csv").read_bytes())
    path = folder / "part.toml"
    path.write_text(text, "utf-8")
    return path


@pytest.fixture(scope="module")
def coarse(tmp_path_factory: pytest.TempPathFactory) -> trunnion.ImpellerCut:
    """The published impeller with few passes: its step-overs are ten times as wide."""
    folder = tmp_path_factory.mktemp("impeller")
    text = TEXT.replace("stepover_mm = 0.2", "stepover_mm = 2.5").replace("stepover_mm = 0.5", "stepover_mm = 5")
    text = text.replace("step_down_mm = 1.5", "step_down_mm = 8")
    operations = ["STOCK_ROUGHING", "STOCK_FINISHING", "HUB_FINISH", "BLADE_FINISH"]
    return trunnion.cut_impeller(
        definition(folder, text), machine="yl569", output=folder / "nc", operations=operations,
        settings={"zero": (0, 0, 0)},
    )  # fmt: skip


def ball_centres(found: trunnion.ImpellerCut, name: str, radius: float) -> Floats:
    """Ball centres of all motions at feed whose balls reach into the stock, from the program as it was read and run."""
    run, verification = found.result.run, found.result.verification
    assert run is not None
    assert verification is not None
    centres = []
    for rows in verification.operations:
        if not rows.name.startswith(name):
            continue
        at = np.arange(rows.first, rows.end)
        at = at[run.kind[at] == Kind.LINEAR]
        centres.append(run.tip[at] + radius * run.axis[at])
    every: Floats = np.concatenate(centres)
    return np.asarray(
        every[np.hypot(every[:, 0], every[:, 1]) < found.impeller.definition.stock.diameter / 2.0 + radius]
    )


def gaps(impeller: Impeller, points: Floats) -> tuple[Floats, Floats]:
    """Distances of points to the nearest of all blades, and to the hub."""
    blades = [blade.distances(rotated(points, -angle))[0] for blade, angle in impeller.blades()]
    return np.min(blades, axis=0), impeller.hub.distances(points)[0]


def test_all_files_are_there_and_the_program_is_proven(coarse: trunnion.ImpellerCut) -> None:
    assert coarse.passed
    assert [len(step.seconds) for step in coarse.steps] == [1, 1, 6, 6]
    output = coarse.result.output
    assert output is not None
    assert {file.name for file in output.parent.iterdir()} == {
        "IMPELLER.mpf", "IMPELLER.html", "STOCK_ROUGHING.spf", "STOCK_FINISHING.spf",
        *(f"{name}_{k}.spf" for name in ("HUB_FINISH", "BLADE_FINISH") for k in range(1, 7)),
        *(f"IMPELLER_{step.step.name}.cls" for step in coarse.steps),
    }  # fmt: skip
    assert all(step.minutes > 0.0 for step in coarse.steps)


def test_a_cl_file_is_what_was_posted(coarse: trunnion.ImpellerCut) -> None:
    for step, file in zip(coarse.steps, coarse.cl_files, strict=True):
        read = trunnion.read_cl(file)
        assert [each.name for each in read.operations] == [each.name for each in step.toolpath.operations]
        for own, other in zip(step.toolpath.operations, read.operations, strict=True):
            np.testing.assert_array_equal(own.moves.tip, other.moves.tip)
            np.testing.assert_array_equal(own.moves.axis, other.moves.axis)
            np.testing.assert_array_equal(own.moves.phase, other.moves.phase)


@pytest.mark.parametrize(("name", "radius", "allowance"), [("HUB_FINISH", 3.0, 0.1), ("BLADE_FINISH", 2.0, 0.0)])
def test_no_ball_of_the_posted_programs_is_in_a_surface(
    coarse: trunnion.ImpellerCut, name: str, radius: float, allowance: float
) -> None:
    blades, hub = gaps(coarse.impeller, ball_centres(coarse, name, radius))
    assert blades.min() >= radius - SLACK
    assert hub.min() >= radius - SLACK
    finished, other = (blades, hub) if name == "BLADE_FINISH" else (hub, blades)
    assert finished.min() <= radius + SLACK
    assert other.min() >= radius + allowance - SLACK


def test_tools_come_nowhere_near(coarse: trunnion.ImpellerCut) -> None:
    for step in coarse.steps[2:]:
        least = {one.part.value: one.distance for one in step.clearance}
        assert least["cutter"] >= 0.0
        assert least["shank"] >= 0.05
        assert least["holder"] >= 0.05


def test_one_turn_of_the_part_is_the_same_for_all_blades(coarse: trunnion.ImpellerCut) -> None:
    first, *others = (step for step in coarse.steps[2].toolpath.operations)
    cut = first.moves.phase == Phase.CUT
    for k, other in enumerate(others, 1):
        turned = rotated(first.moves.tip[cut], k * np.pi / 3.0)
        np.testing.assert_allclose(other.moves.tip[other.moves.phase == Phase.CUT], turned, atol=2e-5)


def test_the_simulation_finds_no_gouge_and_no_rapid_through_stock(coarse: trunnion.ImpellerCut) -> None:
    run = coarse.result.run
    assert run is not None
    found = trunnion.simulate(
        run, machine="yl569", stock="cylinder:90,35", cell=1.0,
        part=trunnion.model_impeller(coarse.impeller, tolerance=0.05).mesh,
        tools=[tool.shape() for tool in coarse.impeller.definition.tools],
    )  # fmt: skip
    # Without channel roughing, the hub's finish meets solid stock above its flutes.
    assert {finding.kind for finding in found.findings} <= {"shank into stock", "holder into stock"}
    assert found.gouge is not None
    assert found.gouge.largest <= 0.1


def test_directions_are_reachable_within_the_travel_of_the_rotary_axes() -> None:
    reachable = reachable_axes(trunnion.load_machine("yl569"))
    tilt = np.radians([0.0, 30.0, 99.9, 100.1, 170.0])
    turn = np.linspace(0.0, 2.0 * np.pi, 9)[:, None]
    axes = np.stack(np.broadcast_arrays(np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)), axis=2)
    found = reachable(axes.reshape(-1, 3)).reshape(9, 5)
    np.testing.assert_array_equal(found, np.broadcast_to([True, True, True, False, False], (9, 5)))


ROUGHING = (
    TEXT.partition("[[operation]]")[0]
    + """
[[operation]]
kind = "stock roughing"
name = "ROUGH"
tool = 1
stepover_mm = 20
step_down_mm = 15
rpm = 2000
feed_mm_min = 500
"""
)


def test_files_of_others_are_found_before_any_work_and_all_of_them_are_told(tmp_path: Path) -> None:
    path, folder = definition(tmp_path, ROUGHING), tmp_path / "nc"
    folder.mkdir()

    def refused(*names: str) -> None:
        for name in names:
            (folder / name).write_text("mine", encoding="utf-8")
        with pytest.raises(trunnion.InputError) as error:
            trunnion.cut_impeller(path, machine="yl569", output=folder, cell=2.0, observer=Watching())
        assert {Path(problem.file).name for problem in error.value.problems} == set(names)
        for name in names:
            assert (folder / name).read_text("utf-8") == "mine"
            (folder / name).unlink()

    class Watching(trunnion.Observer):
        def progress(self, stage: str, total: int, unit: str) -> Never:
            pytest.fail(f"{stage} has begun")

    refused("IMPELLER.mpf", "IMPELLER.html")
    refused("IMPELLER_ROUGH.cls", "ROUGH.spf", "IMPELLER_simulation.html", "IMPELLER_stock.png")


def test_a_simulation_that_fails_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(*_: object, **__: object) -> Never:
        raise trunnion.InputError([])

    monkeypatch.setattr("trunnion.api.impeller_cutting.simulate", failing)
    path = definition(tmp_path, ROUGHING)
    with pytest.raises(trunnion.InputError):
        trunnion.cut_impeller(path, machine="yl569", output=tmp_path / "new" / "nc", cell=2.0)
    assert not (tmp_path / "new").exists()


def test_a_cut_is_made_again_over_its_own_files(tmp_path: Path) -> None:
    path, folder = definition(tmp_path, ROUGHING), tmp_path / "nc"
    for _ in range(2):
        assert trunnion.cut_impeller(path, machine="yl569", output=folder, cell=4.0).simulation is not None
    assert {file.name for file in folder.iterdir()} == {
        "IMPELLER.mpf", "IMPELLER.html", "IMPELLER_ROUGH.cls", "ROUGH.spf", "IMPELLER_simulation.html",
        "IMPELLER_stock.png",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("operations", "text", "what"),
    [
        (["HUB"], TEXT, "operations: error: has 'HUB', which is none; the definition has STOCK_ROUGHING, "),
        ("HUB_FINISH", TEXT, "operations: error: is 'HUB_FINISH'"),
        ([], TEXT.partition("[[tool]]")[0], "impeller: error: has no operations"),
        (
            ["BLADE_FINISH"],
            TEXT.replace("rpm = 8000", "rpm = 10000"),
            "part.toml: error: operation BLADE_FINISH: S10000 is above the greatest speed of the spindle, 9000 rev/min",
        ),
    ],
    ids=["no such operation", "a text", "no operations", "speed"],
)
def test_what_cannot_be_made_is_told_and_writes_nothing(
    operations: list[str], text: str, what: str, tmp_path: Path
) -> None:
    path = definition(tmp_path, text)
    with pytest.raises(trunnion.InputError) as error:
        trunnion.cut_impeller(path, machine="yl569", output=tmp_path / "nc", operations=operations)
    assert what in str(error.value)
    assert not (tmp_path / "nc").exists()


def test_a_refusal_offers_nothing_that_a_cut_does_not_have(tmp_path: Path) -> None:
    text = TEXT.replace("step_down_mm = 1.5", "step_down_mm = 15")
    with pytest.raises(trunnion.RefusedError) as error:
        trunnion.cut_impeller(
            definition(tmp_path, text), machine="yl569", output=tmp_path / "nc", operations=["STOCK_ROUGHING"],
            settings={"zero": (5000, 0, 0)},
        )  # fmt: skip
    assert "no program is written" in str(error.value)
    assert "force" not in str(error.value)
    assert [path.name for path in (tmp_path / "nc").iterdir()] == ["IMPELLER.html"]
