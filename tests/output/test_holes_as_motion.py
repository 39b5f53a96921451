"""Holes as motion, where a control has no cycle or none is wanted: what is written, proven, and judged by LinuxCNC."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.examples import THIRDS
from tests.support.holes import HEIGHTS
from tests.support.linuxcnc.interpreter import interpret, needs_linuxcnc
from tests.support.linuxcnc.posting import FOOT, Post
from tests.support.linuxcnc.posting import post as post
from tests.support.matrix.pairs import CONTROLS, check_proven, pair_of, posted, simplest
from tests.support.matrix.paths import CYCLES, UPRIGHT, operation, square, words
from tests.support.posting import CLEAR
from trunnion.arrays import Floats
from trunnion.cl import read_cl
from trunnion.cli import main
from trunnion.machines import Machine, load_machine
from trunnion.model.toolpath import Kind
from trunnion.planning import operation_seconds
from trunnion.planning.options import PlanOptions
from trunnion.planning.planner import plan
from trunnion.readers import run_program
from trunnion.verification import ExpectedValues, Verification, failures, verify

MACHINE = load_machine("xyzac_trt")

#: What motion can make.
MADE = [mode for mode in CYCLES if not mode.startswith("TAP") and mode not in ("BORE,NODRAG", "BORE,MANUAL")]

#: Axes that the trunnion reaches, the part's own among them.
AXES = [UPRIGHT, np.array([0.6, 0.0, 0.8]), np.array([0.0, -0.28, 0.96]), np.array([-0.48, 0.6, 0.64])]


def drilled(modes: Sequence[str], axes: Sequence[Floats], back: bool = True) -> str:
    """Two holes with each cycle, each under another axis; with ``back`` the CL file draws the tool back after them."""
    text = ""
    for k, mode in enumerate(modes):
        axis = axes[k % len(axes)]
        place, (x, _) = np.array([10.0 * k, 4.0, -3.0 * k]), square(axis)
        text += f"RAPID\nGOTO/{words(place + 60.0 * axis, axis)}\nCYCLE/{CYCLES[mode]}\nGOTO/{words(place)}\n"
        text += f"GOTO/{words(place + 15.0 * x)}\nCYCLE/OFF\n"
        text += f"RAPID\nGOTO/{words(place + 15.0 * x + 60.0 * axis)}\n" if back else ""
    return operation("HOLES", text)


def made(text: str, folder: Path, *settings: str, machine: str = "xyzac_trt") -> tuple[Path, Path]:
    """A CL file and its proven program."""
    cl, program = folder / "holes.cls", folder / "holes.ngc"
    cl.write_text(text, encoding="utf-8")
    said = [word for setting in settings for word in ("--set", setting)]
    assert main(["post", str(cl), "--machine", machine, "--output", str(program), *said]) == 0
    return cl, program


def proof(lines: Sequence[str], cl: Path, folder: Path, machine: Machine = MACHINE) -> Verification:
    """What is found in a program that somebody changed."""
    program = folder / "changed.ngc"
    program.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return verify(run_program(program, machine), [read_cl(cl)], settings=ExpectedValues(work_offset=54), columns=False)


def failed(lines: Sequence[str], cl: Path, folder: Path) -> list[str]:
    return [check.key for check in failures(proof(lines, cl, folder))]


@pytest.mark.third
@pytest.mark.parametrize("control", CONTROLS)
def test_every_control_makes_holes_as_motion_if_that_is_wished(control: str, tmp_path: Path) -> None:
    pair = pair_of(control, "generic_head_table_bc", tmp_path)
    for mode in MADE:
        done = posted(simplest(mode), pair, tmp_path, ("cycles=off",))
        check_proven(done, pair, ())
        assert "2 holes, 2 of them by motion" in done.err


@pytest.mark.third
@pytest.mark.parametrize("control", ["fidia_nc15", "heidenhain_tnc640", "sinumerik_840d"])
@pytest.mark.parametrize("settings", [("cycles=off",), ("mode=tcp",)])
@pytest.mark.parametrize("back", [True, False])
def test_in_planes_and_with_tcp_they_are_proven_too(
    control: str, settings: tuple[str, ...], back: bool, tmp_path: Path
) -> None:
    """Where the tool axis changes the tool goes home first, however far the CL file has drawn it back."""
    pair = pair_of(control, "dmu65", tmp_path)
    modes = ["DRILL,BRKCHP", "DRILL", "BORE,DRAG", "DRILL,DEEP, decreasing pecks"]
    modes = modes if control != "fidia_nc15" or settings == ("cycles=off",) else modes[1:]
    done = posted(drilled(modes, AXES, back=back), pair, tmp_path, settings)
    check_proven(done, pair, ())
    assert f"{2 * len(modes)} of them by motion" in done.err


def test_threads_along_a_tilted_axis_are_refused_with_a_cure(post: Post) -> None:
    text = drilled(["DRILL"], AXES[1:]).replace(CYCLES["DRILL"], CYCLES["TAP"])
    code, out, err = post.all(text)
    assert (code, out) == (2, [])
    assert "CYCLE/TAP along a tilted tool axis needs a tilted plane, which this control lacks; clamp the part" in err


def test_what_is_made_as_motion_is_said_once_for_each_kind(post: Post) -> None:
    text = CLEAR + f"CYCLE/DRILL,DEEP,{HEIGHTS}STEP,6.0,1.0,2.0,MMPM,250\nGOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\n" + FOOT
    code, _, err = post.all(text, "--explain")
    assert code == 0
    why = "decreasing peck depths, and Q of G83 is constant"
    assert f"part.cls:10: warning: {why}; CYCLE/DRILL,DEEP expanded to rapids and lines for 2 holes" in err
    assert f"part.cls:10: OP1: CYCLE/DRILL,DEEP expanded to rapids and lines for 2 holes: {why}" in err
    code, _, err = post.all(
        CLEAR + f"CYCLE/DRILL,{HEIGHTS}MMPM,250\nGOTO/10,0,0\n" + FOOT, "--set", "cycles=off", "--explain"
    )
    assert code == 0
    warnings = [line for line in err.splitlines() if "warning: " in line]
    assert [line for line in warnings if not line.endswith("[CTL720]")] == []  # of the home of the machine
    assert "CYCLE/DRILL expanded to rapids and lines for 1 hole: as requested" in err


def test_cycles_that_can_be_said_stay_beside_those_that_cannot(post: Post) -> None:
    shorter = f"CYCLE/DRILL,DEEP,{HEIGHTS}STEP,15.0,7.0,8.0,MMPM,250\nGOTO/10,0,0\nCYCLE/OFF\n"
    text = CLEAR + f"CYCLE/DRILL,{HEIGHTS}MMPM,250\nGOTO/0,0,0\nCYCLE/OFF\n" + shorter
    code, lines, _ = post.all(text + f"CYCLE/DRILL,{HEIGHTS}RTRCTO,9.0,MMPM,250\nGOTO/0,9,0\nCYCLE/OFF\n" + FOOT)
    assert code == 0
    first = next(k for k, line in enumerate(lines) if "G81" in line)
    assert lines[first : first + 11] == [
        "G99 G81 X0. Y0. Z-20. R3. F250.", "G80",
        "G0 X10. Y0. Z3.", "G1 Z-15.", "G0 Z3.", "Z-14.5", "G1 Z-20.", "G0 Z3.",
        "Z9.", "G98 G81 X0. Y9. Z-20. R3.", "G80",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("control", "words"),
    [
        ("fanuc_31i", "DRILL,DEEP,{h}STEP,3,DWELL,1,MMPM,90"),
        ("fanuc_31i", "DRILL,BRKCHP,{h}STEP,3,DWELL,REV,20,MMPM,90"),
        ("fanuc_31i", "BORE,DRAG,{h}DWELL,1,MMPM,90"),
        ("linuxcnc", "DRILL,BRKCHP,{h}STEP,3,DWELL,1,MMPM,90"),
        ("fidia_nc15", "DRILL,BRKCHP,{h}STEP,3,1,1,DWELL,REV,20,MMPM,90"),
    ],
)
def test_what_the_words_of_a_cycle_lack_is_made_as_motion(control: str, words: str, tmp_path: Path) -> None:
    pair = pair_of(control, "generic_head_table_bc", tmp_path)
    text = simplest("DRILL").replace(CYCLES["DRILL"], words.format(h=HEIGHTS))
    done = posted(text, pair, tmp_path, ())
    check_proven(done, pair, ())
    assert f"CYCLE/{words.partition(',{h}')[0]} expanded to rapids and lines for 2 holes" in done.err


def test_pecks_and_dwells_count_in_the_time_of_an_operation(tmp_path: Path) -> None:
    cl = tmp_path / "holes.cls"
    cl.write_text(drilled(["DRILL with DWELL", "DRILL,DEEP"], [UPRIGHT]), encoding="utf-8")
    motion, _ = (
        plan([read_cl(cl)], MACHINE, 0.001, PlanOptions(holes_as_motion=wish)).motions[0] for wish in (True, False)
    )
    assert motion.operation.moves.kind.tolist().count(Kind.LINEAR) == 2 + 10
    drilled_mm = 2 * 15.0 + 2 * (15.0 + 4 * 0.5)
    assert operation_seconds(MACHINE, motion) > 60.0 * drilled_mm / 90.0 + 2 * 0.5


@pytest.mark.parametrize("third", THIRDS)
def test_every_block_that_is_dropped_is_missed(third: int, tmp_path: Path) -> None:
    modes = ["DRILL", "DRILL,DEEP, decreasing pecks", "DRILL with DWELL", "BORE,DRAG", "DRILL,BRKCHP", "BORE"]
    cl, program = made(drilled(modes, AXES[1:]), tmp_path)
    lines = program.read_text(encoding="utf-8").splitlines()
    assert failed(lines, cl, tmp_path) == []
    run = run_program(program, MACHINE)
    first = next(k for k, line in enumerate(lines) if line.endswith("G43 H1")) + 1
    moved = {int(run.lines[row]) - 1: row for row in range(len(run))}
    for k in range(first + third, len(lines) - 6, 3):
        block = lines[k].split(" ", 1)[-1]
        if block.startswith(";") or failed(lines[:k] + lines[k + 1 :], cl, tmp_path):
            continue
        # Not seen with TCP: the length; and the way home, for the CL file itself goes on at rapid from where it is.
        if block.startswith(("G49", "G53", "G43")):
            continue
        # A rapid that leads down to a hole, or over it: the next motion goes there as well.
        row = moved[k]
        assert run.kind[row] == Kind.RAPID
        assert float((run.tip[row] - run.tip[row - 1]) @ run.axis[row]) < 1e-4, block


@pytest.mark.parametrize("third", THIRDS)
def test_every_number_that_is_another_one_is_seen(third: int, tmp_path: Path) -> None:
    modes = ["DRILL,DEEP, decreasing pecks", "BORE with DWELL", "DRILL,BRKCHP"]
    cl, program = made(drilled(modes, AXES[1:]), tmp_path)
    lines = program.read_text(encoding="utf-8").splitlines()
    count, quiet = 0, []
    for k, line in enumerate(lines):
        block = line.split(" ", 1)[-1]
        for found in re.finditer(r"(?<=[XYZF])-?[\d.]+|(?<=G4 P)[\d.]+", block):
            if "G53" in block or block.startswith(("G64", ";")):
                continue
            other = f"{float(found.group()) + 0.3:g}" if "G4" in block else f"{float(found.group()) + 1.0:.5f}"
            changed = block[: found.start()] + other + block[found.end() :]
            count += 1
            if count % 3 == third and not failed([*lines[:k], changed, *lines[k + 1 :]], cl, tmp_path):
                quiet.append(block)
    assert count > 100
    assert quiet == []


def test_pecks_that_others_would_draw_are_seen(tmp_path: Path) -> None:
    """A peck left out, one more, another order, a full retract where chips are broken, a rapid in place of a line."""
    cl, program = made(drilled(["DRILL,DEEP, decreasing pecks"], [UPRIGHT]), tmp_path, "cycles=off")
    lines = program.read_text(encoding="utf-8").splitlines()
    assert failed(lines, cl, tmp_path) == []
    pecks = [k for k, line in enumerate(lines) if " G1 Z-" in line]
    assert len(pecks) == 10
    one, two = pecks[1:3]
    assert "holes" in failed(lines[:one] + lines[two:], cl, tmp_path)
    again = [*lines[:two], lines[one - 2], lines[one - 1], lines[one], *lines[two - 2 :]]
    assert "holes" in failed(again, cl, tmp_path)
    assert "holes" in failed([*lines[:one], lines[one].replace("G1", "G0"), *lines[one + 1 :]], cl, tmp_path)
    deeper = [*lines[:one], lines[one].replace("-7.", "-6."), *lines[one + 1 :]]
    assert "holes" in failed(deeper, cl, tmp_path)


def test_the_spindle_stands_where_a_boring_tool_is_drawn_out(tmp_path: Path) -> None:
    cl, program = made(drilled(["BORE,DRAG"], [UPRIGHT]), tmp_path, "cycles=off")
    lines = program.read_text(encoding="utf-8").splitlines()
    blocks = [line.split(" ", 1)[-1] for line in lines]
    stops = [k for k, block in enumerate(blocks) if block == "M5"]
    assert len(stops) == 3  # the last one at the end of the operation
    for k in stops[:2]:
        assert blocks[k - 1].startswith("G1 Z")
        assert failed(lines[:k] + lines[k + 1 :], cl, tmp_path) == ["holes"]
    start = next(k for k, block in enumerate(blocks) if k > stops[0] and "M3" in block)
    assert "holes" in failed(
        [line.replace(" M3", "") if k == start else line for k, line in enumerate(lines)], cl, tmp_path
    )


def test_the_cl_files_own_plunges_are_no_holes(tmp_path: Path) -> None:
    """It cuts down at the place of the hole first; and ends, and goes on, right where the hole begins and ends."""
    body = "RAPID\nGOTO/5,5,30,0,0,1\nFEDRAT/MMPM,200\nGOTO/5,5,-4\nGOTO/5,5,-9\nGOTO/5,5,3\n"
    body += "CYCLE/DRILL,RAPTO,3,FEDTO,-12,MMPM,90\nGOTO/5,5,0\nCYCLE/OFF\n"
    body += "RAPID\nGOTO/5,5,3\nGOTO/5,5,-4\nRAPID\nGOTO/5,5,30\n"
    cl, program = made(operation("HOLES", body), tmp_path, "cycles=off")
    lines = program.read_text(encoding="utf-8").splitlines()
    assert failed(lines, cl, tmp_path) == []
    for k, line in enumerate(lines):
        if " Z" in line and "G53" not in line:
            assert failed(lines[:k] + lines[k + 1 :], cl, tmp_path), line


@pytest.mark.third
@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750", "xyzac_trt", "dmu65", "yl569", "hs664rt"])
@pytest.mark.parametrize("tool", [1, 4])
def test_the_next_operation_may_begin_where_the_last_hole_ends(tool: int, machine: str, tmp_path: Path) -> None:
    """The way to its first point is another motion than the way out of the hole, and is missed."""
    drill = operation("DRILL", f"RAPID\nGOTO/25,50,25,0,0,1\nCYCLE/{CYCLES['DRILL,BRKCHP']}\nGOTO/25,50,0\nCYCLE/OFF\n")
    drill = drill.replace("FEDTO", "RTRCTO,25,FEDTO")
    mill = operation("HELIX", "RAPID\nGOTO/25,50,25,0,0,1\nRAPID\nGOTO/25,50,2.5\nFEDRAT/MMPM,120\nGOTO/29,50,-8\n")
    mill = mill.replace("LOAD/TOOL,1,ADJUST,1", f"LOAD/TOOL,{tool},ADJUST,{tool}")
    cl, program = made(drill + mill, tmp_path, "cycles=off", machine=machine)
    if machine != "xyzac_trt":
        return
    lines = program.read_text(encoding="utf-8").splitlines()
    assert failed(lines, cl, tmp_path) == []
    for k, line in enumerate(lines):
        if re.search(" X25| Z25", line):
            assert failed(lines[:k] + lines[k + 1 :], cl, tmp_path), line


def test_holes_at_one_place_are_told_apart(tmp_path: Path) -> None:
    """Centred, drilled and reamed, one behind the other and each in its own turn."""
    spot, drill = "CYCLE/DRILL,RAPTO,3,FEDTO,-2,MMPM,90", f"CYCLE/{CYCLES['DRILL,BRKCHP']}"
    ream = "CYCLE/REAM,RAPTO,3,FEDTO,-10,RTRCTO,8,MMPM,60"
    body = "RAPID\nGOTO/5,5,30,0,0,1\n" + "".join(f"{mode}\nGOTO/5,5,0\nCYCLE/OFF\n" for mode in (spot, drill, ream))
    body += "".join(f"{mode}\nGOTO/5,5,0\nGOTO/15,5,0\nCYCLE/OFF\n" for mode in (spot, drill, ream))
    cl, program = made(operation("HOLES", body + "RAPID\nGOTO/5,5,30\n"), tmp_path, "cycles=off")
    lines = program.read_text(encoding="utf-8").splitlines()
    assert failed(lines, cl, tmp_path) == []
    for k, line in enumerate(lines):
        if "G1 Z" in line:
            assert "holes" in failed(lines[:k] + lines[k + 1 :], cl, tmp_path), line


@pytest.mark.parametrize(
    ("asked", "said"), [(("pole=lean", "pole_angle=2"), "leans by up to"), (("lower_feed=yes",), "lowered at 11 rows")]
)
def test_what_is_agreed_near_the_pole_leaves_holes_alone(
    asked: tuple[str, ...], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is agreed upon is counted without the holes."""
    body = "RAPID\nGOTO/0,0,40,0,0,1\nCYCLE/DRILL,RAPTO,3,FEDTO,-12,MMPM,90\nGOTO/5,5,0\nGOTO/9,5,0\nCYCLE/OFF\n"
    body += "RAPID\nGOTO/0,-30,40\nFEDRAT/MMPM,3000\nGOTO/0,-30,0\n"
    for k in range(-20, 21):
        axis = np.array([0.0007, 0.002 * k, 1.0])
        body += f"GOTO/{words(np.array([0.0, 1.5 * k, 0.0]), axis / np.linalg.norm(axis))}\n"
    made(operation("MIXED", body + "RAPID\nGOTO/0,30,40\n"), tmp_path, *asked)
    err = capsys.readouterr().err
    assert said in err
    assert "2 holes, 2 of them by motion" in err


@needs_linuxcnc
@pytest.mark.parametrize("back", [True, False])
def test_linuxcnc_makes_the_motions_that_we_read(back: bool, tmp_path: Path) -> None:
    """All kinds of holes along four axes, with TCP."""
    _, program = made(drilled(MADE, AXES, back=back), tmp_path)
    machine = replace(MACHINE, workpiece_zero=(0.0, 0.0, 0.0))
    run, text = run_program(program, machine), program.read_text(encoding="utf-8")
    canon = interpret(text, tmp_path, "XYZAC")
    work = [move for move in canon.moves if move.tcp and move.offset]
    rows = np.flatnonzero(run.state.tcp.at(np.arange(len(run))))
    tips, kinds = run.tip[rows], run.kind[rows]
    places = [move for k, move in enumerate(work) if k == 0 or move.end != work[k - 1].end]
    assert len(places) == len(rows)
    for move, tip, kind in zip(places, tips, kinds, strict=True):
        assert np.abs(np.array(move.end[:3]) - tip).max() < 2e-4
        assert move.kind == ("rapid" if kind == Kind.RAPID else "line")
    dwells = sum(mode.endswith("DWELL") for mode in MADE)
    assert sum(name == "DWELL" for _, name, _ in canon.notes) == 2 * dwells
    drags = [move for move in work if move.sense == 0]
    assert len(drags) == 2


@pytest.mark.parametrize("machine", ["yl569", "xyzac_trt", "ucp800"])
def test_the_first_motion_may_be_a_hole(tmp_path: Path, machine: str) -> None:
    """The tool comes from home, which nothing in the program places above or below the part."""
    cycle = "CYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,250\nGOTO/66,0,240,0,0,1\nGOTO/-25,0,240\nCYCLE/OFF\n"
    made(operation("HOLES", cycle), tmp_path, "cycles=off", machine=machine)
