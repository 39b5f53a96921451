"""All steps of the published impeller: every pose of every linked path is clear, by exact distances."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import ROOT
from trunnion import InputError, load_impeller
from trunnion.arrays import Flags, Floats
from trunnion.impeller.flank import blade_flank, milling
from trunnion.impeller.flank.fit import Limits
from trunnion.impeller.impeller import Impeller, rotated
from trunnion.impeller.machining import step_paths
from trunnion.model.toolpath import Kind, Phase
from trunnion.simulation.tools.profile import Role

EXAMPLE = ROOT / "examples" / "impeller"

TOOLS = """
[[tool]]
number = 1
kind = "flat"
diameter_mm = 20
length_mm = 60

[[tool]]
number = 2
kind = "ball"
diameter_mm = 6
flute_length_mm = 20
length_mm = 60
holder = [{ diameter_mm = 24, height_mm = 40 }]

[[tool]]
number = 3
kind = "ball"
diameter_mm = 4
flute_length_mm = 12
length_mm = 60
"""

STEP = """
[[operation]]
kind = "{kind}"
tool = {tool}
stepover_mm = {stepover}
rpm = 5000
feed_mm_min = 400
lead_mm = 0.5
{more}
"""

COARSE = (
    ("stock roughing", 1, 20.0, "step_down_mm = 6"),
    ("stock finishing", 2, 4.0, "tilt_deg = 10"),
    ("channel roughing", 2, 3.0, "step_down_mm = 5\nallowance_mm = 0.3\nhub_allowance_mm = 0.3"),
    ("hub finish", 2, 2.5, ""),
    ("blade finish", 3, 3.0, ""),
    ("root blend", 3, 1.5, ""),
)


def impeller_with(folder, steps: str) -> Impeller:  # type: ignore[no-untyped-def]
    text = (EXAMPLE / "impeller.toml").read_text(encoding="utf-8").split("[[tool]]")[0]
    (folder / "blade_points.csv").write_bytes((EXAMPLE / "blade_points.csv").read_bytes())
    (folder / "impeller.toml").write_text(text + TOOLS + steps, encoding="utf-8")
    return load_impeller(folder / "impeller.toml")


@pytest.fixture(scope="module")
def impeller(tmp_path_factory: pytest.TempPathFactory) -> Impeller:
    steps = "".join(STEP.format(kind=kind, tool=tool, stepover=over, more=more) for kind, tool, over, more in COARSE)
    return impeller_with(tmp_path_factory.mktemp("impeller"), steps)


def up_to_tilt(axes: Floats) -> Flags:
    return np.asarray(axes[:, 2] >= np.cos(np.radians(100.0)))


def gaps(impeller: Impeller, points: Floats) -> Floats:
    """Exact distances of points to the finished impeller within its stock."""
    found = np.full(len(points), np.inf)
    stock = impeller.definition.stock
    inside = (np.hypot(points[:, 0], points[:, 1]) < stock.diameter / 2.0) & (points[:, 2] < stock.top)
    found[inside] = impeller.hub.distances(points[inside])[0]
    for blade, angle in impeller.blades():
        found[inside] = np.minimum(found[inside], blade.distances(rotated(points[inside], -angle))[0])
    return found


@pytest.mark.nightly  # of posted programs, test_impeller_cutting says it in each run
def test_no_pose_of_any_path_cuts_into_the_part(impeller: Impeller) -> None:
    made = list(step_paths(impeller, up_to_tilt))
    assert [one.step.kind for one in made] == [kind for kind, *_ in COARSE]
    for one in made:
        assert len(one.paths) == (1 if one.step.kind.startswith("stock") else 6)
        if one.radius and one.axes:
            for path in one.paths[:2]:
                assert gaps(impeller, path.centre).min() > one.radius - one.step.tolerance
                assert up_to_tilt(path.axis).all()
        for path in one.paths:
            np.testing.assert_allclose(np.linalg.norm(path.axis, axis=1), 1.0)
            rapid = path.centre[path.kind == Kind.RAPID]
            stock = impeller.definition.stock
            assert ((np.hypot(rapid[:, 0], rapid[:, 1]) > stock.diameter / 2.0 + 2.0) | (rapid[:, 2] > stock.top)).all()


def test_only_the_steps_that_are_asked_for_are_made(impeller: Impeller) -> None:
    assert [one.names for one in step_paths(impeller, None, ["STOCK_ROUGHING"])] == [("STOCK_ROUGHING",)]


@pytest.mark.nightly
def test_stages_within_a_step_tell_how_far_they_are(impeller: Impeller) -> None:
    told: dict[str, list[int]] = {}

    @contextmanager
    def progress(stage: str, total: int, _unit: str) -> Iterator[Callable[[int], None]]:
        done = told.setdefault(stage, [total, 0])

        def advance(more: int) -> None:
            done[1] += more

        yield advance

    list(step_paths(impeller, up_to_tilt, ["CHANNEL_ROUGHING"], progress))
    for stage in ("layers", "tool axes", "links"):
        total, done = told[f"CHANNEL_ROUGHING: {stage}"]
        assert done == total > 1


def test_what_is_wrong_names_the_step(impeller: Impeller, tmp_path_factory: pytest.TempPathFactory) -> None:
    large = STEP.format(kind="root blend", tool=2, stepover=1.0, more="")
    wrong = impeller_with(tmp_path_factory.mktemp("wrong"), large)
    with pytest.raises(InputError, match=r"ROOT_BLEND: a ball of radius 3 mm is larger than the fillet"):
        list(step_paths(wrong, None))
    with pytest.raises(InputError, match=r"no tool axis"):
        list(step_paths(impeller, lambda axes: np.zeros(len(axes), np.bool_), ["HUB_FINISH"]))


@pytest.mark.nightly
def test_flanks_are_milled_from_both_sides_with_the_blade_on_the_right(
    tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(blade_flank, "Limits", partial(Limits, rounds=4))  # a rough fit goes the same way
    monkeypatch.setattr(milling, "_ROUNDS", 1)
    monkeypatch.setattr(milling, "_DENSE", (101, 21))
    text = STEP.format(kind="flank milling", tool=3, stepover=1.0, more="overcut_mm = 0.01")
    long = text.replace("stepover_mm = 1.0\n", "")
    tools = TOOLS.replace("flute_length_mm = 12", "flute_length_mm = 24")
    folder = tmp_path_factory.mktemp("flanks")
    impeller_with(folder, "")
    file = folder / "impeller.toml"
    file.write_text(file.read_text(encoding="utf-8").replace(TOOLS, tools) + long, encoding="utf-8")
    impeller = load_impeller(file)
    (found,) = step_paths(impeller, up_to_tilt)
    assert len(found.paths) == 6
    assert [one.side for one in found.flanks] == [1.0, -1.0]
    for one in found.flanks:
        assert one.cut.left.largest < 0.1
    path, touching = found.paths[0], 0
    for start in np.flatnonzero(path.phase == Phase.CUT)[::4]:
        if path.phase[start + 1] != Phase.CUT:
            continue
        way = path.centre[start + 1] - path.centre[start]
        right = np.cross(way, path.axis[start])
        right /= np.linalg.norm(right)
        middle = path.centre[start] + 3.0 * path.axis[start]
        left, here, beside = impeller.blade.distances(middle + np.outer([-0.5, 0.0, 0.5], right))[0]
        if here < 2.05:  # the path goes on before and behind the flank
            assert beside < here < left
            touching += 1
    assert touching > 4
    assert gaps(impeller, path.centre).min() > 2.0 - 0.05
    least = {one.part: one for one in found.clearance}
    assert list(least) == [Role.CUTTER, Role.SHANK]
    assert least[Role.CUTTER].body != "blade 1"  # that one it cuts
    assert found.share == 1.0
    # Balls in the cutter by exact distances: hub and blades go on beyond the stock there, so that less may be found,
    # and the cutter counts from one radius above its lowest ball on, so that the next balls reach below that.
    cuts = path.phase == Phase.CUT
    lower, higher = (
        np.concatenate([path.centre[cuts] + up * path.axis[cuts] for up in np.linspace(first, 22.0, 41)])
        for first in (2.0, 4.0)
    )
    apart = [impeller.blade.distances(rotated(lower, angle))[0].min() for angle in (np.pi / 3.0, -np.pi / 3.0)]
    assert least[Role.CUTTER].distance > min(*apart, impeller.hub.distances(lower)[0].min()) - 2.0 - 0.01
    higher = higher[np.hypot(higher[:, 0], higher[:, 1]) < 40.0]
    assert least[Role.CUTTER].distance < impeller.hub.distances(higher)[0].min() - 2.0 + 0.01
    short = "diameter_mm = 4\nflute_length_mm = 24\nlength_mm = "
    fat = tools.replace(f"{short}60", f"{short}25\nholder = [{{ diameter_mm = 60, height_mm = 40 }}]")
    file.write_text(file.read_text(encoding="utf-8").replace(tools, fat), encoding="utf-8")
    with pytest.raises(InputError, match=r"FLANK_MILLING: holder and .* do not clear each other"):
        list(step_paths(load_impeller(file), up_to_tilt))


@pytest.mark.third
@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("tool = 1", "tool = 9"), "is not among the tools"),
        (("tool = 1", "tool = 2"), "stock roughing wants flat"),
        (('kind = "stock roughing"', 'kind = "stock rouging"'), "stock rouging"),
        (("stepover_mm = 20.0", "stepover_mm = 20.0\nscallop_mm = 0.1"), "either stepover_mm or scallop_mm"),
        (("rpm = 5000", "rpm = 0"), "rpm"),
        (("step_down_mm = 6", ""), "step_down_mm"),
        (("lead_mm = 0.5", "lead = 0.5"), "lead"),
    ],
)
def test_mistakes_of_a_step_are_told_with_their_line(
    change: tuple[str, str], message: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    kind, tool, over, more = COARSE[0]
    text = STEP.format(kind=kind, tool=tool, stepover=over, more=more).replace(*change)
    with pytest.raises(InputError, match=message) as told:
        impeller_with(tmp_path_factory.mktemp("wrong"), text)
    assert all(problem.line > 0 for problem in told.value.problems)


@pytest.mark.nightly
def test_splitters_are_cut_where_they_stand(tmp_path: Path) -> None:
    step = STEP.format(kind="root blend", tool=3, stepover=2.5, more='way = "spiral"\ntolerance_mm = 0.05')
    text = (EXAMPLE / "mixed_flow.toml").read_text(encoding="utf-8").split("\n[[tool]]")[0]
    (tmp_path / "mixed_flow_points.csv").write_bytes((EXAMPLE / "mixed_flow_points.csv").read_bytes())
    (tmp_path / "impeller.toml").write_text(text + TOOLS + step, encoding="utf-8")
    impeller = load_impeller(tmp_path / "impeller.toml")
    (found,) = step_paths(impeller, None)
    assert len(found.paths) == 10
    centres = np.concatenate([path.centre[path.kind == Kind.LINEAR] for path in found.paths])
    for blade, angle in impeller.blades():
        gap = blade.distances(rotated(centres, -angle))[0]
        assert gap.min() > 2.0 - 0.06
        assert (gap < 2.06).sum() > 100
    assert impeller.hub.distances(centres)[0].min() > 2.0 - 0.06
