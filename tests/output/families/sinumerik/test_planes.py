"""Tilted planes on a Sinumerik: angles, both commands on every machine, and the safe order of their blocks."""

import itertools
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.examples import THIRDS, examples
from tests.support.naive.chains import turned
from tests.support.planes import ANGLES, SHARES, proven, reachable, sinumeriks, text_of
from tests.support.posting import FOOT, HEAD, Post
from tests.support.posting import post as post
from trunnion.cli import main
from trunnion.machines import load_machine
from trunnion.output.coordinates.euler_angles import tait_bryan_angles
from trunnion.output.families.sinumerik.writer import swivel_axes
from trunnion.readers import run_program

OFF_AXIS = HEAD.replace("0.0,0.0,50.0,0.0,0.0,1.0", "0.0,0.0,50.0,0.5,0.0,0.866025403784")
MODES = {57: "XYZ", 27: "ZYX", 39: "ZXY", 45: "XZY", 30: "YZX", 54: "YXZ"}


@pytest.mark.third
@pytest.mark.parametrize(("mode", "letters"), MODES.items())
def test_the_modes_name_their_axes(mode: int, letters: str) -> None:
    assert "".join("XYZ"[axis] for axis in swivel_axes(mode)) == letters


@given(st.sampled_from(list(itertools.permutations(range(3)))), ANGLES, ANGLES, ANGLES)
def test_three_turns_make_the_matrix_again(order: tuple[int, int, int], a: float, b: float, c: float) -> None:
    matrix = turned(order[0], a) @ turned(order[1], b) @ turned(order[2], c)
    found = tait_bryan_angles(matrix, order)
    again = turned(order[0], found[0]) @ turned(order[1], found[1]) @ turned(order[2], found[2])
    np.testing.assert_allclose(again, matrix, atol=3e-8)  # beside the place where two turns become one


TIPS = st.tuples(*[st.floats(-80.0, 80.0)] * 3)


@pytest.mark.third
@pytest.mark.parametrize("name", sinumeriks())
@pytest.mark.parametrize("way", ["cycle800", "frames"])
@settings(max_examples=examples(6), derandomize=True, suppress_health_check=list(HealthCheck))
@given(shares=st.lists(SHARES, min_size=1, max_size=3), tips=st.lists(TIPS, min_size=1, max_size=3), mode=st.data())
def test_planes_are_proven_on_every_machine_that_reaches_them(
    tmp_path_factory: pytest.TempPathFactory,
    name: str,
    way: str,
    shares: list[tuple[float, float]],
    tips: list[tuple[float, float, float]],
    mode: st.DataObject,
) -> None:
    machine = load_machine(name)
    folder = tmp_path_factory.getbasetemp()
    file, program = folder / "planes.cls", folder / "planes.mpf"
    program.unlink(missing_ok=True)
    file.write_text(text_of([reachable(machine, share) for share in shares], tips), encoding="utf-8")
    given = ["--set", f"plane={way}", "--set", f"swivel_mode={mode.draw(st.sampled_from(sorted(MODES)))}"]
    code = main(["post", str(file), "--machine", name, "--output", str(program), *given])
    if code == 1 and not program.exists():
        return  # the slides have no room: refused by the planner with a reason, never by the proof
    assert code == 0
    run = run_program(program, machine)
    assert not [finding for finding in run.diagnostics if "CYCLE800" in finding.text], (
        "the pose asked for is the one taken"
    )
    order = [
        line for line in program.read_text(encoding="utf-8").splitlines() if "TRAORI" in line or "CYCLE800(0" in line
    ]
    assert bool(order) == any(abs(share[1]) > 0 or True for share in shares) or not order


STATEMENTS = {
    "cycle800": ["TRAFOOF", "G0 B30. C0.0", "COMPOF", "CYCLE832(0.01, _ORI_SEMIFIN,1)", "G54"],
    "frames": ["G0 B30. C0.0", "CYCLE832(_camtolerance,_ORI_SEMIFIN,1)", "TRAORI", "G54"],
}


def test_cycle800_stands_between_the_turn_and_the_approach(post: Post) -> None:
    lines = post(OFF_AXIS + FOOT)
    begin = lines.index(";Initial Move")
    assert lines[begin + 1 : begin + 9] == [
        *STATEMENTS["cycle800"],
        'CYCLE800(0,"",0,57,0.0,0.0,0.0,0.,30.,0.,0,0,0,1,0,1)',
        "G0 X-25. Y0.0",
        ";Rapid Move",
    ]
    end = lines.index(";End of Path")
    assert lines[end + 1 : end + 3] == ["SUPA G0 Z=_Z_HOME D0", "CYCLE800()"]


def test_the_frame_way_turns_the_zero_under_traori(post: Post) -> None:
    lines = post(OFF_AXIS + FOOT, "--set", "plane=frames")
    begin = lines.index(";Initial Move")
    planes = ["TRANS X0.0 Y0.0 Z0.0", "AROT X0.", "AROT Y30.", "AROT Z0."]
    assert lines[begin + 1 : begin + 9] == [*STATEMENTS["frames"], *planes]
    end = lines.index(";End of Path")
    assert lines[end + 1 : end + 4] == ["TRANS", "TRAFOOF", "SUPA G0 Z=_Z_HOME D0"]


def test_no_rotary_words_stand_in_a_plane_even_after_a_text_of_the_cl_files_own(post: Post) -> None:
    lines = post(OFF_AXIS + "INSERT/H1=5\nGOTO/20,0,5\n" + FOOT)
    part = lines[lines.index("H1=5") : lines.index(";End of Path")]
    assert not any(" B" in line or " C" in line for line in part)


NONSENSE = {"plane": "euler", "swivel_mode": "58", "mode": "3+2", "frame": "own", "bore_lift": "nan"}


@pytest.mark.parametrize(("key", "value"), NONSENSE.items())
def test_settings_that_make_no_sense_are_errors(key: str, value: str, post: Post) -> None:
    code, out, err = post.all(OFF_AXIS + FOOT, "--set", f"{key}={value}")
    assert (code, out) == (2, [])
    assert f"{key} is {value!r}" in err


# Blocks of the safe order, dropped or swapped one at a time: each fault must be seen.

PLANE_BLOCKS = ("SUPA", "CYCLE800", "TRANS", "AROT", "TRAORI", "TRAFOOF", "G0 B", "G54")


def tilted(name: str, tool: int, b: float, c: float) -> str:
    """An operation whose coordinate system is tilted by B and C, off the workpiece zero."""
    matrix = turned(2, c) @ turned(1, b)
    frame = ",".join(f"{v:.9f}" for v in (12.5, -7.0, 3.0, *matrix[:, 0], *matrix[:, 1]))
    head = HEAD.replace("OP1", name).replace("LOAD/TOOL,1", f"LOAD/TOOL,{tool}")
    lines = [f"MSYS/{frame}" if line.startswith("MSYS") else line for line in head.splitlines()]
    return "\n".join(lines) + "\nGOTO/20,15,5\nRAPID\nGOTO/20,15,50\n" + FOOT


def two_planes(folder: Path, way: str) -> tuple[Path, Path]:
    """A program with an upright operation, two planes and one with a second tool, and its CL file."""
    cl, nc = folder / "two.cls", folder / "two.mpf"
    planes = tilted("OP2", 1, 30.0, 20.0) + tilted("OP3", 1, 50.0, -40.0) + tilted("OP4", 2, 20.0, 110.0)
    cl.write_text(HEAD + FOOT + planes, encoding="utf-8")
    assert main(["post", str(cl), "--machine", "yl569", "--output", str(nc), "--set", f"plane={way}"]) == 0
    return cl, nc


@pytest.mark.parametrize("third", THIRDS)
@pytest.mark.parametrize("way", ["cycle800", "frames"])
def test_a_block_of_the_safe_order_that_is_dropped_is_missed(way: str, third: int, tmp_path: Path) -> None:
    cl, nc = two_planes(tmp_path, way)
    lines = nc.read_text(encoding="utf-8").splitlines()
    assert proven(lines, cl, tmp_path) == []
    start = next(k for k, line in enumerate(lines) if line.endswith("Operation : OP2"))
    for k in range(start + third, len(lines), 3):
        block = lines[k].split(" ", 1)[1]
        if not block.startswith(PLANE_BLOCKS) or proven(lines[:k] + lines[k + 1 :], cl, tmp_path):
            continue
        turns_itself = way == "cycle800" and block.startswith("G0 B")
        homed = block.startswith("SUPA G0") and _again(lines, k)
        holds_anyway = block == "G54" or (block == "TRAFOOF" and _again(lines, k))
        part = next(
            line for line in reversed(lines[:k]) if re.search(";(Operation|Initial Move|Next|End of Path)", line)
        )
        left_on = block in ("CYCLE800()", "TRANS") and ";Operation" in part  # only after an aborted run
        assert turns_itself or homed or holds_anyway or left_on, (k, block)


def _again(lines: list[str], k: int) -> bool:
    """Whether the same block is repeated nearby, at the start of the next operation or after a tool change."""
    block = lines[k].split(" ", 1)[1]
    return any(line.endswith(block) for line in lines[max(k - 30, 0) : k] + lines[k + 1 : k + 30])


@pytest.mark.parametrize(
    ("way", "first", "second"),
    [
        ("cycle800", "CYCLE800()", "SUPA G0 X=_X_HOME"),
        ("frames", "TRAFOOF", "SUPA G0 Z=_Z_HOME"),
        ("frames", "G0 B30", "TRAORI"),
        ("frames", "TRANS X", "AROT Z"),
    ],
)
def test_blocks_of_the_safe_order_that_change_places_are_seen(
    way: str, first: str, second: str, tmp_path: Path
) -> None:
    cl, nc = two_planes(tmp_path, way)
    lines = nc.read_text(encoding="utf-8").splitlines()
    blocks = [line.split(" ", 1)[1] for line in lines]
    operation = blocks.index(";Operation : OP2")
    end = blocks.index(";End of Path" if first in ("CYCLE800()", "TRAFOOF") else ";Initial Move", operation)
    one = next(k for k in range(end, len(blocks)) if blocks[k].startswith(first))
    two = next(k for k in range(one, len(blocks)) if blocks[k].startswith(second))
    blocks[one], blocks[two] = blocks[two], blocks[one]
    assert proven(blocks, cl, tmp_path), (way, first, second)


def test_a_lone_operation_in_a_tilted_coordinate_system_is_tilted_against_the_absolute_one(tmp_path: Path) -> None:
    cl, nc = tmp_path / "one.cls", tmp_path / "one.mpf"
    cl.write_text(tilted("OP1", 1, 30.0, 20.0), encoding="utf-8")
    command = ["post", str(cl), "--machine", "yl569", "--output", str(nc)]
    assert main(command) == 0
    assert "CYCLE800" not in nc.read_text(encoding="utf-8"), "the first operation's coordinate system is the program's"
    assert main([*command, "--set", "frame=absolute"]) == 0
    text = nc.read_text(encoding="utf-8")
    assert "G0 B30. C20." in text
    assert 'CYCLE800(0,"",0,57,12.5,-7.,3.,' in text
    check = ["verify", str(nc), "--machine", "yl569", "--cl", str(cl)]
    assert main([*check, "--frame", "absolute"]) == 0
    assert main(check) == 1
