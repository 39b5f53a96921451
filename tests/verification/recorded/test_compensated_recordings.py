"""A machine that compensates the radius is compared with the path of the tool's centre, by the rows of the program."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.recordings import recorded
from tests.support.verifying import check
from trunnion.jobs.twin.serving import twin_program

#: The contour of a boss of 40 by 30 mm, outside of which the control inserts circles; its cutter of 12 mm.
BOSS = Path(__file__).parents[2] / "golden/compensation/contour_boss.cls"


@pytest.mark.parametrize("with_lines", [True, False])
def test_a_recording_of_the_centre_is_on_the_path(with_lines: bool, tmp_path: Path) -> None:
    program = tmp_path / "boss.mpf"
    posted = trunnion.post(BOSS, machine="yl569", output=program, settings={"radius_register": "radius"})
    assert posted.run is not None
    twin = twin_program(
        program, machine="yl569", zero=(0.0, 0.0, -200.0), tool_length=150.0, radius_register="radius",
        tools=["1=flat:12,length=75,flutes=30"],
    )  # fmt: skip
    recording = recorded(twin.timed, np.linspace(0.0, twin.timed.duration, 1500), with_lines=with_lines)

    def judged(holds: str) -> trunnion.Verification:
        return trunnion.verify(
            program, machine="yl569", cl=BOSS, zero=(0.0, 0.0, -200.0), tool_length=150.0,
            radius_register=holds,  # type: ignore[arg-type]
            recorded=recording,
        )  # fmt: skip

    right = judged("radius")
    assert check(right, "recorded").passed
    assert right.recorded is not None
    assert len(right.recorded.positions) == len(posted.run) == len(right.recorded.worst)
    assert int(right.recorded.positions.sum()) == len(right.recorded.compared)
    assert not check(judged("difference"), "recorded").passed
