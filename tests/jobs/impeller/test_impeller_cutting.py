"""Impellers, machined: CL files, one proven program, and what it leaves."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Never

import numpy as np
import pytest

import trunnion
from tests.support.posted_balls import (
    Fillets,
    ball_centres,
    fillet_gaps,
    fillets,
    gaps,
    nearest,
    profile_gaps,
    reaching,
)
from tests.support.yl569_curves import curves, tips_and_angles
from trunnion.impeller.impeller import rotated
from trunnion.jobs.impeller.cutting import reachable_axes
from trunnion.model.toolpath import Phase
from trunnion.placing.region import TOLERANCE
from trunnion.simulation.setup_findings import SimulationFinding

FOLDER = Path(__file__).resolve().parents[3] / "examples" / "impeller"
TEXT = (FOLDER / "impeller.toml").read_text("utf-8")

#: What the balls of the posted programs may be in a surface besides the tolerance of the step: decimals of the program.
DECIMALS = 0.0015

#: How much too far a fillet seems, of which only points are looked at.
BETWEEN = 0.001

#: Between passes of the root blend, mm.
ROOT = 0.8


def definition(folder: Path, text: str) -> Path:
    (folder / "blade_points.csv").write_bytes((FOLDER / "blade_points.csv").read_bytes())
    path = folder / "part.toml"
    path.write_text(text, "utf-8")
    return path


#: Of each operation of a channel: radius of its ball, its allowances on blade and hub, its tolerance.
BALLS = {
    "CHANNEL_ROUGHING": (3.0, (0.3, 0.3), 0.01),
    "HUB_FINISH": (3.0, (0.1, 0.0), 0.005),
    "BLADE_FINISH": (2.0, (0.0, 0.0), 0.005),
    "ROOT_BLEND": (2.0, (0.0, 0.0), 0.005),
}

ROUND = "STOCK_ROUGHING", "STOCK_FINISHING"
FOUR = (*ROUND, "CHANNEL_ROUGHING", "ROOT_BLEND")
SIX = pytest.param((*ROUND, *BALLS), marks=pytest.mark.nightly)


@pytest.fixture(scope="module", params=[FOUR, SIX], ids=["four", "six"])
def coarse(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> trunnion.ImpellerCut:
    """The published impeller with few passes: its operations with wide step-overs."""
    folder = tmp_path_factory.mktemp("impeller")
    text = TEXT.replace("stepover_mm = 0.5", "stepover_mm = 5").replace("step_down_mm = 1.5", "step_down_mm = 8")
    text = text.replace("stepover_mm = 0.8\nstep_down_mm = 1.0", "stepover_mm = 3\nstep_down_mm = 5")
    text, _, root = text.replace("stepover_mm = 0.2", "stepover_mm = 2.5").rpartition("stepover_mm = 2.5")
    return trunnion.cut_impeller(
        definition(folder, f"{text}stepover_mm = {ROOT}{root}"), machine="yl569", output=folder / "nc",
        settings={"zero": (0, 0, 0)}, operations=request.param,
    )  # fmt: skip


@pytest.fixture(scope="module")
def roots(coarse: trunnion.ImpellerCut) -> Fillets:
    return fillets(coarse.impeller)


def test_all_files_are_there_and_the_program_is_proven(coarse: trunnion.ImpellerCut) -> None:
    assert coarse.passed
    first, *others = coarse.remarks  # such wide step-overs leave more than what comes next should find
    assert first.what.startswith("STOCK_FINISHING: up to 8.5 mm of metal stand")
    in_channels = [step.step.name for step in coarse.steps[2:]]
    assert len(others) == in_channels.count("BLADE_FINISH")
    assert all(each.what.startswith("BLADE_FINISH: its shank comes as near as 1.") for each in others)
    assert [len(step.seconds) for step in coarse.steps] == [1, 1, *(6 for _ in in_channels)]
    output = coarse.result.output
    assert output is not None
    assert {file.name for file in output.parent.iterdir()} == {
        "IMPELLER.mpf", "IMPELLER.html", "STOCK_ROUGHING.spf", "STOCK_FINISHING.spf",
        *(f"{name}_{k}.spf" for name in in_channels for k in range(1, 7)),
        *(f"IMPELLER_{step.step.name}.cls" for step in coarse.steps),
    }  # fmt: skip
    assert all(step.minutes > 0.0 for step in coarse.steps)


def test_all_programs_fit_in_one_region_which_ends_where_a_slide_ends(coarse: trunnion.ImpellerCut) -> None:
    """Its corners and its best place by the words of the posted programs of all operations."""
    assert coarse.result.output is not None
    programs = sorted(coarse.result.output.parent.glob("*.spf"))
    assert len(programs) == 2 + 6 * len(coarse.steps[2:])
    found = trunnion.place(coarse.cl_files, machine="yl569", turns=[0.0], tool_length=160.0, stock="cylinder:90,35")
    assert found.fits
    assert found.region is not None
    assert found.best is not None
    rows = tips_and_angles(programs)
    limits = {"X": 250.0, "Y": 150.0, "Z": 250.0}
    corners = found.region.corners
    for corner in corners[:: max(len(corners) // 8, 1)].tolist():
        drawn = curves(rows, corner, 160.0)
        left = min(limit - float(np.abs(drawn[axis]).max()) for axis, limit in limits.items())
        assert left == pytest.approx(0.0, abs=TOLERANCE + 1e-3)
    drawn = curves(rows, found.best.zero_mm, 160.0)
    for use in found.best.axes:  # between its rows a slide may swing a little farther
        ends = float(drawn[use.axis].min()), float(drawn[use.axis].max())
        assert (use.least_mm, use.greatest_mm) == pytest.approx(ends, abs=0.02)
    (tilt,) = [axis for axis in found.best.rotary if axis.axis == "B"]
    assert (tilt.least_deg, tilt.greatest_deg) == pytest.approx((drawn["B"].min(), drawn["B"].max()), abs=1e-4)
    # Round the table: as C turns, the region reaches as far in -X as in X. The table of 700 by 420 mm has room for it.
    assert found.region.low[0] == pytest.approx(-found.region.high[0], abs=2.0)
    assert found.best.table_mm == pytest.approx(210.0 - 45.0 - abs(found.best.zero_mm[1]), abs=2e-3)
    assert np.abs(found.region.low[:2]).max() < 165.0


def test_a_cl_file_is_what_was_posted(coarse: trunnion.ImpellerCut) -> None:
    for step, file in zip(coarse.steps, coarse.cl_files, strict=True):
        read = trunnion.read_cl(file)
        assert [each.name for each in read.operations] == [each.name for each in step.toolpath.operations]
        for own, other in zip(step.toolpath.operations, read.operations, strict=True):
            np.testing.assert_array_equal(own.moves.tip, other.moves.tip)
            np.testing.assert_array_equal(own.moves.axis, other.moves.axis)
            np.testing.assert_array_equal(own.moves.phase, other.moves.phase)


def test_no_ball_of_the_posted_programs_is_in_blade_hub_or_fillet(coarse: trunnion.ImpellerCut, roots: Fillets) -> None:
    impeller = coarse.impeller
    for name, copy in product((step.step.name for step in coarse.steps[2:]), (1, 4)):  # the others are these, turned
        radius, allowances, tolerance = BALLS[name]
        slack = tolerance + DECIMALS
        centres = reaching(impeller, ball_centres(coarse, f"{name}_{copy}", radius, 0.5), radius)
        blades, hub = gaps(impeller, centres)
        assert blades.min() >= radius + allowances[0] - slack, name
        assert hub.min() >= radius + allowances[1] - slack, name
        reach = radius + max(allowances) + 2.0 * impeller.definition.fillet  # a fillet is that near to blade and hub
        beside = centres[np.maximum(blades, hub) < reach]
        assert fillet_gaps(roots, beside).min() >= radius + min(allowances) - slack, name
        # What a step is for, it touches, but for its allowance.
        touched = {"BLADE_FINISH": [blades], "HUB_FINISH": [hub]}.get(name, [blades, hub])
        for one, allowance in zip(touched, allowances if len(touched) == 2 else (0.0,), strict=True):
            assert one.min() <= radius + allowance + slack, name


def test_no_tool_that_goes_round_the_part_is_in_the_form_of_the_shroud(coarse: trunnion.ImpellerCut) -> None:
    impeller = coarse.impeller
    balls = reaching(impeller, ball_centres(coarse, "STOCK_FINISHING", 5.0, 0.5), 5.0)
    form = profile_gaps(impeller, impeller.shroud, balls)
    assert 5.0 - 0.01 - DECIMALS <= form.min() <= 5.0 + 0.01
    assert profile_gaps(impeller, impeller.hub, balls).min() >= 5.0 - 0.01 - DECIMALS
    ends = ball_centres(coarse, "STOCK_ROUGHING", 0.0, 0.5)
    inner = np.hypot(ends[:, 0], ends[:, 1]) - 10.0
    stock = impeller.definition.stock
    least = np.inf
    for up in (0.0, 1.0, 3.0, 8.0, 20.0):  # the side of the mill, up to the top of the stock
        height = np.minimum(ends[:, 2] + up, stock.top)
        there = (inner < stock.diameter / 2.0) & (ends[:, 2] < stock.top)
        edge = np.column_stack((inner, np.zeros(len(inner)), height))[there]
        least = min(least, float(impeller.shroud.distances(edge)[0].min()))
    assert 0.5 - 0.01 - DECIMALS <= least <= 0.5 + 0.01


def test_between_passes_of_the_posted_root_blend_no_more_than_the_ridge_stays_on_the_fillet(
    coarse: trunnion.ImpellerCut, roots: Fillets
) -> None:
    radius, slack = 2.0, 0.005 + DECIMALS + BETWEEN
    ridge = radius - np.sqrt(radius**2 - (ROOT / 2.0) ** 2)
    for points, angle in roots[::3]:
        copy = round(angle / (np.pi / 3.0)) + 1
        centres = rotated(ball_centres(coarse, f"ROOT_BLEND_{copy}", radius, 0.05), -angle)
        left = nearest(points, centres) - radius
        assert left.min() >= -slack
        # A ball as large as the fillet has a pass in its middle and leaves nothing there; ridges are beside it.
        assert left.max() <= ridge + slack


def test_tools_come_nowhere_near(coarse: trunnion.ImpellerCut) -> None:
    for step in coarse.steps[2:]:
        least = {one.part.value: one.distance for one in step.clearance}
        assert least["cutter"] >= 0.0
        assert least["shank"] >= 0.05
        assert least["holder"] >= 0.05


def test_one_turn_of_the_part_is_the_same_for_all_blades(coarse: trunnion.ImpellerCut) -> None:
    for step in coarse.steps[2:]:
        first, *others = step.toolpath.operations
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
    assert not found.findings
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

    monkeypatch.setattr("trunnion.jobs.impeller.cutting.simulate", failing)
    path = definition(tmp_path, ROUGHING)
    with pytest.raises(trunnion.InputError):
        trunnion.cut_impeller(path, machine="yl569", output=tmp_path / "new" / "nc", cell=2.0)
    assert not (tmp_path / "new").exists()


def test_a_cut_is_made_again_over_its_own_files_and_the_report_of_the_proof_has_the_verdict_of_the_simulation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, folder, simulated = definition(tmp_path, ROUGHING), tmp_path / "nc", trunnion.simulate

    def gouging(*given: object, **named: object) -> trunnion.SimulationResult:
        found = simulated(*given, **named)  # type: ignore[arg-type]
        finding = SimulationFinding("gouge", ("part", "tool 1"), "a.spf", 1, 1, 1, 1, 1, 0.0, 0.5, (0.0, 0.0, 0.0))
        return replace(found, findings=(finding,))

    assert trunnion.cut_impeller(path, machine="yl569", output=folder, cell=4.0).simulation is not None
    monkeypatch.setattr("trunnion.jobs.impeller.cutting.simulate", gouging)
    cut = trunnion.cut_impeller(path, machine="yl569", output=folder, cell=4.0)
    assert not cut.passed
    assert {file.name for file in folder.iterdir()} == {
        "IMPELLER.mpf", "IMPELLER.html", "IMPELLER_ROUGH.cls", "ROUGH.spf", "IMPELLER_simulation.html",
        "IMPELLER_stock.png",
    }  # fmt: skip
    for name in ("IMPELLER.html", "IMPELLER_simulation.html"):
        page = (folder / name).read_text(encoding="utf-8")
        assert '<div class="verdict bad">' in page
        assert "the program must not run as it is" in page


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


def test_a_step_whose_metal_nobody_took_is_a_warning_and_may_have_been_taken_elsewhere(tmp_path: Path) -> None:
    head, _, rest = TEXT.partition('[[operation]]\nkind = "stock roughing"')
    text = head + rest[rest.index("[[operation]]") :].replace("stepover_mm = 0.5", "stepover_mm = 5")
    told: list[trunnion.Problem] = []

    class Collector(trunnion.Observer):
        def problems(self, problems: Sequence[trunnion.Problem]) -> None:
            told.extend(problems)

    def cut(text: str, folder: str) -> trunnion.ImpellerCut:
        return trunnion.cut_impeller(
            definition(tmp_path, text), machine="yl569", output=tmp_path / folder, operations=["STOCK_FINISHING"],
            observer=Collector(),
        )  # fmt: skip

    found = cut(text, "nc")
    assert found.passed
    (remark,) = found.remarks
    assert remark in told
    assert 'stock.premachined = ["stock roughing"]' in str(remark)
    assert found.steps[0].before.form > 10.0
    elsewhere = text.replace("height_mm = 35.0", 'height_mm = 35.0\npremachined = ["stock roughing"]')
    assert cut(elsewhere, "other").remarks == ()
