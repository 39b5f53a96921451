"""Hole-making cycles: what is written, that it is proven on every machine, and that faults in it are seen."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import THIRDS, examples
from tests.support.holes import HEIGHTS, statements
from tests.support.naive.chains import turned
from tests.support.planes import proven, reachable, sinumeriks
from tests.support.posting import CLEAR, FOOT, HEAD, Post
from tests.support.posting import post as post
from trunnion.cl import read_cl
from trunnion.cli import main
from trunnion.errors import Severity
from trunnion.machines import load_machine
from trunnion.model.toolpath import CycleOn, Kind
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, cycle_from_event
from trunnion.readers import run_program


def cycles(lines: list[str]) -> list[str]:
    """The blocks from the first MCALL, with those that lead to it, to the last."""
    at = [k for k, line in enumerate(lines) if line.startswith("MCALL")]
    return [line for line in lines[at[0] : at[-1] + 1] if not line.startswith(";")]


@pytest.mark.third
@pytest.mark.parametrize(
    ("words", "call"),
    [
        ("DRILL,RAPTO,3.0,FEDTO,-20.0,RTRCTO,5.0,MMPM,250", "CYCLE81(5.,0.0,3.,-20.)"),
        ("DRILL,RAPTO,3.0,FEDTO,-20.0,MMPM,250", "CYCLE81(3.,0.0,3.,-20.)"),
        ("DRILL,RAPTO,3.0,FEDTO,-20.0,RTRCTO,AUTO,MMPM,250", "CYCLE81(50.,0.0,3.,-20.)"),
        ("DRILL,RAPTO,3.0,FEDTO,-20.0,RTRCTO,1.0,MMPM,250", "CYCLE81(3.,0.0,3.,-20.)"),
        ("DRILL,RAPTO,3.0,FEDTO,-20.0,DWELL,0.5,MMPM,250", "CYCLE82(3.,0.0,3.,-20.,,0.5)"),
        ("DRILL,RAPTO,3.0,FEDTO,-20.0,DWELL,REV,20,MMPM,250", "CYCLE82(3.,0.0,3.,-20.,,0.3)"),
        ("DRILL,CSINK,RAPTO,3.0,CSKDIA,10.0,TLANGL,90.0,MMPM,250", "CYCLE81(3.,0.0,3.,-5.)"),
        ("DRILL,DEEP,RAPTO,3.0,FEDTO,-20.0,STEP,6.0,MMPM,250", "CYCLE83(3.,0.0,3.,-20.,,,6.,0.0,0,0,1,1,3,0.0,0,0,0)"),
        (
            "DRILL,BRKCHP,RAPTO,3.0,FEDTO,-20.0,STEP,6.0,1.0,2.0,DWELL,1,MMPM,250",
            "CYCLE83(3.,0.0,3.,-20.,,,6.,1.,0,0,1,0,3,2.,1.,1.,0)",
        ),
        ("TAP,RAPTO,3.0,FEDTO,-20.0,MMPR,1.25", "CYCLE84(3.,0.0,3.,-20.,,,3,,1.25,0,4000,4000)"),
        ("TAP,RAPTO,3.0,FEDTO,-20.0,MMPM,5000", "CYCLE84(3.,0.0,3.,-20.,,,3,,1.25,0,4000,4000)"),
        (
            "TAP,BRKCHP,RAPTO,3.0,FEDTO,-20.0,STEP,6.0,MMPR,1.25",
            "CYCLE84(3.,0.0,3.,-20.,,,3,,1.25,0,4000,4000,3,1,0,1,6.,1.)",
        ),
        (
            "TAP,DEEP,RAPTO,3.0,FEDTO,-20.0,STEP,60,MMPR,1.25",
            "CYCLE84(3.,0.0,3.,-20.,,,3,,1.25,0,4000,4000,3,1,0,2,20.,0)",
        ),
        ("TAP,RAPTO,3.0,FEDTO,-20.0,MMPR,1.25,OPTION", "CYCLE840(3.,0.0,3.,-20.,,,0,3,0,,1.25)"),
        ("BORE,RAPTO,3.0,FEDTO,-20.0,MMPM,100", "CYCLE85(3.,0.0,3.,-20.,,,100.,100.)"),
        ("REAM,RAPTO,3.0,FEDTO,-20.0,MMPM,100,DWELL,1", "CYCLE85(3.,0.0,3.,-20.,,1.,100.,100.)"),
        ("BORE,DRAG,RAPTO,3.0,FEDTO,-20.0,MMPM,100", "CYCLE86(3.,0.0,3.,-20.,,,3,0.0,0,0,0.0)"),
        ("BORE,MANUAL,RAPTO,3.0,FEDTO,-20.0,MMPM,100", "CYCLE88(3.,0.0,3.,-20.,,0,3)"),
    ],
)
def test_each_cycle_is_said_with_its_heights(words: str, call: str, post: Post) -> None:
    text = CLEAR + f"CYCLE/{words}\nGOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\nRAPID\nGOTO/20,0,50\n" + FOOT
    lines = post(text)
    assert cycles(lines) == [f"MCALL {call}", "X10. Y0.0", "X20. Y0.0", "MCALL"]


def test_a_left_hand_tap_has_a_negative_pitch(post: Post) -> None:
    text = CLEAR.replace("CLW", "CCLW") + f"CYCLE/TAP,{HEIGHTS}MMPR,1.25\nGOTO/10,0,0\n" + FOOT
    assert cycles(post(text))[0] == "MCALL CYCLE84(3.,0.0,3.,-20.,,,4,,-1.25,0,4000,4000)"


def test_nodrag_lifts_off_only_as_somebody_says(post: Post) -> None:
    text = CLEAR + f"CYCLE/BORE,NODRAG,90,{HEIGHTS}MMPM,100\nGOTO/10,0,0\n" + FOOT
    code, out, err = post.all(text)
    assert (code, out) == (2, [])
    assert "part.cls:10: error: BORE,NODRAG does not say how far and to which side" in err
    assert cycles(post(text, "--set", "bore_lift=-0.5"))[0] == "MCALL CYCLE86(3.,0.0,3.,-20.,,,3,-.5,0,0,90.)"


def test_holes_of_other_heights_have_their_own_call_and_the_tool_goes_up_first(post: Post) -> None:
    text = CLEAR + f"CYCLE/DRILL,{HEIGHTS}MMPM,250\nGOTO/10,0,0\nGOTO/20,0,10\nGOTO/30,0,0\n" + FOOT
    assert cycles(post(text)) == [
        "MCALL CYCLE81(3.,0.0,3.,-20.)",
        "X10. Y0.0",
        "MCALL",
        "Z13.",
        "MCALL CYCLE81(13.,10.,3.,-10.)",
        "X20. Y0.0",
        "MCALL",
        "MCALL CYCLE81(3.,0.0,3.,-20.)",
        "X30. Y0.0",
        "MCALL",
    ]


def test_a_rapid_within_a_cycle_is_no_hole(post: Post) -> None:
    text = CLEAR + f"CYCLE/DRILL,{HEIGHTS}MMPM,250\nGOTO/10,0,0\nRAPID\nGOTO/10,0,80\nGOTO/20,0,0\n" + FOOT
    part = cycles(post(text))
    assert part == [
        "MCALL CYCLE81(3.,0.0,3.,-20.)", "X10. Y0.0", "MCALL", "X10. Y0.0 Z80.",
        "MCALL CYCLE81(3.,0.0,3.,-20.)", "X20. Y0.0", "MCALL",
    ]  # fmt: skip


def test_the_feed_of_a_cycle_is_its_own_and_the_modal_one_comes_back(post: Post) -> None:
    text = HEAD + f"CYCLE/DRILL,{HEIGHTS}MMPR,0.2\nRAPID\nGOTO/10,0,50\nGOTO/10,0,0\nCYCLE/OFF\nRAPID\nGOTO/10,0,50\n"
    lines = post(text + "GOTO/10,0,20\n" + FOOT)
    assert "G95 F.2" in lines
    assert "G94 G1 Z20. F500." in lines


def test_a_cycle_with_the_modal_feed_is_called_again_where_that_changes(post: Post) -> None:
    text = (
        HEAD + f"CYCLE/DRILL,{HEIGHTS.rstrip(',')}\nGOTO/10,0,0\nFEDRAT/MMPM,300\nGOTO/20,0,0\nGOTO/30,0,0\nCYCLE/OFF\n"
    )
    part = [line.partition(" ")[2] if line.startswith("N") else line for line in post(text + FOOT)]
    at = part.index("F300.")
    assert [line.split("(")[0] for line in part[at + 1 : at + 5]] == [
        "MCALL CYCLE81",
        "X20. Y0.0",
        "X30. Y0.0",
        "MCALL",
    ]


@pytest.mark.parametrize(
    "lines",
    [f"CYCLE/DRILL,{HEIGHTS}MMPM,100\nGOTO/10,0,0\nCUTCOM/LEFT\n", f"CUTCOM/LEFT\nCYCLE/DRILL,{HEIGHTS}MMPM,100\n"],
)
def test_compensation_in_holes_is_refused_with_its_line(lines: str, post: Post) -> None:
    with pytest.raises(AssertionError, match="CUTCOM/LEFT where the cycle of line"):
        post(HEAD + lines + "GOTO/20,0,0\nCUTCOM/OFF\nCYCLE/OFF\n" + FOOT)


@pytest.mark.third
@pytest.mark.parametrize(
    ("words", "what"),
    [
        ("DRILL,FEDTO,-20,MMPM,100", "without RAPTO"),
        ("DRILL,RAPTO,3,MMPM,100", "without a depth"),
        ("DRILL,DEEP,RAPTO,3,FEDTO,-20,MMPM,100", "without STEP"),
        ("DRILL,RAPTO,3,FEDTO,-20,RTRCTO,MANUAL,MMPM,100", "does not say how far"),
        ("DRILL,RAPTO,3,FEDTO,-20", "without a feed"),
        ("DRILL,CSINK,RAPTO,3,CSKDIA,10,MMPM,100", "without the angle"),
        ("DRILL,RAPTO,3,FEDTO,-1e12,MMPM,100", "no machine has"),
        ("BORE,BACK,RAPTO,3,FEDTO,-20,MMPM,100", "does not say how far the tool must move off its axis"),
        ("TAP,BRKCHP,RAPTO,3,FEDTO,-20,MMPR,1.25", "without STEP"),
        ("TAP,BRKCHP,RAPTO,3,FEDTO,-20,STEP,5,MMPR,1.25,OPTION", "a compensating chuck"),
        ("TAP,DEEP,RAPTO,3,FEDTO,-20,STEP,5,1,2,MMPR,1.25", "decreasing peck depths"),
        ("DRILL,THRU,RAPTO,3,FEDTO,-20,MMPM,100", "cannot be written"),
    ],
)
def test_what_a_cycle_leaves_out_is_refused_with_its_line(words: str, what: str, post: Post) -> None:
    code, out, err = post.all(CLEAR + f"CYCLE/{words}\nGOTO/10,0,0\n" + FOOT)
    assert (code, out) == (2, [])
    assert re.search(f"part.cls:10: error: .*{what}", err)


def test_auto_needs_a_point_before_the_cycle(post: Post) -> None:
    text = CLEAR.replace("RAPID\nGOTO/0.0,0.0,50.0,0.0,0.0,1.0\n", "")
    code, out, err = post.all(text + f"CYCLE/DRILL,{HEIGHTS}RTRCTO,AUTO,MMPM,100\nGOTO/10,0,0\n" + FOOT)
    assert (code, out) == (1, [])
    assert "part.cls:8: error: RTRCTO,AUTO before any point" in err


def test_a_tap_with_the_spindle_standing_is_refused() -> None:
    with pytest.raises(HoleCycleError):
        cycle_from_event(CycleOn(0, 1, ("TAP",), (("RAPTO", (3.0,)),)))


def test_holes_of_an_operation_whose_axis_changes_in_a_cut_are_motion_with_tcp(post: Post) -> None:
    text = HEAD + f"GOTO/20,0,30,0.6,0,0.8\nCYCLE/DRILL,{HEIGHTS}MMPM,100\nGOTO/10,0,0\n" + FOOT
    code, lines, err = post.all(text)
    assert code == 0
    why = "no cycle along a tilted tool axis with TCP"
    assert f"part.cls:13: warning: {why}; CYCLE/DRILL expanded to rapids and lines for 1 hole" in err
    assert "1 hole, 1 of them by motion" in err
    assert "G1 X-2. Z-16. F100." in lines


def test_each_tool_axis_of_a_hole_pattern_has_its_plane(post: Post) -> None:
    holes = ["30,0,0,0.6,0,0.8", "30,10,0", "-30,0,0,-0.6,0,0.8", "0,30,0,0,0.6,0.8"]
    text = CLEAR + f"CYCLE/DRILL,{HEIGHTS}MMPM,250\n" + "".join(f"GOTO/{hole}\n" for hole in holes) + FOOT
    lines = post(text)
    assert sum(line.startswith("CYCLE800(0") for line in lines) == 4  # with that of the first point
    at = lines.index(";Next Plane")
    assert lines[at : at + 3] == [";Next Plane", "SUPA G0 Z=_Z_HOME D0", "CYCLE800()"]
    assert edges_at(lines, "CYCLE800(0") == {"1"}
    frames = post(text, "--set", "plane=frames")
    at = frames.index(";Next Plane")
    assert frames[at : at + 4] == [";Next Plane", "TRANS", "TRAFOOF", "SUPA G0 Z=_Z_HOME D0"]
    assert edges_at(frames, "TRAORI") == {"1"}


def edges_at(lines: list[str], statement: str) -> set[str]:
    """The cutting edges that are active at the lines that start with a statement."""
    found, edge = set[str](), ""
    for line in lines:
        if line.startswith(statement):
            found.add(edge)
        edges = re.findall(r"\bD(\d+)", line)
        edge = edges[-1] if edges and not line.startswith(";") else edge
    return found


SHARES = st.tuples(st.floats(0.02, 0.98), st.floats(0.02, 0.98))
POINTS = st.lists(st.tuples(*[st.floats(-40.0, 40.0)] * 3), min_size=1, max_size=4)


@pytest.mark.parametrize("name", sinumeriks())
@settings(max_examples=examples(6), derandomize=True)
@given(
    words=st.lists(statements(), min_size=1, max_size=3),
    shares=st.lists(SHARES, min_size=1, max_size=3),
    points=POINTS,
    way=st.sampled_from(["cycle800", "frames"]),
)
def test_holes_in_any_planes_are_proven_on_every_machine(
    tmp_path_factory: pytest.TempPathFactory,
    name: str,
    words: list[str],
    shares: list[tuple[float, float]],
    points: list[tuple[float, float, float]],
    way: str,
) -> None:
    machine = load_machine(name)
    axes = [reachable(machine, share) for share in shares]
    lines = [HEAD + FOOT, CLEAR]
    for n, word in enumerate(words):
        axis = axes[n % len(axes)]
        above = np.array(points[0]) + 60.0 * axis
        lines.append(f"RAPID\nGOTO/{','.join(f'{v:.9f}' for v in (*above, *axis))}\nCYCLE/{word}\n")
        lines += [f"GOTO/{x:.4f},{y:.4f},{z:.4f}\n" for x, y, z in points]
        lines.append("CYCLE/OFF\n")
    folder = tmp_path_factory.getbasetemp()
    file, program = folder / "holes.cls", folder / "holes.mpf"
    program.unlink(missing_ok=True)
    file.write_text("".join(lines) + FOOT, encoding="utf-8")
    code = main(["post", str(file), "--machine", name, "--output", str(program), "--set", f"plane={way}"])
    if code == 1 and not program.exists():
        return  # the planner refused it: no room for the slides
    if code == 2:
        return  # a retract height by AUTO below the hole
    assert code == 0
    run = run_program(program, machine)
    assert not [finding for finding in run.diagnostics if finding.severity is Severity.ERROR]
    holes = sum(len(points) for _ in words)
    assert int(np.count_nonzero((run.programmed == 0) & (run.kind != Kind.ARC))) >= 3 * holes


def drilled(folder: Path) -> tuple[Path, list[str]]:
    """A CL file with cycles of all kinds in a plane off the zero, behind an upright hole, and its proven program."""
    kinds = [
        f"DRILL,{HEIGHTS}RTRCTO,5.0,MMPM,250", f"DRILL,{HEIGHTS}DWELL,0.5,MMPM,250", f"TAP,{HEIGHTS}MMPR,1.25",
        f"TAP,BRKCHP,{HEIGHTS}STEP,6.0,MMPR,1.25", f"TAP,DEEP,{HEIGHTS}STEP,6.0,MMPR,1.25",
        f"DRILL,DEEP,{HEIGHTS}STEP,6.0,MMPM,250", f"DRILL,BRKCHP,{HEIGHTS}STEP,6.0,MMPM,250", f"BORE,{HEIGHTS}MMPM,100",
    ]  # fmt: skip
    body = "".join(f"CYCLE/{kind}\nGOTO/{10 * n},5,0\nGOTO/{10 * n},15,2\n" for n, kind in enumerate(kinds))
    matrix = turned(2, 20.0) @ turned(1, 40.0)
    frame = ",".join(f"{v:.9f}" for v in (12.5, -7.0, 3.0, *matrix[:, 0], *matrix[:, 1]))
    plane = "\n".join(f"MSYS/{frame}" if x.startswith("MSYS") else x for x in CLEAR.splitlines()) + "\n"
    end = "CYCLE/OFF\nRAPID\nGOTO/0,0,50\n" + FOOT
    cl, nc = folder / "holes.cls", folder / "holes.mpf"
    upright = f"CYCLE/{kinds[0]}\nGOTO/10,5,0\n"
    cl.write_text(CLEAR + upright + end + plane.replace("OP1", "OP2") + body + end, encoding="utf-8")
    assert main(["post", str(cl), "--machine", "yl569", "--output", str(nc)]) == 0
    lines = nc.read_text(encoding="utf-8").splitlines()
    assert proven(lines, cl, folder) == []
    return cl, lines


@pytest.mark.parametrize("third", THIRDS)
def test_blocks_of_cycles_that_are_dropped_are_missed(third: int, tmp_path: Path) -> None:
    cl, lines = drilled(tmp_path)
    blocks = [line.split(" ", 1)[1] for line in lines]
    first = next(k for k, block in enumerate(blocks) if block.startswith("CYCLE800(0"))
    last = len(blocks) - next(k for k, block in enumerate(reversed(blocks)) if block.startswith("MCALL"))
    for k in range(first + third, last, 3):
        if not blocks[k].startswith((";", "MCALL", "X")) or blocks[k].startswith(";"):
            continue
        # A bare MCALL before another MCALL ends what the other would end too, if nothing moves between them.
        follows = next(b for b in blocks[k + 1 :] if b.startswith(("MCALL", "X", "Z", "G0")))
        needless = blocks[k] == "MCALL" and follows.startswith("MCALL ")
        assert needless or proven(blocks[:k] + blocks[k + 1 :], cl, tmp_path), (k, blocks[k])


@pytest.mark.parametrize("third", THIRDS)
def test_a_number_in_a_cycle_that_is_another_one_is_seen(third: int, tmp_path: Path) -> None:
    cl, lines = drilled(tmp_path)
    blocks = [line.split(" ", 1)[1] for line in lines]
    unseen = []
    calls = [k for k, block in enumerate(blocks) if block.startswith("MCALL CYCLE")]
    assert len(calls) == 17
    for k in calls[1::2]:  # in the plane, the first of each kind
        block = blocks[k]
        name, arguments = block[len("MCALL ") : -1].split("(")
        values = arguments.split(",")
        for n, value in enumerate(values):
            if value and (n + k) % 3 == third:
                changed = [*values[:n], f"{float(value) + 1.0:g}", *values[n + 1 :]]
                other = f"MCALL {name}({','.join(changed)})"
                if not proven([*blocks[:k], other, *blocks[k + 1 :]], cl, tmp_path):
                    unseen.append((name, n + 1))
    # DTS and FRF over 1, the tool axis, MDEP below the peck, VRT, DIS1; SDAC, spindle position, speed out.
    quiet = {
        "CYCLE83": {8, 10, 11, 13, 14, 15, 17},
        "CYCLE84": {7, 10, 13, 14, 15, 18},
        "CYCLE85": set(),
        "CYCLE82": set(),
    }
    assert {(name, n) for name, n in unseen} <= {(name, n) for name, places in quiet.items() for n in places}


def test_a_cycle_holds_what_the_statement_says() -> None:
    values = (("RAPTO", (3.0,)), ("FEDTO", (-20.0,)), ("STEP", (6.0, 1.0, 2.0)), ("MMPM", (250.0,)), ("DWELL", (0.5,)))
    found = cycle_from_event(CycleOn(0, 1, ("DRILL", "DEEP"), values, (("RTRCTO", "AUTO"),)))
    wanted = Cycle(HoleMethod.DEEP_DRILLING, 3.0, 20.0, None, (6.0, 1.0, 2.0), 0.5, False, 250.0, False, 0.0)
    assert found == wanted


def test_holes_survive_reading(tmp_path: Path) -> None:
    file = tmp_path / "a.cls"
    file.write_text(CLEAR + f"CYCLE/DRILL,{HEIGHTS}MMPM,250\nGOTO/10,0,0\n" + FOOT, encoding="utf-8")
    operation = read_cl(file).operations[0]
    assert len(operation.moves) == 2


def test_another_tool_is_seen_in_an_operation_of_nothing_but_holes(tmp_path: Path) -> None:
    cl, nc = tmp_path / "only.cls", tmp_path / "only.mpf"
    text = CLEAR.replace("RAPID\nGOTO/0.0,0.0,50.0,0.0,0.0,1.0\n", "")
    cl.write_text(text + f"CYCLE/DRILL,{HEIGHTS}MMPM,100\nGOTO/10,0,0\nGOTO/20,0,0\n" + FOOT, encoding="utf-8")
    assert main(["post", str(cl), "--machine", "yl569", "--output", str(nc)]) == 0
    lines = nc.read_text(encoding="utf-8").splitlines()
    assert proven(lines, cl, tmp_path) == []
    assert proven([line.replace("T=1", "T=2") for line in lines], cl, tmp_path) == ["tool", "holes"]
    assert "holes" in proven([line for line in lines if "S4000" not in line], cl, tmp_path)
