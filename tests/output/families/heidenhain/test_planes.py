"""Tilted planes and TCP in Klartext, as the independent reader finds them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext import CONTROLS, DMU65, MACHINES, PATHS, SHARES, TCP, TILTED, Post, proven, toolpath_of
from tests.support.planes import reachable, text_of
from trunnion.cl import read_cl
from trunnion.errors import InputError, RefusedError
from trunnion.model.toolpath import Moves


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


@pytest.mark.parametrize("line", (DMU65 / "expected_planes.txt").read_text(encoding="utf-8").splitlines())
def test_the_planes_are_those_of_the_programs_that_ran(line: str, post: Post) -> None:
    name, block = line.split(": ", 1)
    text = (DMU65 / name).read_text(encoding="utf-8")
    blocks = post(text.replace("$$ center", "INTOL/0.01\nOUTTOL/0.01\n$$ center"))
    assert block in blocks
    assert blocks.index(block) < blocks.index("M3") < blocks.index("PLANE RESET STAY", blocks.index(block))


SAYING = {
    "spatial": "PLANE SPATIAL SPA+0.0 SPB+30. SPC+0.0",
    "vector": "PLANE VECTOR BX+0.8660254 BY+0 BZ-0.5 NX+0.5 NY+0 NZ+0.8660254",
    "euler": "PLANE EULER EULPR+90. EULNU+30. EULROT+270.",
    "points": "PLANE POINTS P1X+0 P1Y+0 P1Z+0 P2X+866.0254 P2Y+0 P2Z-500 P3X+0 P3Y+1000 P3Z+0",
    "relativ": "PLANE RELATIV SPC-90.",
    "axial": "PLANE AXIAL B+30 C+0",
    "cycle19": "CYCL DEF 19.1 A+0.0 B+30. C+0.0",
}

#: Ways whose block says nothing of solutions.
WITHOUT_SOLUTION = ("axial", "cycle19")


MOVES = {"turn": " TURN FMAX", "move": " MOVE ABST0 FMAX", "stay": " STAY"}


@pytest.mark.third
@pytest.mark.parametrize(("way", "block"), SAYING.items())
@pytest.mark.parametrize(("move", "words"), MOVES.items())
@pytest.mark.parametrize("solution", ["SEQ", "SYM"])
def test_a_plane_in_every_spelling(way: str, block: str, move: str, words: str, solution: str, post: Post) -> None:
    given = ("--set", f"plane={way}", "--set", f"plane_move={move}", "--set", f"plane_solution={solution}")
    blocks = post(TILTED, *given, machine="mikron_600u")
    positioned = "" if way == "cycle19" else words
    assert block + positioned + ("" if way in WITHOUT_SOLUTION else f" {solution}+") in blocks


@settings(max_examples=examples(35))
@given(name=st.sampled_from(sorted(MACHINES)), moves=PATHS, way=st.sampled_from(sorted(TCP)))
def test_what_is_planned_is_proven(name: str, moves: Moves, way: str, folder: Path) -> None:
    shift = 20.0 * np.sin(np.arange(len(moves)))[:, None] * [1.0, 0.5, 0.2]
    toolpath = toolpath_of(replace(moves, tip=moves.tip + shift))
    try:
        proven(toolpath, MACHINES[name], CONTROLS["mikron_600u"], folder, tcpm=way)
    except (RefusedError, InputError):
        assume(False)


TIPS = st.tuples(*[st.floats(-80.0, 80.0)] * 3)


@settings(max_examples=examples(30))
@given(
    name=st.sampled_from(sorted(MACHINES)),
    way=st.sampled_from(sorted(SAYING)),
    move=st.sampled_from(sorted(MOVES)),
    shares=st.lists(SHARES, min_size=1, max_size=3),
    tips=st.lists(TIPS, min_size=1, max_size=3),
)
def test_planes_are_proven_on_every_machine_that_reaches_them(
    name: str,
    way: str,
    move: str,
    shares: list[tuple[float, float]],
    tips: list[tuple[float, float, float]],
    folder: Path,
) -> None:
    machine = MACHINES[name]
    file = folder / "planes.cls"
    file.write_text(text_of([reachable(machine, share) for share in shares], tips), encoding="utf-8")
    try:
        proven(read_cl(file), machine, CONTROLS["mikron_600u"], folder, plane=way, plane_move=move)
    except (RefusedError, InputError):
        assume(False)
