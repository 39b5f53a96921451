"""Fixtures that are stated by their sizes: their pieces, and what programs do to them."""

import math
from pathlib import Path

import numpy as np
import pytest

from tests.support.simulating import SLOT, simulate
from trunnion.errors import InputError
from trunnion.jobs.inputs.bodies import fixture_files, fixture_meshes
from trunnion.simulation.fixtures import is_stated_fixture, stated_fixture

CHUCK = "chuck:160,height=70,grip=60,jaw=45x30x40"
VICE = "vice:125,opening=80,jaw=40x50,base=300x60"


def bounds(text: str) -> dict[str, list[list[float]]]:
    return {mesh.name: np.round(mesh.bounds, 3).tolist() for mesh in stated_fixture(text)}


def test_a_vice_is_a_base_and_two_jaws() -> None:
    assert bounds(VICE) == {
        "vice": [[-62.5, -150, -60], [62.5, 150, 0]],
        "vice jaw Y-": [[-62.5, -80, 0], [62.5, -40, 50]],
        "vice jaw Y+": [[-62.5, 40, 0], [62.5, 80, 50]],
    }


def test_a_vice_turns_about_the_middle_of_its_bed_and_then_moves_there() -> None:
    assert bounds(f"{VICE},turn=90,at=10/20/-30")["vice jaw Y+"] == [[-70, -42.5, -30], [-30, 82.5, 20]]


def test_a_chuck_is_a_cylinder_with_jaws_around_what_it_grips() -> None:
    body, *jaws = stated_fixture(f"{CHUCK},turn=15")
    assert body.bounds[:, 2].tolist() == [-70, 0]
    assert body.volume == pytest.approx(math.pi * 80**2 * 70, rel=1e-3)
    for number, jaw in enumerate(jaws):
        assert jaw.volume == pytest.approx(45 * 30 * 40)
        outwards = np.radians(15 + 120 * number)
        along = jaw.vertices[:, :2] @ [math.cos(outwards), math.sin(outwards)]
        assert (along.min(), along.max()) == pytest.approx((30, 75))
    assert len(jaws) == 3


@pytest.mark.parametrize("count", [2, 4, 6, 8])
def test_a_chuck_has_as_many_jaws_as_are_stated(count: int) -> None:
    assert len(stated_fixture(f"chuck:160,height=70,grip=60,jaw=45x20x40,jaws={count}")) == count + 1


def test_every_piece_is_closed_and_seen_from_outside() -> None:
    for text in (CHUCK, VICE, "box:10,20,30,-5,0,0", "cylinder:50,20,-20"):
        assert all(mesh.volume > 0 for mesh in stated_fixture(text))


@pytest.mark.parametrize(
    "text",
    ["chuck:", "chuck:1,,", "vice:125,opening=-80,jaw=40x50,base=300x60", f"{CHUCK},at=1/2", f"{CHUCK},at=1/2/nan",
     f"{CHUCK},turn=1e3", f"{CHUCK},jaws=1", f"{CHUCK},jaws=9", f"{CHUCK},height=70", "box:1,2", "cylinder:-5,10",
     "vice:" + "9" * 2000],
)  # fmt: skip
def test_what_states_no_fixture_is_refused_as_an_argument(text: str) -> None:
    with pytest.raises(InputError) as refused:
        stated_fixture(text)
    assert {problem.argument for problem in refused.value.problems} == {"fixtures"}


def test_files_are_told_from_texts(tmp_path: Path) -> None:
    assert not any(map(is_stated_fixture, ("vice.stl", "chuck", r"C:\\fixtures\\vice.stl", "Box:1,2,3", "")))
    assert fixture_files([VICE, "vice.stl", "box:1,2,3"]) == ["vice.stl"]


def test_two_of_a_kind_have_numbers() -> None:
    names = [mesh.name for mesh in fixture_meshes([VICE, f"{VICE},at=200/0/0", CHUCK], [])]
    assert names[0] == "fixture 1 vice"
    assert names[3] == "fixture 2 vice"
    assert names[6] == "fixture chuck"


def test_a_tool_that_meets_a_jaw_collides_with_it(tmp_path: Path) -> None:
    found = simulate(tmp_path, SLOT, fixtures="vice:30,opening=40,jaw=10x20,base=80x9,at=25/0/-10,turn=90")
    assert any("vice jaw" in str(finding) for finding in found.findings)
    free = simulate(tmp_path, SLOT, fixtures="vice:30,opening=40,jaw=10x2,base=80x9,at=25/0/-10")
    assert not free.findings
