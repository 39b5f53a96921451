"""Shank and holder of steps that go round the part, against the stock as it stands before them."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.errors import InputError
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.impeller import build_impeller
from trunnion.impeller.machining import StepPaths, step_paths
from trunnion.impeller.paths.passes import Pass
from trunnion.impeller.paths.stock_clearance import filled, stock_before, stock_clearances
from trunnion.simulation.tools.shapes import tool_shape
from trunnion.simulation.tools.sizes import BodyPiece, ToolKind, ToolSizes

FOLDER = Path(__file__).resolve().parents[3] / "examples" / "impeller"
TEXT = (FOLDER / "impeller.toml").read_text("utf-8").partition('[[operation]]\nkind = "channel')[0]
COARSE = (("stepover_mm = 0.5", "stepover_mm = 8"), ("step_down_mm = 1.5", "step_down_mm = 6"))
FLAT = "flute_length_mm = 40\nlength_mm = 60\nshank_diameter_mm = 20"
BALL = "flute_length_mm = 25\nlength_mm = 60\nshank_diameter_mm = 10"

#: A stock, and a tool's ball and where its holder begins and ends above the ball's centre.
RADIUS, TOP, BALL_RADIUS, BEGINS, ENDS = 40.0, 30.0, 5.0, 15.0, 45.0


def made(folder: Path, *changes: tuple[str, str]) -> list[StepPaths]:
    text = TEXT
    for old, new in (*COARSE, *changes):
        assert old in text
        text = text.replace(old, new, 1)
    (folder / "blade_points.csv").write_bytes((FOLDER / "blade_points.csv").read_bytes())
    path = folder / "part.toml"
    path.write_text(text, "utf-8")
    return list(step_paths(build_impeller(read_impeller(path)), None))


def sizes(tool: str, flutes: float, length: float, shank: float) -> tuple[str, str]:
    return tool, f"flute_length_mm = {flutes:g}\nlength_mm = {length:g}\nshank_diameter_mm = {shank:g}"


def test_a_holder_that_stays_above_the_stock_is_told(tmp_path: Path) -> None:
    rough, finish = made(tmp_path, sizes(FLAT, 8, 25, 20))
    (holder,) = rough.clearance
    lowest = float(rough.paths[0].centre[:, 2].min())
    assert (holder.part, holder.body) == ("holder", "the stock")
    assert holder.distance == pytest.approx(lowest + 25.0 - 35.0 - 0.25, abs=1e-3)
    assert finish.clearance == ()


def test_a_form_that_was_turned_elsewhere_is_the_stock(tmp_path: Path) -> None:
    head, _, rest = TEXT.partition('[[operation]]\nkind = "stock roughing"')
    text = head + rest[rest.index("[[operation]]") :]
    (tmp_path / "blade_points.csv").write_bytes((FOLDER / "blade_points.csv").read_bytes())
    wide = []
    for told in ("", 'premachined = ["stock roughing"]\n'):
        path = tmp_path / "part.toml"
        path.write_text(text.replace("[stock]\n", f"[stock]\n{told}"), "utf-8")
        impeller = build_impeller(read_impeller(path))
        (finish,) = impeller.definition.steps
        outline = stock_before(impeller, finish, 1.0)(Pass(np.zeros((2, 3)), np.zeros((2, 3)), np.zeros((2, 1))))
        wide.append(float(outline[outline[:, 1] > 20.0, 0].max()))
    assert wide[0] == pytest.approx(45.0)
    assert wide[1] < 40.0


@pytest.mark.third
@pytest.mark.parametrize(
    ("change", "what"),
    [
        (sizes(FLAT, 8, 10, 20), "ROUGHING: the holder comes 13.60 mm into the stock that stands before it"),
        (sizes(FLAT, 8, 60, 80), "ROUGHING: the shank comes 15.60 mm into the stock that stands before it"),
        (sizes(BALL, 8, 60, 20), "FINISHING: the shank comes"),
        (sizes(BALL, 8, 15, 10), "FINISHING: the holder comes"),
        (sizes(FLAT, 5.9, 60, 20), "step_down_mm is 6, and the flutes of tool 1 are 5.9 mm long"),
        (
            ("stepover_mm = 20", "stepover_mm = 20.1"),
            "stepover_mm is 20.1, and tool 1 is 20 mm wide: a wall would stay",
        ),
    ],
    ids=["holder", "shank", "shank of the ball", "holder of the ball", "short flutes", "a wall"],
)
def test_what_would_come_into_the_stock_is_refused_with_its_line(
    tmp_path: Path, change: tuple[str, str], what: str
) -> None:
    with pytest.raises(InputError) as error:
        made(tmp_path, change)
    (problem,) = error.value.problems
    assert what in problem.what
    assert problem.line > 60


@settings(max_examples=examples(25), deadline=None)
@given(
    tilt=st.floats(0.0, 80.0), across=st.floats(5.0, 70.0), height=st.floats(0.0, 40.0), wide=st.floats(6.0, 20.0),
    turn=st.floats(0.0, 6.0),
)  # fmt: skip
def test_told_distances_are_no_more_than_real_ones(
    tilt: float, across: float, height: float, wide: float, turn: float
) -> None:
    holder = (BodyPiece(2.0 * wide, 2.0 * wide, ENDS - BEGINS),)
    tool = tool_shape(
        ToolSizes(
            ToolKind.BALL, 10.0, flute_length=10.0, length=BEGINS + BALL_RADIUS, shank_diameter=10.0, holder=holder
        )
    )
    lean = np.radians(tilt)
    out, up = np.array([np.cos(turn), np.sin(turn), 0.0]), np.array([0.0, 0.0, 1.0])
    axis, across_axis = np.sin(lean) * out + np.cos(lean) * up, np.cos(lean) * out - np.sin(lean) * up
    centre = across * out + height * up
    one = Pass(np.tile(centre, (2, 1)), np.tile(out, (2, 1)), np.zeros((2, 1)))
    stock = filled(np.array([[0.0, TOP], [RADIUS, TOP], [RADIUS, 0.0]]))

    # The holder's lower face and side, densely; how far they are from a cylinder that goes on for ever below.
    angle = np.linspace(0.0, 2.0 * np.pi, 361)[:, None]
    circle = np.cos(angle) * across_axis + np.sin(angle) * np.cross(axis, out)
    rings = [(BEGINS, r) for r in np.linspace(BALL_RADIUS, wide, 40)] + [
        (h, wide) for h in np.linspace(BEGINS, ENDS, 90)
    ]
    surface = np.vstack([centre + h * axis + r * circle for h, r in rings])
    surface = surface[surface[:, 2] >= 0.0]
    beside = np.maximum(np.hypot(surface[:, 0], surface[:, 1]) - RADIUS, 0.0)
    real = float(np.hypot(beside, np.maximum(surface[:, 2] - TOP, 0.0)).min(initial=np.inf))
    try:
        found = stock_clearances(tool, BALL_RADIUS, BALL_RADIUS, [(one, np.tile(axis, (2, 1)))], lambda _: stock)
    except InputError:
        assert real <= 0.6
        return
    told = found[0].distance if found else 10.0
    assert min(real, 10.0) - 0.6 <= told <= max(real, 0.0) + (0.0 if found else np.inf)
