"""Tool libraries in TOML: what they give, and every mistake with its line."""

from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.simulation.tools.library import ToolLibrary, read_tools
from trunnion.simulation.tools.shapes import BodyPiece, ToolKind, ToolSizes, tool_shape

LIBRARY = """\
[[tool]]
number = 3
name = "BALL_10"
kind = "ball"
description = "finishing"
diameter_mm = 10
flute_length_mm = 20
length_mm = 60.5
shank_diameter_mm = 10

[[tool.holder]]
diameter_mm = 40
height_mm = 50
[[tool.holder]]
lower_diameter_mm = 40
upper_diameter_mm = 60
height_mm = 30

[[tool]]
name = "NECKED"
kind = "taper"
diameter_mm = 4
side_angle_deg = 3
flute_length_mm = 12
length_mm = 60
neck_diameter_mm = 5
neck_length_mm = 30
shank = [{ lower_diameter_mm = 5, upper_diameter_mm = 8, height_mm = 10 }]
"""


def library(folder: Path, text: str) -> ToolLibrary:
    file = folder / "tools.toml"
    file.write_text(text, encoding="utf-8")
    return read_tools(file)


def test_a_library_has_tools_by_number_and_by_name(tmp_path: Path) -> None:
    found = library(tmp_path, LIBRARY)
    holder = (BodyPiece(40.0, 40.0, 50.0), BodyPiece(40.0, 60.0, 30.0))
    sizes = ToolSizes(ToolKind.BALL, 10.0, flute_length=20.0, length=60.5, shank_diameter=10.0, holder=holder)
    assert found.tool(3) == tool_shape(sizes, 3, "BALL_10", "finishing")
    assert found.tool(None, "BALL_10") == found.tool(3)
    necked = ToolSizes(
        ToolKind.TAPER, 4.0, side_angle=3.0, flute_length=12.0, length=60.0, neck_diameter=5.0, neck_length=30.0,
        shank=(BodyPiece(5.0, 8.0, 10.0),),
    )  # fmt: skip
    assert found.tool(7, "NECKED") == tool_shape(necked, None, "NECKED")
    with pytest.raises(InputError, match="has no tool of the number 7; add it to the library"):
        found.tool(7)
    with pytest.raises(InputError, match='has no tool of the name "X"'):
        found.tool(None, "X")


MISTAKES = """\
[[tool]]
number = -1
kind = "bal"
diameter_mm = 10

[[tool]]
kind = "ball"
diameter_mm = "10"
holder = 5

[[tool]]
number = 3
kind = "bull"
diameter_mm = 10
corner_radius_mm = 6
flute_length_mm = 30
length_mm = 20

[[tool]]
number = 3
kind = "drill"
diameter_in = 0.5
pitch_mm = 1

[[tool.holder]]
diameter_mm = 40

[[tols]]
"""


def test_every_mistake_is_told_at_once_with_its_line(tmp_path: Path) -> None:
    with pytest.raises(InputError) as raised:
        library(tmp_path, MISTAKES)
    assert [(problem.line, problem.what) for problem in raised.value.problems] == [
        (2, "tool[0].number is -1"),
        (3, 'tool[0].kind is "bal"'),
        (6, "tool[1] has neither number nor name"),
        (8, 'tool[1].diameter_mm is "10"'),
        (9, "tool[1].holder is 5"),
        (15, "tool[2].corner_radius_mm is 6, more than what fits between bottom and side"),
        (16, "tool[2].flute_length_mm is 30, more than the length 20"),
        (19, "tool[3].diameter_mm is missing"),
        (19, "tool[3].tip_angle_deg is missing"),
        (20, "tool[3].number is that of tool[2] too"),
        (22, "tool[3].diameter_in is not a key that is known here"),
        (23, "tool[3].pitch_mm is not a key that is known here"),
        (25, "tool[3].holder[0].height_mm is missing"),
        (28, "tols is not a key that is known here"),
    ]
    assert all(problem.cure for problem in raised.value.problems)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "tool is missing"),
        ("tool = 3", "tool is 3"),
        ('[[tool]]\nnumber = 1\nkind = "flat"\ndiameter_mm = nan\n', "diameter_mm is nan"),
        ('[[tool]]\nnumber = 1\nkind = "flat"\ndiameter_mm = 1e9\n', "diameter_mm is 1000000000"),
        ('[[tool]]\nnumber = 1\nkind = "drill"\ndiameter_mm = 8\ntip_angle_deg = 180\n', "tip_angle_deg is 180"),
        ('extends = "/etc/x.toml"', "is not a file that a definition may read"),
        ('extends = "shop"', 'nothing shipped is called "shop"; write the path of a .toml file'),
        ("[[tool]", "is not TOML"),
    ],
    ids=["empty", "no tables", "NaN", "too large", "flat tip", "another file", "nothing shipped", "no TOML"],
)
def test_what_is_no_library_is_refused(text: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as raised:
        library(tmp_path, text)
    assert said in str(raised.value)


def test_a_file_that_is_not_there_is_said_to_be_none(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="file not found; give the path of a tool library"):
        read_tools(tmp_path / "none.toml")


def test_a_library_may_extend_another_one_beside_it(tmp_path: Path) -> None:
    (tmp_path / "shop.toml").write_text(LIBRARY, encoding="utf-8")
    assert library(tmp_path, 'extends = "./shop.toml"\n').tool(3).number == 3
