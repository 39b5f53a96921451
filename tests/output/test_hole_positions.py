"""Holes between which the tool turns under TCP: position blocks with a tool axis, and what is refused of them."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.holes import statements
from tests.support.planes import proven, reachable, sinumeriks
from tests.support.posting import FOOT, HEAD, Post
from tests.support.posting import post as post
from trunnion.arrays import Floats
from trunnion.cli import main
from trunnion.errors import Severity
from trunnion.machines import load_machine
from trunnion.output.holes.holes_under_tcp import _lowest_clearance
from trunnion.readers import run_program

CLEAR = HEAD.replace("FEDRAT/MMPM,500.0\nGOTO/10.0,0.0,5.0\n", "")
DRILL = "DRILL,RAPTO,3,FEDTO,-12,RTRCTO,9,MMPM,90"
CONE = [(0.8 * np.cos(a), 0.8 * np.sin(a), 0.6) for a in np.radians([0.0, 25.0, 50.0, 75.0])]


def told(*vectors: Floats) -> str:
    return ",".join(f"{value:.9f}" for vector in vectors for value in vector)


def holes(axes: list[Floats], words: str = DRILL, radius: float = 40.0) -> str:
    """Holes into a ball about the zero, along ``axes``."""
    begin = f"RAPID\nGOTO/{told(axes[0] * 100.0, axes[0])}\nCYCLE/{words}\n"
    points = "".join(f"GOTO/{told(axis * radius, axis)}\n" for axis in axes)
    return CLEAR + begin + points + f"CYCLE/OFF\nRAPID\nGOTO/{told(axes[-1] * 100.0)}\n" + FOOT


def ring() -> list[Floats]:
    return [np.array(axis) for axis in CONE]


def along_tool(folder: Path, name: str = "yl569") -> Path:
    """A machine whose cycles drill along the tool."""
    file = folder / f"along_{name}.toml"
    file.write_text(f'extends = "{name}"\n[control.reading]\ncycles_along_tool = true\n', encoding="utf-8")
    return file


def blocks_of(lines: list[str], first: str) -> list[str]:
    """From the first line that begins so, to the last rapid; without comments."""
    at = next(k for k, line in enumerate(lines) if line.startswith(first))
    end = next(k for k, line in enumerate(lines) if line.startswith(";End of Path"))
    return [line for line in lines[at:end] if not line.startswith(";")]


def test_one_modal_call_serves_holes_between_which_the_tool_turns(post: Post, tmp_path: Path) -> None:
    given = ("--set", "holes=positions", "--set", "orientation=vector")
    assert blocks_of(post(holes(ring()), *given, machine=str(along_tool(tmp_path))), "MCALL") == [
        "MCALL CYCLE81(49.,40.,3.,28.)",
        "X39.2 Z29.4",
        "X35.52727 Y16.56664 A3=.72504623 B3=.338094609 C3=.6",
        "X25.19727 Y30.02894 A3=.514230088 B3=.612835554 C3=.6",
        "X10.14571 Y37.86429 A3=.207055236 B3=.772740661 C3=.6",
        "MCALL",
        "X20.70552 Y77.27407 Z60.",
    ]


def test_rotary_words_stand_in_position_blocks_where_orientations_are_angles(post: Post, tmp_path: Path) -> None:
    lines = post(holes(ring()), "--set", "holes=positions", machine=str(along_tool(tmp_path)))
    assert blocks_of(lines, "MCALL")[:3] == [
        "MCALL CYCLE81(49.,40.,3.,28.)", "X39.2 Z29.4", "X35.52727 Y16.56664 C25.",
    ]  # fmt: skip


@pytest.mark.parametrize("decimals", [4, 5, 7])
def test_points_and_axes_of_few_decimals_prove_themselves(decimals: int, post: Post) -> None:
    """Each is rounded by itself, so that a point is not quite along the axis over its hole."""

    def said(*vectors: Floats) -> str:
        return ",".join(f"{value:.{decimals}f}" for vector in vectors for value in vector)

    turned = [
        np.array([0.5778576 * np.cos(a), 0.5778576 * np.sin(a), 0.8161376]) for a in np.radians(range(0, 360, 45))
    ]
    points = "".join(f"GOTO/{said(axis * 150.0, axis)}\n" for axis in turned)
    begin = f"RAPID\nGOTO/{said(turned[0] * 210.0, turned[0])}\nCYCLE/DRILL,RAPTO,3,FEDTO,-12,RTRCTO,50,MMPM,90\n"
    lines = post(CLEAR + begin + points + "CYCLE/OFF\n" + FOOT, "--set", "holes=torot", "--set", "mode=tcp")
    assert sum("CYCLE81" in line for line in lines) == 8


def test_a_frame_is_turned_to_the_tool_for_each_hole(post: Post) -> None:
    lines = post(holes(ring()[:2]), "--set", "holes=torot", "--set", "orientation=vector")
    hole = ["TOROT", "CYCLE81(49.,40.,3.,28.)", "TOROTOF", "TRANS"]
    turned = "X35.52727 Y16.56664 A3=.72504623 B3=.338094609 C3=.6"
    assert blocks_of(lines, "X39.2")[:10] == ["X39.2 Z29.4", *hole, turned, *hole]


def test_planes_stay_the_usual_way_and_holes_of_one_axis_are_made_in_them(post: Post) -> None:
    assert sum(line.startswith("CYCLE800(0") for line in post(holes(ring()))) == 5  # with that of the first point
    upright = CLEAR + f"CYCLE/{DRILL}\nGOTO/10,0,0\n" + FOOT
    assert post(upright) == post(upright, "--set", "holes=torot")


def test_other_depths_feeds_and_dwells_have_calls_of_their_own(post: Post, tmp_path: Path) -> None:
    axes = ring()
    deep = DRILL.replace("-12", "-15").replace("MMPM,90", "DWELL,0.5,MMPM,45")
    other = f"GOTO/{told(axes[2] * 40.0, axes[2])}\n"
    text = holes(axes).replace(other, f"CYCLE/{deep}\n{other}")
    lines = blocks_of(post(text, "--set", "holes=positions", machine=str(along_tool(tmp_path))), "F90.")
    assert [line for line in lines if not line.startswith("X")] == [
        "F90.", "MCALL CYCLE81(49.,40.,3.,28.)", "MCALL", "F45.", "MCALL CYCLE82(49.,40.,3.,25.,,0.5)", "MCALL",
    ]  # fmt: skip


def test_the_tool_goes_up_before_a_higher_hole_of_the_same_axis(post: Post, tmp_path: Path) -> None:
    first, second = ring()[:2]
    text = holes([first, second]).replace("CYCLE/OFF", f"GOTO/{told(second * 60.0, second)}\nCYCLE/OFF")
    lines = blocks_of(post(text, "--set", "holes=positions", machine=str(along_tool(tmp_path))), "MCALL")
    up = ",".join(f"{value:.5f}" for value in second * 63.0)
    assert lines[3:6] == ["MCALL", "X45.67791 Y21.29996 Z37.8", "MCALL CYCLE81(69.,60.,3.,48.)"], up


def test_position_blocks_are_refused_by_the_proof_where_cycles_drill_along_z(post: Post) -> None:
    code, out, err = post.all(holes(ring()), "--set", "holes=positions")
    assert (code, out) == (1, [])
    assert "holes         FAIL" in err


def test_a_way_that_would_cut_a_corner_is_refused(post: Post) -> None:
    far = [ring()[0], np.array([-0.4, 0.8 * np.sin(np.radians(120.0)), 0.6])]
    code, out, err = post.all(holes(far), "--set", "holes=torot")
    assert (code, out) == (2, [])
    assert "on the straight way to this hole the tool would be 17.520 mm below the height of RAPTO; put RAPID" in err
    between = f"RAPID\nGOTO/{told(far[0] * 120.0, far[0])}\nRAPID\nGOTO/{told(far[1] * 120.0, far[1])}\n"
    second = f"GOTO/{told(far[1] * 40.0, far[1])}\n"
    assert post(holes(far).replace(second, between + second), "--set", "holes=torot")


def test_boring_with_a_lift_is_refused_where_x_of_the_frame_is_not_known(post: Post) -> None:
    text = holes(ring(), "BORE,NODRAG,90,RAPTO,3,FEDTO,-12,RTRCTO,9,MMPM,90")
    code, out, err = post.all(text, "--set", "holes=torot", "--set", "bore_lift=0.5")
    assert (code, out) == (2, [])
    assert "X of the frame is not known" in err


def test_blocks_that_are_dropped_are_missed(tmp_path: Path) -> None:
    cl, nc = tmp_path / "ring.cls", tmp_path / "ring.mpf"
    cl.write_text(holes(ring()), encoding="utf-8")
    assert main(["post", str(cl), "--machine", "yl569", "--output", str(nc), "--set", "holes=torot"]) == 0
    blocks = [line.split(" ", 1)[1] for line in nc.read_text(encoding="utf-8").splitlines()]
    assert proven(blocks, cl, tmp_path) == []
    first = blocks.index("TOROT")  # what stands before leads straight to the first hole, as its cycle would
    last = len(blocks) - blocks[::-1].index("TRANS")
    for k in range(first, last):
        needless = (
            blocks[k].startswith(";") or blocks[k] == "TRANS"
        )  # that is for controls on which TOROTOF is not enough
        assert needless or proven(blocks[:k] + blocks[k + 1 :], cl, tmp_path), (k, blocks[k])
    for k in (k for k in range(first, last) if blocks[k].startswith("CYCLE81")):
        for changed in ("CYCLE81(49.,40.,3.,28.1)", "CYCLE81(49.,40.,2.9,28.)", "CYCLE81(48.9,40.,3.,28.)"):
            assert proven([*blocks[:k], changed, *blocks[k + 1 :]], cl, tmp_path), changed


def test_the_way_to_the_first_hole_may_begin_aside_of_it(tmp_path: Path) -> None:
    cl, nc = tmp_path / "aside.cls", tmp_path / "aside.mpf"
    first, aside = told(ring()[0] * 100.0, ring()[0]), told(ring()[0] * 100.0 + (0.0, 7.0, 0.0), ring()[0])
    cl.write_text(holes(ring()[:2]).replace(first, aside), encoding="utf-8")
    assert main(["post", str(cl), "--machine", "yl569", "--output", str(nc), "--set", "holes=torot"]) == 0
    blocks = [line.split(" ", 1)[1] for line in nc.read_text(encoding="utf-8").splitlines()]
    above = next(k for k, block in enumerate(blocks) if block == "TOROT") - 1
    assert blocks[above] == "X39.2 Y0.0 Z29.4"
    for changed in ("X39.2 Y0.1 Z29.4", "X33.6 Y0.0 Z25.2", "G1 X39.2 Y0.0 Z29.4"):
        assert proven([*blocks[:above], changed, *blocks[above + 1 :]], cl, tmp_path), changed
    assert proven([*blocks[:above], *blocks[above + 1 :]], cl, tmp_path)


def test_a_way_too_low_is_seen_by_the_proof(tmp_path: Path) -> None:
    near = [ring()[0], ring()[3]]
    cl, nc = tmp_path / "two.cls", tmp_path / "two.mpf"
    cl.write_text(holes(near, DRILL.replace("RTRCTO,9", "RTRCTO,30")), encoding="utf-8")
    assert main(["post", str(cl), "--machine", "yl569", "--output", str(nc), "--set", "holes=torot"]) == 0
    blocks = [line.split(" ", 1)[1] for line in nc.read_text(encoding="utf-8").splitlines()]
    low = told(near[1] * 43.0).split(",")
    at = next(k for k, block in enumerate(blocks) if block.startswith("X14.49"))
    words = f"X{float(low[0]):.5f} Y{float(low[1]):.5f} Z{float(low[2]):.5f} C75."
    assert proven([*blocks[:at], words, *blocks[at + 1 :]], cl, tmp_path) == ["holes"]


HEIGHTS = st.tuples(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0))


@settings(max_examples=examples(80), derandomize=True)
@given(HEIGHTS, HEIGHTS)
def test_the_lowest_place_of_a_way_is_that_of_all_its_places(
    one: tuple[float, float], other: tuple[float, float]
) -> None:
    part = np.linspace(0.0, 1.0, 2001)
    heights = [a + part * (b - a) for a, b in (one, other)]
    assert _lowest_clearance(one, other) == pytest.approx(float(np.maximum(*heights).min()), abs=0.051)


@pytest.mark.parametrize("name", sinumeriks())
@settings(max_examples=examples(6), derandomize=True, phases=[Phase.explicit, Phase.generate])
@given(
    words=statements().map(lambda words: re.sub("RTRCTO,[^,]*,", "", words).replace("RAPTO", "RTRCTO,25,RAPTO")),
    share=st.tuples(st.floats(0.2, 0.8), st.floats(0.2, 0.8)),
    turns=st.lists(st.tuples(*[st.floats(-0.04, 0.04)] * 2), min_size=1, max_size=4),
    way=st.sampled_from(["torot", "positions"]),
    orientation=st.sampled_from(["angles", "vector"]),
)
def test_holes_along_any_axes_are_proven_on_every_machine(
    tmp_path_factory: pytest.TempPathFactory,
    name: str,
    words: str,
    share: tuple[float, float],
    turns: list[tuple[float, float]],
    way: str,
    orientation: str,
) -> None:
    folder = tmp_path_factory.getbasetemp()
    file, program, machine = folder / "turns.cls", folder / "turns.mpf", along_tool(folder, name)
    program.unlink(missing_ok=True)
    shares = [share, *((share[0] + a, share[1] + b) for a, b in turns)]
    axes = [reachable(load_machine(machine), one) for one in shares]
    file.write_text(holes(axes, words), encoding="utf-8")
    given = ["--set", f"holes={way}", "--set", f"orientation={orientation}"]
    code = main(["post", str(file), "--machine", str(machine), "--output", str(program), *given])
    if code and not program.exists():
        return  # no room for the slides
    assert code == 0
    run = run_program(program, load_machine(machine))
    assert not [finding for finding in run.diagnostics if finding.severity is Severity.ERROR]
    depth = float(words.split("FEDTO,-")[1].split(",")[0])
    tips = run.tip[run.tcp]
    for axis in axes:
        beside = np.linalg.norm(tips - (tips @ axis)[:, None] * axis, axis=1)
        assert (tips @ axis)[beside < 1e-3].min() == pytest.approx(40.0 - depth, abs=1e-3)


@pytest.mark.parametrize("way", ["torot", "positions"])
def test_holes_go_on_in_another_file_from_where_the_tool_stands(tmp_path: Path, way: str) -> None:
    turns = np.radians(7.0 * np.arange(300))
    axes = [np.array((0.8 * np.cos(a), 0.8 * np.sin(a), 0.6)) for a in turns]
    cl, nc = tmp_path / "many.cls", tmp_path / "many.mpf"
    cl.write_text(holes(axes), encoding="utf-8")
    given = [f"holes={way}", "orientation=vector", "programs=operations", "split=20480"]
    said = [word for setting in given for word in ("--set", setting)]
    assert main(["post", str(cl), "--machine", str(along_tool(tmp_path)), "--output", str(nc), *said]) == 0
    parts = sorted(tmp_path.glob("*.spf"))
    assert len(parts) > 1
    for part in parts[1:]:
        assert part.stat().st_size <= 20480
        first = next(
            line for line in part.read_text(encoding="utf-8").splitlines() if " X" in line and "HOME" not in line
        )
        assert re.fullmatch(r"N\d+ G40 G94 G17 G0 ORIVECT X\S+ Y\S+ Z\S+ A3=\S+ B3=\S+ C3=\S+ S4000 D1 M3", first), (
            first
        )
