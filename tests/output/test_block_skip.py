"""Blocks that may be skipped: whether they are or not, the others do the same."""

import re
from pathlib import Path

import numpy as np
import pytest

from trunnion.arrays import Ints
from trunnion.cli import main
from trunnion.machines import load_machine
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions

MACHINES = ["yl569", "dmu65", "hs664rt", "matsuura_mx330", "xyzac_trt", "generic_head_head_ca"]

HEAD = """TOOL PATH/{name},TOOL,D10
TLDATA/MILL,10,0,75,0,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,{tool}
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/MMPM,500
GOTO/0,0,5
"""

MILLED = """OPSKIP/ON
FEDRAT/MMPM,200
GOTO/10,20,4
CIRCLE/20,20,4,0,0,1,10
GOTO/20,30,4
OPSKIP/OFF
GOTO/20,20,4
RAPID
GOTO/20,20,28
OPSKIP/ON
RAPID
GOTO/25,20,30
OPSKIP/OFF
RAPID
GOTO/25,25,30
FEDRAT/MMPM,300
GOTO/25,25,4
OPSKIP/ON
GOTO/30,25,4
"""

TURNED = """GOTO/5,0,5,0.1,0,0.99498743710662
OPSKIP/ON
GOTO/5,5,5,0.2,0.1,0.974679434480896
OPSKIP/OFF
GOTO/5,9,5
"""

DRILLED = """RAPID
GOTO/0,0,30
CYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100
GOTO/0,0,0
OPSKIP/ON
GOTO/10,0,0
OPSKIP/OFF
GOTO/20,0,0
GOTO/30,0,0
OPSKIP/ON
GOTO/40,0,0
CYCLE/OFF
RAPID
GOTO/40,0,30
OPSKIP/OFF
RAPID
GOTO/40,9,30
"""

TEXTS = {"milled": MILLED, "turned": TURNED, "drilled": DRILLED}


def places(run: Run, skipped: set[int]) -> Ints:
    """Rows that go to a place of the workpiece beside them, or drill; none that may be skipped."""
    words = run.programmed & int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)
    goes = ((words != 0) & (words != ProgrammedWord.Z)) | ((run.programmed == 0) & (run.kind == Kind.LINEAR))
    kept = np.array([line not in skipped for line in run.line.tolist()])
    return np.flatnonzero(goes & kept & ~run.machine_frame)


@pytest.mark.third
@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_blocks_behind_skipped_ones_do_the_same(
    machine: str, text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = tmp_path / "part.cls", tmp_path / "part.nc"
    first = HEAD.format(name="ONE", tool=1) + text + "END-OF-PATH\n"
    path.write_text(first + HEAD.format(name="TWO", tool=2) + "GOTO/9,9,5\nEND-OF-PATH\n", encoding="utf-8")
    assert main(["post", str(path), "--machine", machine, "--output", str(out)]) == 0
    last = text.rstrip().rpartition("OPSKIP/")[2]
    assert last.startswith("OFF") or "OPSKIP/ON ends with operation ONE" in capsys.readouterr().err
    model = load_machine(machine)
    whole, short = run_program(out, model), run_program(out, model, RunOptions(skip=True))
    lines = out.read_text(encoding="utf-8").splitlines()
    skipped = {k for k, line in enumerate(lines, 1) if line.startswith("/")}
    assert skipped
    here, there = places(short, set()), places(whole, skipped)
    assert len(here)
    assert short.line[here].tolist() == whole.line[there].tolist()
    assert short.joints[here] == pytest.approx(whole.joints[there], abs=1e-9)
    for column in ("kind", "feed_mode", "rpm", "spindle", "tool", "work_offset", "tcp"):
        assert np.array_equal(getattr(short, column)[here], getattr(whole, column)[there]), column
    cuts = short.kind[here] != Kind.RAPID
    assert np.array_equal(short.feed[here][cuts], whole.feed[there][cuts])
    assert not any(line.startswith("/") and ("M6" in line or "M91" in line or "SUPA" in line) for line in lines)


@pytest.mark.parametrize("machine", MACHINES)
def test_a_hole_behind_a_retract_that_may_be_skipped_is_gone_to_from_above(
    machine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (
        "CYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100\nGOTO/0,0,0\nOPSKIP/ON\nRAPID\nGOTO/0,0,50\nOPSKIP/OFF\n"
        "GOTO/50,0,20\nCYCLE/OFF\n"
    )
    path, out = tmp_path / "part.cls", tmp_path / "part.nc"
    path.write_text(HEAD.format(name="ONE", tool=1) + text + "END-OF-PATH\n", encoding="utf-8")
    assert main(["post", str(path), "--machine", machine, "--output", str(out)]) == 0
    run = run_program(out, load_machine(machine), RunOptions(skip=True))
    across = np.flatnonzero((np.abs(np.diff(run.tip[:, 0])) > 1.0) & ~run.machine_frame[1:])
    assert len(across)
    assert (run.tip[across + 1, 2] > 22.0).any()
    assert not ((run.tip[across, 2] < 22.0) & (run.tip[across + 1, 0] > 49.0)).any()


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize(
    ("before", "skipped"), [("GOTO/0,0,5", "RAPID\nGOTO/0,0,50"), ("RAPID\nGOTO/0,0,50", "FEDRAT/MMPM,500\nGOTO/0,0,5")]
)
def test_a_hole_made_by_motion_beside_a_cut_and_skipped_blocks_is_refused(
    machine: str, before: str, skipped: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (
        f"{before}\nOPSKIP/ON\n{skipped}\nOPSKIP/OFF\nCYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100\n"
        "GOTO/50,0,0\nCYCLE/OFF\nRAPID\nGOTO/50,0,50\n"
    )
    path, out = tmp_path / "part.cls", tmp_path / "part.nc"
    path.write_text(HEAD.format(name="ONE", tool=1) + text + "END-OF-PATH\n", encoding="utf-8")
    assert main(["post", str(path), "--machine", machine, "--output", str(out), "--set", "cycles=off"]) == 1
    assert not out.exists()
    assert "a hole behind blocks that may be skipped" in capsys.readouterr().err


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "hs664rt", "matsuura_mx330"])
def test_turns_to_another_plane_are_not_skipped(
    machine: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (
        "RAPID\nGOTO/0,0,30\nCYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100\nGOTO/0,0,0\nOPSKIP/ON\n"
        "GOTO/5,0,0\nGOTO/20,0,0,0.5,0,0.86602540378444\nOPSKIP/OFF\nGOTO/20,5,0\nCYCLE/OFF\nRAPID\nGOTO/40,9,60\n"
    )
    path, out = tmp_path / "part.cls", tmp_path / "part.nc"
    path.write_text(HEAD.format(name="ONE", tool=1) + text + "END-OF-PATH\n", encoding="utf-8")
    asked = main(["post", str(path), "--machine", machine, "--output", str(out)])
    text = text.replace("OPSKIP/ON\n", "").replace("OPSKIP/OFF\n", "")
    path.write_text(HEAD.format(name="ONE", tool=1) + text + "END-OF-PATH\n", encoding="utf-8")
    assert (asked, main(["post", str(path), "--machine", machine, "--output", str(out)])) == (2, 0)
    assert "turns to another plane between blocks that may be skipped" in capsys.readouterr().err


@pytest.mark.parametrize("machine", MACHINES)
def test_what_may_be_skipped_ends_right_before_another_plane(machine: str, tmp_path: Path) -> None:
    text = (
        "RAPID\nGOTO/0,0,30\nCYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100\nGOTO/0,0,0\nOPSKIP/ON\n"
        "GOTO/5,0,0\nOPSKIP/OFF\nGOTO/20,0,0,0.5,0,0.86602540378444\nGOTO/20,5,0\nCYCLE/OFF\n"
    )
    path, out = tmp_path / "part.cls", tmp_path / "part.nc"
    path.write_text(HEAD.format(name="ONE", tool=1) + text + "END-OF-PATH\n", encoding="utf-8")
    assert main(["post", str(path), "--machine", machine, "--output", str(out)]) == 0
    whole, short = (run_program(out, load_machine(machine), RunOptions(skip=skip)) for skip in (False, True))
    assert len(short) < len(whole)
    assert np.array_equal(short.axis[-1], whole.axis[-1])
    assert (np.abs(whole.axis - (0.5, 0.0, 0.86602540378444)) < 1e-3).all(axis=1).any()
    assert (np.abs(short.axis - (0.5, 0.0, 0.86602540378444)) < 1e-3).all(axis=1).any()


#: One hole of several may be skipped.
_ONE_HOLE = """\
TOOL PATH/DRILLS,TOOL,D8
TLDATA/MILL,8,0,60,0,0
LOADTL/1
SPINDL/RPM,2000,CLW
RAPID
GOTO/0,0,50,0,{axis}
CYCLE/DRILL,RAPTO,3,FEDTO,-10,RTRCTO,20,MMPM,150
GOTO/0,0,0
OPSKIP/ON
GOTO/20,0,0
OPSKIP/OFF
GOTO/40,0,0
CYCLE/OFF
RAPID
GOTO/60,0,80
END-OF-PATH
"""


@pytest.mark.third
@pytest.mark.parametrize("axis", ["0,1", "-0.5,0.8660254"])
@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750", "dmu65", "yl569", "hs664rt", "xyzac_trt"])
def test_a_hole_by_motion_that_may_be_skipped_passes_with_the_way_to_it(
    machine: str, axis: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cl, program = tmp_path / "skip.cls", tmp_path / "skip.nc"
    cl.write_text(_ONE_HOLE.format(axis=axis), encoding="utf-8")
    assert main(["post", str(cl), "--machine", machine, "--set", "mode=tcp", "--output", str(program)]) == 0
    # The way to the next hole has no sign of its own.
    blocks = program.read_text(encoding="utf-8").splitlines()
    last = max(k for k, block in enumerate(blocks) if block.startswith("/"))
    blocks[last + 1] = "/" + blocks[last + 1]
    program.write_text("\n".join(blocks) + "\n", encoding="utf-8")
    capsys.readouterr()
    assert main(["verify", str(program), "--machine", machine, "--cl", str(cl)]) == 1
    assert "may be skipped (/), and the CL file has no OPSKIP there" in capsys.readouterr().out


#: The first of three holes may be skipped; the tool comes from a height.
_FIRST_HOLE = """\
TOOL PATH/DRILLS,TOOL,D8
TLDATA/MILL,8,0,60,0,0
LOADTL/1
SPINDL/RPM,2000,CLW
RAPID
GOTO/-10,0,{height},0,{axis}
CYCLE/{cycle},RAPTO,3,FEDTO,-10,RTRCTO,20,MMPM,150
OPSKIP/ON
GOTO/{skipped}
OPSKIP/OFF
GOTO/20,0,0
GOTO/40,0,0
CYCLE/OFF
RAPID
GOTO/60,0,80
END-OF-PATH
"""


@pytest.mark.third
@pytest.mark.parametrize(("height", "skipped", "axis"), [
    (50, "0,0,0", "0,1"), (50, "0,0,0", "-0.5,0.8660254"), (5, "-10,0,0", "0,1"), (50, "20,0,0", "0,1"),
])  # fmt: skip
@pytest.mark.parametrize("machine", ["matsuura_mx330", "haas_umc750", "dmu65", "yl569", "hs664rt", "xyzac_trt"])
def test_the_way_to_the_hole_behind_a_first_one_that_may_be_skipped_is_level_in_both_cases(
    machine: str, height: int, skipped: str, axis: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cl, program = tmp_path / "skip.cls", tmp_path / "skip.nc"
    cl.write_text(_FIRST_HOLE.format(axis=axis, height=height, skipped=skipped, cycle="DRILL"), encoding="utf-8")
    code = main(["post", str(cl), "--machine", machine, "--set", "mode=tcp", "--output", str(program)])
    assert code == 0, capsys.readouterr().out


def test_the_rise_above_a_hole_is_skipped_with_the_hole_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cl, program = tmp_path / "skip.cls", tmp_path / "skip.nc"
    text = _FIRST_HOLE.format(axis="0,1", height=50, skipped="0,0,0", cycle="BORE,DRAG")
    cl.write_text(text, encoding="utf-8")
    post = ["post", str(cl), "--machine", "yl569", "--set", "mode=tcp"]
    assert main([*post, "--output", str(program)]) == 0
    blocks = program.read_text(encoding="utf-8")
    assert re.search(r"^/N\d+ (G0 )?Z50\.\n", blocks, re.MULTILINE)
    cl.write_text(text.replace("OPSKIP/ON\nGOTO/0,0,0\n", "GOTO/0,0,0\nOPSKIP/ON\n"), encoding="utf-8")
    capsys.readouterr()
    assert main(["verify", str(program), "--machine", "yl569", "--cl", str(cl)]) == 1
    assert "may be skipped (/), and the CL file has no OPSKIP there" in capsys.readouterr().out


#: What the operator may skip, from a cut to another one, with turns of the tool: each ends at rapid above all cuts.
_UP = "RAPID\nGOTO/15.527708,0,60,{a}\n"
_SKIPPED = {
    "a retract": f"OPSKIP/ON\n{_UP}OPSKIP/OFF\n",
    "a cut and its retract": "OPSKIP/ON\nGOTO/10,9,6,{a}\nRAPID\nGOTO/10,9,60,{b}\nOPSKIP/OFF\n",
    "a turn": f"{_UP}OPSKIP/ON\nRAPID\nGOTO/20,10,60,{{b}}\nOPSKIP/OFF\n",
    "the first point": "",
}
_LEANING = {"a": "0.1,0,0.99498743710662", "b": "0,-0.5,0.86602540378444"}
_OVER = "RAPID\nGOTO/30,10,60,{b}\n"


def _skipping(what: str) -> str:
    """CL text in which the operator may skip something; the way on behind it is aslant, or a plunge."""
    head, _, cut = HEAD.format(name="ONE", tool=1).partition("RAPID\n")
    first = "OPSKIP/ON\n" if what == "the first point" else ""
    last = f"{_UP}OPSKIP/OFF\n{_OVER}" if first else _SKIPPED[what] + ("" if what == "a turn" else _OVER)
    text = f"{head}{first}RAPID\n{cut}GOTO/10,0,5,{{a}}\n{last}FEDRAT/MMPM,300\nGOTO/30,12,5,{{b}}\nGOTO/30,20,5\n"
    return text.format(**_LEANING) + "RAPID\nGOTO/30,20,60\nEND-OF-PATH\n"


@pytest.mark.third
@pytest.mark.parametrize("what", _SKIPPED)
@pytest.mark.parametrize(
    "machine", [*MACHINES, "haas_umc750", "mikron_600u", "ucp800", "generic_head_table_bc", "generic_nutated_b45_c"]
)
def test_place_and_posture_are_stated_again_behind_what_may_be_skipped(
    machine: str, what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cl, program = tmp_path / "skip.cls", tmp_path / "skip.nc"
    cl.write_text(_skipping(what), encoding="utf-8")
    assert main(["post", str(cl), "--machine", machine, "--output", str(program)]) == 0, capsys.readouterr().out
    run = run_program(program, load_machine(machine), RunOptions(skip=True))
    # Out of the cut the tool goes straight up along its axis, or home; into the next one as in the CL file.
    plunge = int(np.flatnonzero(np.abs(run.tip - (30.0, 12.0, 5.0)).max(axis=1) < 0.01)[0])
    rows = np.flatnonzero(~run.machine_frame & (run.kind == Kind.RAPID) & (run.programmed != 0))
    rows = rows[(rows > 0) & (rows < plunge) & (run.tip[rows - 1, 2] < 10.0) & run.tcp[rows] & run.tcp[rows - 1]]
    for row in rows.tolist():
        step, axis = run.tip[row] - run.tip[row - 1], run.axis[row - 1]
        assert np.linalg.norm(step - (step @ axis) * axis) < 0.01
        assert np.abs(run.axis[row] - axis).max() < 1e-4
    assert np.abs(run.axis[plunge] - run.axis[plunge - 1]).max() < 1e-4
    # Without the way behind the skipped blocks the program fails.
    lines = program.read_text(encoding="utf-8").splitlines()
    last = max(k for k, line in enumerate(lines) if line.startswith("/"))
    again = next(k for k in range(last + 1, len(lines)) if re.search(r"[XY]", lines[k]) and ";" not in lines[k])
    if what != "the first point":
        program.write_text("\n".join(lines[:again] + lines[again + 1 :]) + "\n", encoding="utf-8")
        assert main(["verify", str(program), "--machine", machine, "--cl", str(cl)]) == 1


def test_a_cycle_that_ends_among_skipped_blocks_ends_in_both_cases(tmp_path: Path) -> None:
    text = (
        "RAPID\nGOTO/0,0,30\nCYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100\nGOTO/0,0,0\nOPSKIP/ON\nGOTO/10,0,0\n"
        "CYCLE/OFF\nRAPID\nGOTO/10,0,30\nOPSKIP/OFF\nRAPID\nGOTO/20,9,30\nFEDRAT/MMPM,200\nGOTO/20,9,5\nGOTO/30,9,5\n"
    )
    cl = tmp_path / "part.cls"
    cl.write_text(HEAD.format(name="ONE", tool=1) + text + "END-OF-PATH\n", encoding="utf-8")
    for machine in ("yl569", "dmu65"):
        assert main(["post", str(cl), "--machine", machine, "--output", str(tmp_path / f"{machine}.nc")]) == 0
