"""Tools from their sizes and from CL files: what they are, and what is refused with a cure."""

from typing import Any

import pytest

from trunnion.errors import InputError
from trunnion.simulation.tools.pieces import revolved_pieces
from trunnion.simulation.tools.shapes import (
    BodyPiece,
    ProfileArc,
    ProfileLine,
    Role,
    ToolKind,
    ToolShape,
    ToolSizes,
    ball,
    bull,
    flat,
    tool_shape,
)


def radii(shape: ToolShape) -> list[list[float]]:
    """Lowest z, highest z and greatest r of each convex piece."""
    return [[round(value, 6) for value in row] for row in revolved_pieces(shape, 0.01)[0].bounds.tolist()]


def test_a_tool_has_its_sections_from_below_to_above() -> None:
    shape = bull(
        16.0, 3.0, flute_length=25.0, length=80.0, neck_diameter=14.0, neck_length=50.0, shank_diameter=16.0,
        shank=(BodyPiece(14.0, 16.0, 5.0),), holder=(BodyPiece(30.0, 40.0, 20.0), BodyPiece(40.0, 40.0, 30.0)),
    )  # fmt: skip
    assert [section.role for section in shape.sections] == [Role.CUTTER, Role.SHANK, Role.HOLDER, Role.HOLDER]
    assert shape.sections[0].outline == (
        ProfileLine((0.0, 0.0), (5.0, 0.0)),
        ProfileArc((5.0, 0.0), (8.0, 3.0), (5.0, 3.0)),
        ProfileLine((8.0, 3.0), (8.0, 25.0)),
    )
    assert radii(shape)[1:] == [
        [25.0, 50.0, 7.0], [50.0, 80.0, 8.0], [80.0, 100.0, 20.0], [100.0, 130.0, 20.0],
    ]  # fmt: skip
    assert (shape.length, shape.flute_length, shape.top, shape.remarks) == (130.0, 25.0, 130.0, ())


def test_where_the_flutes_end_below_the_corner_the_rest_of_it_does_not_cut() -> None:
    shape = ball(10.0, flute_length=3.0, length=30.0)
    assert [(section.role, section.bottom, section.top) for section in shape.sections] == [
        (Role.CUTTER, 0.0, 3.0), (Role.SHANK, 3.0, 30.0),
    ]  # fmt: skip


def test_a_lollipop_ends_where_its_neck_begins() -> None:
    shape = tool_shape(ToolSizes(ToolKind.LOLLIPOP, 10.0, neck_diameter=6.0, length=40.0))
    assert radii(shape) == [[0.0, 9.0, 5.0], [9.0, 40.0, 3.0]]
    assert shape.flute_length == 9.0


def test_what_is_taken_for_granted_is_said() -> None:
    assert tuple(map(str, flat(10.0).remarks)) == (
        "the length is not stated: the tool is 100 mm of flutes without shank and holder",
    )
    assert tuple(map(str, flat(10.0, length=40.0).remarks)) == (
        "the flute length is not stated: all 40 mm of the tool below its holder cut",
    )
    assert flat(80.0).top == 160.0


#: Sizes, the size that is wrong, and what is said of it.
IMPOSSIBLE: dict[str, tuple[dict[str, Any], str, str]] = {
    "none": ({"diameter": 0.0}, "diameter", "is not stated"),
    "negative": ({"diameter": -4.0}, "diameter", "above 0"),
    "NaN": ({"diameter": float("nan")}, "diameter", "is nan"),
    "endless": ({"diameter": 10.0, "length": float("inf")}, "length", "is inf"),
    "metres": ({"diameter": 20_000.0}, "diameter", "at most 10000"),
    "of another kind": ({"diameter": 10.0, "pitch": 1.0}, "pitch", "no size of a tool of the kind flat"),
    "corner": ({"kind": "bull", "diameter": 10.0, "corner_radius": 5.1}, "corner_radius", "write at most 5"),
    "no corner": ({"kind": "bull", "diameter": 10.0}, "corner_radius", "needs it"),
    "level side": ({"kind": "taper", "diameter": 10.0, "side_angle": 90.0}, "side_angle", "below 90"),
    "side and tip": (
        {"kind": "drill", "diameter": 10.0, "tip_angle": 60.0, "side_angle": 30.0}, "side_angle", "never meet",
    ),
    "no tip": ({"kind": "drill", "diameter": 10.0}, "tip_angle", "needs it"),
    "tip": ({"kind": "chamfer", "diameter": 6.0, "side_angle": 45.0, "tip_diameter": 6.0}, "tip_diameter", "than 6"),
    "neck of a ball": ({"kind": "lollipop", "diameter": 6.0, "neck_diameter": 6.0}, "neck_diameter", "less than 6"),
    "flutes of a ball": (
        {"kind": "lollipop", "diameter": 10.0, "neck_diameter": 6.0, "flute_length": 9.5}, "flute_length", "at most 9",
    ),
    "disc": (
        {"kind": "t_slot", "diameter": 20.0, "flute_length": 3.0, "neck_diameter": 8.0, "corner_radius": 2.0,
         "upper_radius": 2.0}, "flute_length", "both corners",
    ),
    "thread": ({"kind": "thread_mill", "diameter": 6.0, "pitch": 4.0, "flute_length": 8.0}, "pitch", "3.464 mm deep"),
    "half a tooth": (
        {"kind": "thread_mill", "diameter": 6.0, "pitch": 2.0, "flute_length": 1.0}, "flute_length", "0 teeth",
    ),
    "too many teeth": (
        {"kind": "thread_mill", "diameter": 6.0, "pitch": 0.01, "flute_length": 100.0}, "flute_length", "10000 teeth",
    ),
    "barrel": (
        {"kind": "barrel", "diameter": 10.0, "profile_radius": 20.0, "widest_height": 19.0, "flute_length": 24.0},
        "profile_radius", "reach the tool axis",
    ),
    "corner of a barrel": (
        {"kind": "barrel", "diameter": 10.0, "profile_radius": 90.0, "widest_height": 12.0, "flute_length": 24.0,
         "corner_radius": 8.0}, "corner_radius", "more than fits",
    ),
    "flutes": ({"diameter": 10.0, "flute_length": 30.0, "length": 20.0}, "flute_length", "more than the length 20"),
    "short": ({"kind": "ball", "diameter": 10.0, "length": 4.0}, "length", "its tip alone is 5 high"),
    "shank": ({"diameter": 10.0, "shank_diameter": 8.0}, "length", "shank diameter has no place without it"),
    "shank of no height": ({"diameter": 10.0, "shank_diameter": 8.0, "length": 50.0}, "flute_length", "but the shank"),
    "neck": ({"diameter": 10.0, "neck_length": 8.0, "length": 20.0}, "neck_diameter", "write both or none"),
    "shank and neck": (
        {"diameter": 10.0, "neck_diameter": 8.0, "shank_diameter": 10.0, "length": 20.0}, "neck_length", "not stated",
    ),
    "neck above": (
        {"diameter": 10.0, "neck_diameter": 8.0, "neck_length": 30.0, "length": 20.0}, "neck_length", "not between",
    ),
    "holder": ({"diameter": 10.0, "length": 20.0, "holder": (BodyPiece(40.0, 0.0, 5.0),)}, "holder", "0 in piece 1"),
    "gauge": (
        {"diameter": 10.0, "length": 20.0, "holder": (BodyPiece(40.0, 40.0, 50.0),), "gauge_length": 60.0},
        "gauge_length", "is 70 long",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", IMPOSSIBLE)
def test_impossible_sizes_are_refused_with_a_cure(name: str) -> None:
    sizes, size, said = IMPOSSIBLE[name]
    with pytest.raises(InputError) as raised:
        tool_shape(ToolSizes(**{"kind": ToolKind(sizes.get("kind", "flat")), **_without_kind(sizes)}))
    problem = next(problem for problem in raised.value.problems if problem.file == size)
    assert said in f"{problem.what}; {problem.cure}"
    assert problem.cure


def _without_kind(sizes: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in sizes.items() if name != "kind"}
