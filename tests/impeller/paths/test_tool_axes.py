"""Fields of tool axes between plates, in a wedge and on the published impeller, judged by arithmetic of their own."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.support.plates import bodies, floor, necked, slot
from trunnion.arrays import Flags, Floats
from trunnion.errors import InputError
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.impeller import Impeller, build_impeller, rotated
from trunnion.impeller.linear_program import solve_linear_program
from trunnion.impeller.paths.cell_trees import STEPS
from trunnion.impeller.paths.clearance import Obstacles, obstacles_of
from trunnion.impeller.paths.least_clearances import PartClearance
from trunnion.impeller.paths.passes import Pass, PassFamily, Way
from trunnion.impeller.paths.tool_axes import ToolAxes, Wanted, choose_axes
from trunnion.simulation.tools.profile import Role, ToolShape
from trunnion.simulation.tools.shapes import BodyPiece, ball

PUBLISHED = Path(__file__).resolve().parents[3] / "examples" / "impeller" / "impeller.toml"


def axes_of(found: ToolAxes) -> Floats:
    return np.concatenate(found.axes)


def test_between_two_plates_the_axis_stands_in_their_direction_and_does_not_turn() -> None:
    found = choose_axes(floor(1.0), necked(4.0, 25.0), slot(3.0, 20.0))
    axes = axes_of(found)
    # At 18 mm above its ball, a neck of 1.8 mm radius has 3 − 0.5 − 1.8 − 0.5 mm on one side.
    assert np.degrees(np.abs(np.arcsin(axes[:, 1]))).max() < np.degrees(np.arctan2(1.2, 10.0))
    assert found.turning < 1e-6
    assert found.share == 1.0
    np.testing.assert_allclose(np.linalg.norm(axes, axis=1), 1.0)
    for part in found.clearance:
        assert part.distance >= {"cutter": 0.06, "shank": 0.5, "holder": 2.0}[part.part] - 2e-3


def test_in_a_wedge_axes_turn_where_they_must() -> None:
    """A plate that twists along x from 20 degrees on one side to 20 on the other; 2 mm from it is the ball."""
    s, t = np.meshgrid(np.linspace(0.0, 1.0, 32 * STEPS + 1), np.linspace(0.0, 1.0, 32 * STEPS + 1), indexing="ij")
    lean = np.radians(20.0) * (1.0 - 2.0 * s)

    def twisted(y: float) -> Floats:
        return np.stack((60.0 * s - 10.0, y + 24.0 * t * np.tan(lean), 24.0 * t, 0.0 * s), axis=2)

    obstacles = bodies(twisted(3.2), twisted(-3.2))
    found = choose_axes(floor(0.4), necked(4.0, 25.0), obstacles)
    axes = axes_of(found)
    assert axes[0, 1] / axes[0, 2] > np.tan(np.radians(8.0))
    assert axes[20, 1] / axes[20, 2] < -np.tan(np.radians(8.0))
    # What must be turned is turned evenly: no faster than half as fast again as on average.
    turned = np.degrees(np.arccos(np.clip(axes[0] @ axes[20], -1.0, 1.0)))
    assert found.turning < 1.5 * turned / 40.0


@pytest.mark.nightly
def test_a_holder_that_meets_the_plates_is_named() -> None:
    with pytest.raises(InputError, match=r"holder and plate \d do not clear each other at .* mm are missing") as caught:
        choose_axes(floor(1.0), necked(4.0, 25.0, 30.0), slot(6.0, 60.0), Wanted(tilt=60.0))
    assert "longer tool" in str(caught.value)


@pytest.mark.nightly
def test_a_cutter_without_room_is_named() -> None:
    with pytest.raises(InputError, match=r"cutter and plate \d do not clear each other"):
        choose_axes(floor(0.2), necked(4.0, 25.0), slot(2.05, 20.0))


@pytest.mark.nightly
def test_fewer_clearances_are_kept_where_not_all_can_be_had() -> None:
    found = choose_axes(floor(0.2), necked(4.0, 20.0), slot(3.2, 30.0))  # the shank of 6 mm has 0.1 mm there
    assert 0.0 <= found.share < 1.0
    least = {str(part.part): part.distance for part in found.clearance}
    assert 0.05 - 2e-3 <= least["shank"] < 0.5


@pytest.mark.nightly
def test_axes_stay_within_what_a_machine_reaches() -> None:
    def reachable(directions: Floats) -> Flags:
        return np.asarray(directions[:, 0] >= np.sin(np.radians(25.0)))

    found = choose_axes(floor(1.0), necked(4.0, 25.0), slot(3.0, 20.0), reachable=reachable)
    assert axes_of(found)[:, 0].min() >= np.sin(np.radians(25.0))
    with pytest.raises(InputError, match="in the machine's reach"):
        choose_axes(floor(1.0), necked(4.0, 25.0), slot(3.0, 20.0), reachable=lambda one: np.zeros(len(one), bool))


def test_a_field_that_goes_round_comes_back_to_itself() -> None:
    """A ball that climbs round a post of 10 mm radius within a wall: axes lean outward from neither."""
    angle, z = np.meshgrid(*(np.linspace(0.0, 1.0, n * STEPS + 1) for n in (128, 32)), indexing="ij")
    angle = 2.0 * np.pi * angle

    def wall(radius: float) -> Floats:
        return np.stack((radius * np.cos(angle), radius * np.sin(angle), 20.0 * z, 0.0 * z), axis=2)

    turns = np.linspace(0.0, 2.0, 121)
    centre = np.column_stack((13.0 * np.cos(2 * np.pi * turns), 13.0 * np.sin(2 * np.pi * turns), 2.0 + 2.0 * turns))
    place = np.column_stack((np.mod(turns, 1.0), turns / 2.0))
    family = PassFamily((Pass(centre, centre / 13.0, place),), 2.0, Way.SPIRAL)
    found = choose_axes(family, necked(4.0, 25.0), bodies(wall(10.0), wall(22.0)))
    start, end = (found.field.axes(np.array([[along, 0.5]])) for along in (1e-9, 1.0 - 1e-9))
    np.testing.assert_allclose(start, end, atol=1e-6)
    assert found.turning < 0.5


@pytest.fixture(scope="module")
def published() -> tuple[Impeller, Obstacles]:
    impeller = build_impeller(read_impeller(PUBLISHED))
    return impeller, obstacles_of(impeller)


def beside_the_blade(impeller: Impeller, count: int = 8) -> PassFamily:
    """Rows of a ball of 4 mm that touches one side of the first blade, off the hub by at least 0.3 mm."""
    w = np.linspace(0.03, 0.95, 80)
    lines, normals = [], []
    for share in np.linspace(0.0, 1.0, count):
        low, high = np.full(80, -0.2), np.full(80, 1.0)
        for _ in range(30):
            v = (low + high) / 2.0
            centre, normal = impeller.blade.sides(w, v, 1.0)
            centre = centre + (impeller.blade.halves(w, v) + 2.0)[:, None] * normal
            is_clear = impeller.hub.distances(centre)[0] >= 2.3
            low, high = np.where(is_clear, low, v), np.where(is_clear, v, high)
        v = high + share * np.maximum(0.95 - high, 0.0)
        centre, normal = impeller.blade.sides(w, v, 1.0)
        lines.append(centre + (impeller.blade.halves(w, v) + 2.0)[:, None] * normal)
        normals.append(normal)
    shares = np.linspace(0.0, 1.0, count)
    passes = [Pass(c, n, np.column_stack((w, np.full(80, s)))) for c, n, s in zip(lines, normals, shares, strict=True)]
    return PassFamily(tuple(passes), 2.0, Way.ONE_WAY)


def on_the_hub(impeller: Impeller) -> PassFamily:
    """Rows of a ball of 6 mm on the hub, in the middle of the first channel."""
    passes = []
    w = np.linspace(0.05, 0.9, 60)
    for share in np.linspace(0.4, 0.6, 5):
        foot = rotated(impeller.blade.frames(w, np.zeros(60))[0], share * np.pi / 3.0)
        distance, normal, _ = impeller.hub.distances(foot)
        place = np.column_stack((w, np.full(60, (share - 0.4) / 0.2)))
        passes.append(Pass(foot + (3.0 - distance)[:, None] * normal, normal, place))
    return PassFamily(tuple(passes), 3.0, Way.BOTH_WAYS)


def room(impeller: Impeller, family: PassFamily, found: ToolAxes, tool: ToolShape) -> float:
    """The least distance of all blades from balls along the axis, which the tool without its holder is made of, mm."""
    least = np.inf
    centre, axes = family.centres()[::3], axes_of(found)[::3]
    for section in tool.sections[:2]:
        for element in section.outline:
            for share in np.linspace(0.0, 1.0, 8):
                r = (1.0 - share) * element.start[0] + share * element.end[0]
                z = (1.0 - share) * element.start[1] + share * element.end[1] - family.radius
                points = centre + z * axes
                inside = (np.hypot(points[:, 0], points[:, 1]) < 45.0) & (impeller.shroud.distances(points)[0] < -r)
                if z < 0.0 or not inside.any():
                    continue
                for blade, angle in impeller.blades():
                    least = min(least, float(blade.distances(rotated(points[inside], -angle))[0].min()) - r)
    return least


@pytest.mark.nightly  # test_impeller_cutting says it of posted programs in each run
@pytest.mark.parametrize(
    ("rows_of", "diameter", "most"),
    [(beside_the_blade, 4.0, 1.5), (on_the_hub, 6.0, 0.5)],
)
def test_fields_on_the_published_impeller_are_clear_and_smooth(
    published: tuple[Impeller, Obstacles], rows_of: object, diameter: float, most: float
) -> None:
    impeller, obstacles = published
    family = beside_the_blade(impeller) if rows_of is beside_the_blade else on_the_hub(impeller)
    tool = necked(diameter, 24.0)
    found = choose_axes(family, tool, obstacles)
    assert found.share == 1.0
    assert found.turning < most
    assert room(impeller, family, found, tool) > -0.006
    axes = axes_of(found)
    assert np.degrees(np.arccos(axes[:, 2])).max() <= 100.0
    for part in found.clearance:
        assert part.distance >= {"cutter": 0.06, "shank": 0.5, "holder": 2.0}[part.part] - 2e-3


@pytest.mark.nightly
def test_a_tool_too_short_for_the_published_impeller_is_refused(published: tuple[Impeller, Obstacles]) -> None:
    impeller, obstacles = published
    stub = ball(6.0, flute_length=6.0, length=8.0, holder=(BodyPiece(20, 24, 30), BodyPiece(40, 40, 20)))
    with pytest.raises(InputError, match=r"holder and .* do not clear each other at .* along, .* across \(radius"):
        choose_axes(on_the_hub(impeller), stub, obstacles)


@pytest.mark.parametrize(
    ("distance", "words"),
    [(2.5, "holder 2.500 mm from blade 1"), (10.0, "holder 10 mm or more from all blades and the hub")],
)
def test_a_clearance_beyond_what_is_measured_is_told_as_such(distance: float, words: str) -> None:
    assert str(PartClearance(Role.HOLDER, "blade 1", distance, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))) == words


@pytest.mark.nightly
def test_a_field_without_end_is_refused_and_one_that_only_bends_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    solver = "trunnion.impeller.paths.axis_field.solve_linear_program"
    calls = []

    def first_only(*arguments: Any) -> Floats | None:
        calls.append(arguments)
        return solve_linear_program(*arguments) if len(calls) % 2 else None

    monkeypatch.setattr(solver, first_only)
    found = choose_axes(floor(1.0), necked(4.0, 25.0), slot(3.0, 20.0))
    assert len(calls) >= 2
    assert found.share == 1.0
    monkeypatch.setattr(solver, lambda *_: None)
    with pytest.raises(InputError, match="limit of iterations"):
        choose_axes(floor(1.0), necked(4.0, 25.0), slot(3.0, 20.0))
