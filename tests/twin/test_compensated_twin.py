"""A twin goes along the path of the tool's centre under radius compensation, or says that it does not."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from trunnion.jobs.observer import SILENT, Remembering
from trunnion.jobs.twin.serving import twin_program
from trunnion.model.toolpath import Kind

#: The contour of a pocket of 92 by 60 mm, and a cutter of 12 mm.
CONTOUR = Path(__file__).parents[1] / "golden/compensation/contour_pocket.cls"
TOOL = "1=flat:12,length=75,flutes=30"


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("twin") / "pocket.mpf"
    trunnion.post(CONTOUR, machine="yl569", output=found, settings={"radius_register": "radius"})
    return found


@pytest.mark.parametrize(
    ("given", "x", "y", "said"),
    [
        ({"radius_register": "radius", "tools": [TOOL]}, 80.0, 48.0, ""),
        ({"radius_register": "radius"}, 92.0, 60.0, "the radius of the tool is not known: the programmed path"),
        ({"tools": [TOOL]}, 92.0, 60.0, "nobody has stated what its register holds: the programmed path"),
        ({"radius_register": "difference"}, 92.0, 60.0, ""),
    ],
)
def test_the_twin_moves_the_centre_or_says_so(
    given: dict[str, object], x: float, y: float, said: str, program: Path
) -> None:
    told = Remembering(SILENT)
    found = twin_program(program, machine="yl569", observer=told, **given)  # type: ignore[arg-type]
    run = found.run
    cuts = run.tip[run.kind != Kind.RAPID]
    assert np.ptp(cuts[:, :2], axis=0) == pytest.approx((x, y), abs=1e-3)
    assert [said in str(each) for each in told.found] == ([True] if said else [])


def test_a_tool_that_does_not_fit_stops_the_machine(program: Path) -> None:
    with pytest.raises(trunnion.RefusedError, match="the tool does not fit"):
        twin_program(program, machine="yl569", radius_register="radius", tools=["1=flat:40,length=75,flutes=30"])
