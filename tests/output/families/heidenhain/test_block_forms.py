"""BLK FORM by the setting ``blank``: of the stock that a simulation or a project states, or around all cuts."""

import re
from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.simulation.stock.solids import stock_shape

MACHINES = ["dmu65", "mikron_600u", "ucp800"]
CL = """TOOL PATH/A,TOOL,D10
TLDATA/MILL,10,0,75,0,0
MSYS/0,0,0,1,0,0,0,1,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1
SPINDL/RPM,4000,CLW
RAPID
GOTO/0,0,20,0,0,1
FEDRAT/MMPM,500
GOTO/0,0,-1.5
GOTO/30.2,-4,-1.5
RAPID
GOTO/30.2,-4,20
END-OF-PATH
"""
EXTENTS = ["X+0 Y-4 Z-2", "X+31 Y+0 Z+20"]


@pytest.fixture
def part(tmp_path: Path) -> Path:
    source = tmp_path / "a.cls"
    source.write_text(CL, encoding="utf-8")
    return source


def corners(program: Path) -> list[str]:
    """Both lines of the block form."""
    return re.findall(r"BLK FORM 0\.[12] (?:Z )?(.*)", program.read_text(encoding="utf-8"))


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(
    ("blank", "expected"),
    [(None, []), ("stock", []), ("extents", EXTENTS), ("off", []), ("-1,-5,-2.5,0,1,-0.0", None)],
)
def test_without_stock_it_is_what_the_setting_says(
    blank: str | None, expected: list[str] | None, machine: str, part: Path, tmp_path: Path
) -> None:
    settings = {} if blank is None else {"blank": blank}
    program = tmp_path / "a.h"
    assert trunnion.post(part, machine=machine, output=program, settings=settings).passed
    assert corners(program) == (["X-1 Y-5 Z-2.5", "X+0 Y+1 Z+0"] if expected is None else expected)


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(("turn", "tilt"), [(0.0, 0.0), (90.0, 0.0), (30.0, 20.0)])
@pytest.mark.parametrize("stock", ["box:60,40,30,-5,-20,-29.5", "cylinder:90,30,-29.5"])
def test_it_is_the_box_of_the_stock_that_the_simulation_takes(
    stock: str, turn: float, tilt: float, machine: str, part: Path, tmp_path: Path
) -> None:
    program = tmp_path / "a.h"
    given = {"stock": stock, "tools": ["1=flat:10,length=75"], "cell": 2.0}
    done = trunnion.post(part, machine=machine, output=program, turn=turn, tilt=tilt, simulation=given)
    assert done.simulation is not None
    low, high = (
        np.array([float(number) for number in re.findall(r"[XYZ]([-+][0-9.]+)", line)]) for line in corners(program)
    )
    vertices = stock_shape(stock).as_mesh().vertices
    a, b = np.radians([turn, tilt])
    about_z = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    about_x = np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]])
    stands = vertices @ (about_z @ about_x).T
    assert np.allclose([low, high], [stands.min(axis=0), stands.max(axis=0)], atol=1e-4)
    assert not re.search(r"[XYZ]-0(?![.0-9])", "".join(corners(program)))


def test_the_first_set_up_of_a_project_has_its_stock_and_a_later_one_none(part: Path, tmp_path: Path) -> None:
    project = tmp_path / "project.toml"
    project.write_text(
        f"""machine = "dmu65"
stock = "box:60,40,30,-5,-20,-29.5"
tools = ["1=flat:10,length=75"]
[[setup]]
name = "one"
cl = ["{part.name}"]
output = "one.h"
[[setup]]
name = "two"
pose = {{ turn_deg = [180, 0, 0], origin_mm = [0, 0, -30] }}
cl = ["{part.name}"]
output = "two.h"
""",
        encoding="utf-8",
    )
    trunnion.post_project(project)
    assert corners(tmp_path / "one.h") == ["X-5 Y-20 Z-29.5", "X+55 Y+20 Z+0.5"]
    assert corners(tmp_path / "two.h") == []
