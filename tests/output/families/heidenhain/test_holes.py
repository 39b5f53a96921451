"""Holes in Klartext, as the independent reader finds them."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext import CONTROLS, MACHINES, MODES, SHARES, Post, motion, proven
from tests.support.planes import reachable
from tests.support.posting import CLEAR, FOOT
from trunnion.cl import read_cl
from trunnion.errors import InputError, RefusedError


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


HEIGHTS = "RAPTO,3.0,FEDTO,-20.0"

#: What a CYCLE asks for, what the definition is called, and its Q parameters.
CYCLES = [
    (f"DRILL,{HEIGHTS},RTRCTO,5.0,MMPM,250", "200 DRILLING", "200+3 201-20 206+250 202+20 210+0 203+0 204+5 211+0"),
    (f"DRILL,{HEIGHTS},DWELL,REV,20,MMPR,0.1", "200 DRILLING", "200+3 201-20 206+400 202+20 210+0 203+0 204+3 211+0.3"),
    (
        "DRILL,CSINK,RAPTO,3.0,CSKDIA,10.0,TLANGL,90.0,MMPM,250",
        "200 DRILLING",
        "200+3 201-5 206+250 202+5 210+0 203+0 204+3 211+0",
    ),
    (f"REAM,{HEIGHTS},MMPM,100,DWELL,1", "201 REAMING", "200+3 201-20 206+100 211+1 208+100 203+0 204+3"),
    (
        f"DRILL,DEEP,{HEIGHTS},STEP,6.0,1.0,2.0,MMPM,250",
        "205 UNIVERSAL PECKING",
        "200+3 201-20 206+250 202+6 203+0 204+3 212+1 205+2 258+0.2 259+0.2 257+0 256+0 211+0 379+0 253+250",
    ),
    (
        f"DRILL,BRKCHP,{HEIGHTS},STEP,6.0,MMPM,250",
        "205 UNIVERSAL PECKING",
        "200+3 201-20 206+250 202+20 203+0 204+3 212+0 205+0 258+0.2 259+0.2 257+6 256+0.2 211+0 379+0 253+250",
    ),
    (
        f"DRILL,BRKCHP,{HEIGHTS},STEP,6.0,1.0,2.0,MMPM,250",
        "203 UNIVERSAL DRILLING",
        "200+3 201-20 206+250 202+6 210+0 203+0 204+3 212+1 213+99999 205+2 211+0 208MAX 256+0.2",
    ),
    (
        f"BORE,DRAG,{HEIGHTS},MMPM,100,DWELL,0.5",
        "202 BORING",
        "200+3 201-20 206+100 211+0.5 208MAX 203+0 204+3 214+0 336+0",
    ),
    (
        f"BORE,NODRAG,90,{HEIGHTS},MMPM,100",
        "202 BORING",
        "200+3 201-20 206+100 211+0 208MAX 203+0 204+3 214+3 336+90",
    ),
    (
        f"TAP,BRKCHP,{HEIGHTS},STEP,5.0,MMPR,1.25",
        "209 TAPPING W/ CHIP BRKG",
        "200+3 201-20 239+1.25 203+0 204+3 257+5 256+1 336+0 403+1",
    ),
    (
        f"TAP,DEEP,{HEIGHTS},STEP,30.0,MMPR,1.25",
        "209 TAPPING W/ CHIP BRKG",
        "200+3 201-20 239+1.25 203+0 204+3 257+20 256+0 336+0 403+1",
    ),
    (f"TAP,{HEIGHTS},MMPR,1.25", "207 RIGID TAPPING NEW", "200+3 201-20 239+1.25 203+0 204+3"),
    (f"TAP,{HEIGHTS},MMPR,1.25,OPTION", "206 TAPPING NEW", "200+3 201-20 206+5000 211+0 203+0 204+3"),
]


@pytest.mark.parametrize(("words", "name", "values"), CYCLES)
def test_each_cycle_is_defined_once_and_called_at_each_hole(words: str, name: str, values: str, post: Post) -> None:
    text = CLEAR + f"CYCLE/{words}\nGOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\nRAPID\nGOTO/20,0,50\n" + FOOT
    blocks = motion(post(text, "--set", "disengage=3"))
    definition = next(block for block in blocks if "Q200" in block)
    lines = definition.split("\n")
    assert all(line.endswith(" ~") for line in lines[:-1])
    assert not lines[-1].endswith("~")
    assert lines[0] == f"CYCL DEF {name} ~"
    found = [re.match(r"  Q(\d+)=([-+][\d.]+|MAX) ;[A-Z0-9 .-]+$", line.removesuffix(" ~")) for line in lines[1:]]
    assert " ".join("".join(q.groups()) for q in found if q) == values
    after = blocks[blocks.index(definition) + 1 :]
    assert after == ["L X+10 Y+0 FMAX M99", "L X+20 Y+0 FMAX M99", "L X+20 Y+0 Z+50 FMAX"]


def test_a_left_hand_tap_has_a_negative_pitch(post: Post) -> None:
    blocks = post(CLEAR.replace("CLW", "CCLW") + f"CYCLE/TAP,{HEIGHTS},MMPR,1.25\nGOTO/10,0,0\n" + FOOT)
    assert any("Q239=-1.25 ;" in block for block in blocks)


def test_a_table_that_tilts_one_way_has_its_sign_in_every_plane(post: Post) -> None:
    """A goes from -90 to 0: upright holes beside tilted ones are on its negative side as well."""
    holes = ["10,0,0,0,0,1", "30,0,0,0.6,0,0.8", "0,30,0,0,0,1", "-30,0,0,-0.6,0,0.8"]
    text = CLEAR + f"CYCLE/DRILL,{HEIGHTS},MMPM,250\n" + "".join(f"GOTO/{hole}\n" for hole in holes) + FOOT
    planes = [block for block in post(text) if block.startswith("PLANE SPATIAL")]
    assert len(planes) == 3  # behind the last upright hole none is turned for the way out
    assert all(block.endswith("SEQ-") for block in planes)


UNSAID = {
    "BORE,NODRAG,90,RAPTO,3.0,FEDTO,-20.0,MMPM,100": "--set disengage=1",
    "BORE,MANUAL,RAPTO,3.0,FEDTO,-20.0,MMPM,100": "no cycle of the control",
    "DRILL,BRKCHP,RAPTO,3.0,FEDTO,-20.0,STEP,6.0,1.0,MMPM,250": "write STEP,first,less,shortest",
    "TAP,BRKCHP,RAPTO,3.0,FEDTO,-20.0,STEP,6.0,1.0,2.0,MMPR,1.25": "write STEP with one number",
    "TAP,BRKCHP,RAPTO,3.0,FEDTO,-20.0,MMPR,1.25": "write STEP,first peck",
    "DRILL,DEEP,RAPTO,3.0,FEDTO,-20.0,STEP,6.0,1.0,MMPM,250": "write STEP,first,less,shortest",
    "TAP,RAPTO,3.0,FEDTO,-20.0,MMPR,1.25,DWELL,1": "leave DWELL out",
}


@pytest.mark.parametrize(("words", "why"), UNSAID.items())
def test_a_cycle_that_klartext_does_not_have_is_refused(words: str, why: str, post: Post) -> None:
    code, out, err = post.all(CLEAR + f"CYCLE/{words}\nGOTO/10,0,0\n" + FOOT)
    assert (code, out) == (2, "")
    assert why in err


HEIGHT = st.integers(0, 800).map(lambda n: n / 100.0)
HOLE = st.tuples(*[st.integers(-6000, 6000).map(lambda n: n / 100.0)] * 2, st.sampled_from([0.0, 12.5, -4.0]))


@settings(max_examples=examples(25))
@given(
    name=st.sampled_from(sorted(MACHINES)),
    mode=st.sampled_from(MODES),
    above=HEIGHT,
    back=HEIGHT,
    depth=st.integers(50, 3000).map(lambda n: n / 100.0),
    shares=st.lists(SHARES, min_size=1, max_size=3),
    holes=st.lists(HOLE, min_size=1, max_size=4),
)
def test_holes_are_proven_on_every_machine_also_where_the_axis_changes_between_them(
    name: str,
    mode: str,
    above: float,
    back: float,
    depth: float,
    shares: list[tuple[float, float]],
    holes: list[tuple[float, float, float]],
    folder: Path,
) -> None:
    machine, lines = MACHINES[name], []
    feed = "MMPR,1.25" if mode.startswith("TAP") else "MMPM,250"
    for share in shares:
        axis = reachable(machine, share)
        vector = ",".join(f"{v:.9f}" for v in axis)
        side = np.cross(axis, [0.6, 0.8, 0.0] if abs(axis[2]) > 0.5 else [0.0, 0.0, 1.0])
        side /= np.linalg.norm(side)
        points = [u * side + v * np.cross(axis, side) + w * axis for u, v, w in holes]
        lines += [f"GOTO/{','.join(f'{v:.5f}' for v in point)},{vector}" for point in points]
    words = f"CYCLE/{mode},RAPTO,{above},FEDTO,{-depth},RTRCTO,{back},{feed}\n"
    start = CLEAR.split("RAPID")[0]
    file = folder / "holes.cls"
    file.write_text(start + words + "\n".join(lines) + "\nCYCLE/OFF\n" + FOOT, encoding="utf-8")
    try:
        proven(read_cl(file), machine, CONTROLS["mikron_600u"], folder, disengage="2")
    except (RefusedError, InputError):
        assume(False)
