"""Cutters of CL files as bodies, and those whose form a CL file leaves open."""

from dataclasses import replace
from math import radians, tan

import pytest

from trunnion.errors import InputError
from trunnion.model.toolpath import Tool
from trunnion.simulation.tools.cl_tools import cl_tool_shape
from trunnion.simulation.tools.shapes import ToolKind, ToolShape, ToolSizes, ball, bull, flat, tool_shape


def points(shape: ToolShape) -> list[tuple[float, float]]:
    """The ends of the elements of all outlines."""
    return [element.end for section in shape.sections for element in section.outline]


MILL = Tool("MILL", "R5", 10.0, 1.0, 70.0)


@pytest.mark.parametrize(
    ("tool", "kind"),
    [
        (replace(MILL, corner_radius=0.0), flat(10.0, length=70.0)),
        (replace(MILL, corner_radius=5.0), ball(10.0, length=70.0)),
        (replace(MILL, corner_radius=5.0001), ball(10.0, length=70.0)),
        (replace(MILL, flute_length=20.0, extension=50.0), bull(10.0, 1.0, length=50.0, flute_length=20.0)),
        (
            replace(MILL, corner_radius=0.0, taper_angle=3.0),
            tool_shape(ToolSizes(ToolKind.TAPER, 10.0, side_angle=3.0, length=70.0)),
        ),
        (
            replace(MILL, taper_angle=3.0, corner_centre=(5.0 - tan(radians(43.5)), 1.0)),
            tool_shape(ToolSizes(ToolKind.TAPER, 10.0, 1.0, side_angle=3.0, length=70.0)),
        ),
        (
            replace(MILL, taper_angle=3.0, corner_centre=(4.0, 1.0)),
            tool_shape(ToolSizes(ToolKind.TAPER, 8.0 + 2 * tan(radians(43.5)), 1.0, side_angle=3.0, length=70.0)),
        ),
        (
            replace(MILL, diameter=2 * tan(radians(43.5)), taper_angle=3.0, corner_centre=(0.0, 1.0)),
            tool_shape(ToolSizes(ToolKind.TAPER_BALL, 2.0, side_angle=3.0, length=70.0)),
        ),
        (
            replace(MILL, corner_radius=0.0, taper_angle=3.0, tip_angle=10.0),
            tool_shape(ToolSizes(ToolKind.DRILL, 10.0, tip_angle=160.0, side_angle=3.0, length=70.0)),
        ),
        (
            replace(MILL, taper_angle=3.0, tip_angle=10.0, corner_centre=(4.043, 1.7283)),
            tool_shape(ToolSizes(ToolKind.DRILL, 10.0, 1.0, tip_angle=160.0, side_angle=3.0, length=70.0)),
        ),
        (
            Tool("DRILL", "", 8.0, 0.0, 50.0, tip_angle=118.0, flute_length=35.0),
            tool_shape(ToolSizes(ToolKind.DRILL, 8.0, tip_angle=118.0, length=50.0, flute_length=35.0)),
        ),
        (
            replace(MILL, tip_angle=10.0),
            tool_shape(ToolSizes(ToolKind.DRILL, 10.0, 1.0, tip_angle=160.0, length=70.0)),
        ),
    ],
    ids=[
        "flat",
        "ball",
        "rounded ball",
        "bull",
        "taper",
        "round taper", "widest at its corner",
        "taper ball",
        "two cones",
        "two cones with a corner",
        "drill",
        "conical bottom",
    ],
)  # fmt: skip
def test_a_cutter_of_a_cl_file_is_a_body(tool: Tool, kind: ToolShape) -> None:
    shape = cl_tool_shape(tool, 3, file="part.cls", line=7)
    assert (shape.number, shape.name) == (3, tool.name)
    assert (shape.flute_length, shape.remarks) == (kind.flute_length, kind.remarks)
    assert points(shape) == [pytest.approx(point) for point in points(kind)]


def test_the_length_of_the_tool_change_is_the_gauge_length() -> None:
    assert cl_tool_shape(replace(MILL, set_length=180.0), 3, file="part.cls", line=7).length == 180.0


@pytest.mark.parametrize(
    ("tool", "dialect", "said"),
    [
        (Tool(), "clsf", "tool 3 is known by number or name only"),
        (Tool("MILL"), "clsf", "tool 3 is known by number or name only"),
        (Tool("TCUTTER", "", 20.0, 1.0, 60.0), "clsf", "is a TCUTTER, whose numbers"),
        (Tool("BARREL", "", 20.0, 1.0, 60.0), "clsf", "is a BARREL, whose numbers"),
        (replace(MILL, upper_radius=1.0), "clsf", "upper corner"),
        (replace(MILL, taper_angle=3.0, tip_angle=3.0), "clsf", "a corner whose centre is not stated"),
        (replace(MILL, taper_angle=3.0, tip_angle=3.0, corner_centre=(4.0, 1.0)), "clsf", "it is a form of its own"),
        (replace(MILL, taper_angle=3.0), "clsf", "a corner whose centre is not stated"),
        (
            replace(MILL, taper_angle=3.0, corner_centre=(3.0, 1.0)),
            "clsf",
            "3 from the axis and 1 above the tip",
        ),
        (replace(MILL, corner_centre=(-40.0, 12.0)), "clsf", "it is a form of its own"),
        (Tool("MILL", "", 3.0), "ncl", "Creo does not write the form of its end"),
        (replace(MILL, corner_radius=6.0), "clsf", "its corner radius is 6, more than"),
        (replace(MILL, taper_angle=-3.0, corner_radius=0.0), "clsf", "its side angle is -3"),
        (Tool("DRILL", "", 8.0), "clsf", "its tip angle is not stated"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_form_that_is_not_settled_is_refused(tool: Tool, dialect: str, said: str) -> None:
    with pytest.raises(InputError, match=r"part\.cls:7: error: tool 3") as raised:
        cl_tool_shape(tool, 3, file="part.cls", line=7, dialect=dialect)
    assert said in str(raised.value)
    assert "state the tool itself" in str(raised.value)
