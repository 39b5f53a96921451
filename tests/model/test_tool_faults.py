"""Tools that cannot be, and tools that are odd and sound."""

from dataclasses import replace

import pytest

from trunnion.errors import Severity
from trunnion.model.apt_cutter import apt_cutter
from trunnion.model.tool_faults import tool_faults
from trunnion.model.toolpath import Tool

MILL = Tool("MILL", "T", 10.0, 1.0, 50.0)
DRILL = Tool("DRILL", "T", 10.0, 0.0, 50.0, tip_angle=118.0, flute_length=40.0)

SOUND = [
    MILL,
    DRILL,
    Tool(),
    replace(MILL, corner_radius=5.0),
    replace(MILL, corner_radius=5.0005),
    replace(MILL, corner_radius=85.0, corner_centre=(-80.0, 20.0)),
    replace(MILL, kind="BARREL", corner_radius=85.0),
    replace(MILL, taper_angle=45.0, tip_angle=45.0, corner_radius=0.0),
    replace(MILL, taper_angle=-89.0),
    replace(DRILL, tip_angle=180.0),
]

IMPOSSIBLE = [
    (replace(MILL, corner_radius=7.0), "corner radius of 7, more than half its diameter 10"),
    (replace(MILL, corner_radius=-1.0), "negative corner radius"),
    (replace(MILL, diameter=-10.0), "negative diameter"),
    (replace(MILL, length=-1.0), "negative length"),
    (replace(MILL, extension=-1.0), "negative extension"),
    (replace(MILL, diameter=1e6), "diameter of 1000000 mm"),
    (replace(MILL, set_length=2e4), "set length of 20000 mm"),
    (replace(MILL, taper_angle=100.0), "side of the tool is 100 degrees"),
    (replace(MILL, tip_angle=100.0), "bottom of the tool is 100 degrees"),
    (replace(MILL, tip_angle=-1.0), "bottom of the tool is -1 degrees"),
    (replace(MILL, taper_angle=60.0, tip_angle=45.0), "never meet"),
    (replace(DRILL, tip_angle=400.0), "point of the drill has 400 degrees"),
]


@pytest.mark.parametrize("tool", SOUND, ids=range(len(SOUND)))
def test_a_sound_tool_has_no_faults(tool: Tool) -> None:
    assert tool_faults(tool) == ()


@pytest.mark.parametrize(("tool", "what"), IMPOSSIBLE, ids=[what for _, what in IMPOSSIBLE])
def test_an_impossible_tool_has_one(tool: Tool, what: str) -> None:
    (fault,) = tool_faults(tool)
    assert what in fault.wording.what
    assert fault.severity is Severity.ERROR


def test_flutes_longer_than_the_tool_are_a_warning() -> None:
    (fault,) = tool_faults(replace(DRILL, flute_length=60.0))
    assert (fault.severity, "flutes of 60 mm" in fault.wording.what) == (Severity.WARNING, True)


@pytest.mark.parametrize(
    ("tool", "seven"),
    [
        (MILL, (10, 1, 4, 1, 0, 0, 50)),
        (replace(MILL, corner_radius=0.0), (10, 0, 5, 0, 0, 0, 50)),
        (replace(MILL, corner_radius=5.0), (10, 5, 0, 5, 0, 0, 50)),
        (replace(DRILL, tip_angle=90.0), (10, 0, 5, 5, 45, 0, 50)),
        (replace(MILL, corner_radius=85.0, corner_centre=(-80.0, 20.0)), (10, 85, -80, 20, 0, 0, 50)),
        (Tool("TCUTTER", "", 40.0, 1.0, 50.0, flute_length=6.0, upper_radius=2.0), (40, 1, 19, 1, 0, 0, 6)),
    ],
    ids=["bull nose", "flat", "ball", "drill", "barrel", "t-slot"],
)
def test_a_tool_by_seven_parameters(tool: Tool, seven: tuple[float, ...]) -> None:
    assert apt_cutter(tool) == pytest.approx(seven)
