"""Klartext whose tool axis is a vector: LN blocks, read back."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, event, example, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext import CONTROLS, MACHINES, PATHS, SIMULTANEOUS, TCP, Post, motion, proven, toolpath_of
from tests.support.operations import moves_of, rapids_at
from tests.support.path_strategies import directions
from tests.support.posting import FOOT, HEAD
from trunnion.errors import InputError, RefusedError
from trunnion.machines import AngleOutput
from trunnion.model.toolpath import Moves


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


VECTOR = ("--set", "orientation=vector")


def test_a_block_that_turns_the_tool_axis_says_place_and_vector_whole(post: Post) -> None:
    blocks = motion(post(SIMULTANEOUS, *VECTOR))
    assert blocks[:4] == [
        "L X+0 Y+0 Z+50 FMAX",
        "L X+10 Z+5 F500",
        "L A+0 C-90",  # the turn at the pole
        "LN X+20 Y+0 Z+5 TX+0.5 TY+0 TZ+0.8660254",
    ]
    assert blocks[-1] == "LN X+30 Y+0 Z+5 TX+0 TY-0.5 TZ+0.8660254"
    assert all(block.startswith("LN X+2") for block in blocks[4:-1])  # points of a coarse step


@pytest.mark.parametrize("way", TCP)
def test_tcpm_then_moves_the_tool_axis_on_a_great_circle(way: str, post: Post) -> None:
    blocks = post(SIMULTANEOUS, *VECTOR, "--set", f"tcpm={way}")
    said = [block for block in blocks if block.startswith(("M128", "FUNCTION TCPM"))]
    assert said == ["M128" if way == "m128" else "FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR"]


def test_a_circle_needs_no_vector(post: Post) -> None:
    text = (
        HEAD + "CIRCLE/0.0,0.0,5.0,0.0,0.0,1.0,10.0,0.06,0.5,10.0,0.0\nGOTO/0.0,10.0,5.0\nGOTO/0,20,5,0.5,0,0.8660254\n"
    )
    blocks = motion(post(text + FOOT, *VECTOR))
    assert blocks[2:] == ["CC X+0 Y+0", "C X+0 Y+10 DR+", "L A+0 C-90", "LN X+0 Y+20 Z+5 TX+0.5 TY+0 TZ+0.8660254"]


def test_three_axis_operations_and_planes_stay_as_they_are(post: Post) -> None:
    assert post(HEAD + FOOT, *VECTOR) == post(HEAD + FOOT)


@settings(max_examples=examples(30))
@given(name=st.sampled_from(sorted(MACHINES)), moves=PATHS, way=st.sampled_from(sorted(TCP)))
def test_what_is_planned_is_proven(name: str, moves: Moves, way: str, folder: Path) -> None:
    shift = 20.0 * np.sin(np.arange(len(moves)))[:, None] * [1.0, 0.5, 0.2]
    toolpath = toolpath_of(replace(moves, tip=np.round(moves.tip + shift, 5)))
    try:
        proven(toolpath, MACHINES[name], CONTROLS["mikron_600u"], folder, tcpm=way, orientation="vector")
    except (RefusedError, InputError):
        event("refused")
        assume(False)
    # Half the last digit of an angle, whatever the machine.
    lines = [line for line in (folder / "part.h").read_text(encoding="utf-8").splitlines() if " LN " in line]
    said = np.array([[float(v) for v in re.findall(r" T[XYZ]([-+][\d.]+)", line)] for line in lines])
    event(f"vectors: {len(said) > 0}")
    # Each is one of the CL file's, or on the way from one to the next in a coarse step.
    steps = np.linalg.norm(np.diff(moves.axis, axis=0), axis=1)
    for vector in said:
        apart = np.linalg.norm(moves.axis - vector, axis=1)
        detour = 2 * (np.arcsin(apart[:-1] / 2) + np.arcsin(apart[1:] / 2) - np.arcsin(np.minimum(steps / 2, 1)))
        assert np.degrees(min(apart.min(), np.abs(detour).min(initial=np.inf))) < 5e-5


def test_a_rewind_is_said_by_the_rotary_axes(post: Post) -> None:
    """A machine whose C ends, and a path that goes round it more than once."""
    machine = post.folder / "ended.toml"
    text = 'extends = "generic_head_head_ca"\n[control]\nextends = "heidenhain_tnc640"\n'
    machine.write_text(text, encoding="utf-8")
    angles = np.radians(np.arange(0.0, 1200.0, 10.0))
    rows = "".join(
        f"GOTO/{30 * np.cos(a):.4f},{30 * np.sin(a):.4f},5,{0.5 * np.cos(a):.7f},{0.5 * np.sin(a):.7f},0.8660254\n"
        for a in angles
    )
    code, out, err = post.all(HEAD + rows + FOOT, *VECTOR, machine=str(machine))
    assert code == 0, err
    assert "draws back 50 mm in the cut to rewind" in err
    assert re.search(r"^[0-9]+ L C[-+][0-9.]+ A[-+][0-9.]+ FMAX$", out, re.MULTILINE)
    assert out.count(" LN ") > 100


def resting(tilt: list[float], azimuth: list[float], *rapids: int) -> Moves:
    """A tip that rests while the tool axis turns."""
    moves = moves_of(np.zeros((len(tilt), 3)), directions(np.array(tilt), np.array(azimuth)))
    return rapids_at(moves, list(rapids))


@settings(max_examples=examples(15))
@given(name=st.sampled_from(sorted(MACHINES)), moves=PATHS)
# A repeated rapid makes no block, and the turn at the pole, or a point of a coarse step, makes up the number of blocks.
@example(name="xyzbc_trt", moves=resting([0.0, 0.0, 12.0], [30.0, 30.0, 90.0], 0, 1))
@example(name="matsuura_mx330", moves=resting([0.3, 0.3, 12.0], [30.0, 30.0, 90.0], 0, 1))
def test_axes_stand_where_rotary_words_would_have_them(name: str, moves: Moves, folder: Path) -> None:
    """The control finds the planned position for each vector; where it would not, the block has rotary words."""
    machine, control = MACHINES[name], CONTROLS["mikron_600u"]
    try:
        runs = [
            proven(toolpath_of(moves), machine, control, folder, orientation=way).run for way in ("angles", "vector")
        ]
    except (RefusedError, InputError):
        assume(False)
    words, vectors = runs
    assert len(words) == len(vectors)
    apart = words.rotary - vectors.rotary
    for k, column in enumerate(machine.rotary):
        if machine.axes[column].endless and machine.axes[column].output is not AngleOutput.NONE:
            apart[:, k] -= 360.0 * np.rint(apart[:, k] / 360.0)
    digit = 10.0 ** -control.number_formats(three_axis=False)["angle"].decimals
    assert np.abs(apart).max() <= digit + 1e-9
