"""Fidia programs: the one that ran, planes of the rotary position, circles, TCP, cycles; written, read back, proven."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from tests.support import nci_of_holes
from tests.support.examples import examples
from tests.support.fidia import CYCLES, END, HEIGHTS, START, circles, holes_in
from tests.support.jobs import post_job
from tests.support.locations import FIDIA, FIDIA_HEAD, TESTS
from tests.support.path_strategies import short_paths, smooth_paths
from tests.support.proof import unproven
from tests.support.read_back import toolpath_of
from trunnion.arrays import Floats
from trunnion.cl import read_cl
from trunnion.cli import main
from trunnion.controls import load_control
from trunnion.errors import InputError, RefusedError
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import Machine, load_machine
from trunnion.model.toolpath import Moves, Toolpath
from trunnion.output.capabilities import control_capabilities
from trunnion.output.program_writer import write_program
from trunnion.readers import run_program
from trunnion.verification import ExpectedValues, Verification, failures, verify

#: The program that ran writes the blank behind a block number or leaves it out at whim.
NUMBER = re.compile(rb"^(N\d+) ", re.MULTILINE)


def test_the_published_program_comes_out_and_is_proven(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    head = [f"--set={key}={value}" for key, value in FIDIA_HEAD.items()]
    code = main(["post", str(FIDIA / "radial_holes.cls"), "--machine", "hs664rt", "--output", "-", *head])
    out, err = capfdbinary.readouterr()
    assert (code, unproven(err.decode())) == (0, "")
    expected = (FIDIA / "radial_holes.expected.txt").read_bytes().replace(b"\r\n", b"\n")
    assert NUMBER.sub(rb"\1", out).strip() == NUMBER.sub(rb"\1", expected).strip()


def test_the_published_program_comes_out_of_a_file_of_mastercam(
    tmp_path: Path, capfdbinary: pytest.CaptureFixture[bytes]
) -> None:
    """The published work began with Mastercam: its holes as records 81, the rapids between them as records 11."""
    (operation,) = read_cl(FIDIA / "radial_holes.cls").operations
    (tmp_path / "part.nci").write_text(nci_of_holes.write(operation, FIDIA_HEAD["title"]), encoding="utf-8")
    head = [f"--set={key}={value}" for key, value in (FIDIA_HEAD | {"cl_units": "mm"}).items()]
    code = main(["post", str(tmp_path / "part.nci"), "--machine", "hs664rt", "--output", "-", *head])
    out, err = capfdbinary.readouterr()
    assert code == 0, err.decode()
    expected = (FIDIA / "radial_holes.expected.txt").read_bytes().replace(b"\r\n", b"\n")
    assert NUMBER.sub(rb"\1", out).strip() == NUMBER.sub(rb"\1", expected).strip()


def test_the_published_program_is_proven_as_it_is(capsys: pytest.CaptureFixture[str]) -> None:
    program, cl = FIDIA / "radial_holes.expected.txt", FIDIA / "radial_holes.cls"
    assert main(["verify", str(program), "--cl", str(cl), "--machine", "hs664rt"]) == 0, capsys.readouterr().out


CONTROL = load_control(load_machine("hs664rt").control)
MACHINE = load_machine("hs664rt")


def with_travel(low: float, high: float, home: float) -> Machine:
    """The machine with a travel of Z that is known."""
    axes = tuple(
        replace(axis, low=low, high=high, home=home) if axis.name == "Z" else axis
        for axis in load_machine("hs664rt").axes
    )
    return replace(load_machine("hs664rt"), axes=axes)


#: M242 is no motion, one to the machine's home, or one beyond it.
MACHINES = {"unknown": MACHINE, "home": with_travel(-500.0, 500.0, 500.0), "beyond": with_travel(-400.0, 600.0, 0.0)}
SLOW = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("fidia")


def posted(toolpath: Toolpath, folder: Path, machine: Machine = MACHINE, **asked: str) -> tuple[Verification, str]:
    """The proof of the program of a toolpath, and its text."""
    program = plan_program([toolpath], post_job(machine, CONTROL, parse_plan_options(asked, CONTROL), {}))[0]
    target = folder / "part.txt"
    with target.open("wb") as sink:
        write_program(program, sink)
        expected = expectation(program)
    found = verify(run_program(target, machine), [toolpath], tolerances=expected.tolerances, settings=expected.settings)
    return found, target.read_text(encoding="utf-8")


def proven(toolpath: Toolpath, folder: Path, machine: Machine = MACHINE, **asked: str) -> str:
    """The text of a program that is proven, and has no G0 and no feed that is not a whole number."""
    found, text = posted(toolpath, folder, machine, **asked)
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]
    assert {each.code for each in found.run.diagnostics} <= {"NC342"}  # the end of a turn in the cut
    blocks = [line for line in text.splitlines() if not line.startswith("(")]
    assert not [line for line in blocks if re.search(r"G0?0(?!\d)|F\d*\.", line)]
    assert all(re.match(r"N\d+ ", line) for line in blocks)
    return text


@settings(max_examples=examples(12), suppress_health_check=SLOW)
@given(moves=smooth_paths(25.0) | smooth_paths(100.0) | short_paths(12))
def test_simultaneous_motion_is_proven(moves: Moves, folder: Path) -> None:
    try:
        text = proven(toolpath_of(moves), folder)
    except (RefusedError, InputError):
        assume(False)
        return
    if "G154" not in text and re.search(r"A-?[1-9]", text):
        assert 0 < text.find("G197") < text.find("G196") < text.rfind("G197")


AXES = st.tuples(st.floats(-105.0, 105.0), st.floats(0.0, 359.0))


def axis_of(a: float, c: float) -> str:
    """The tool axis Rz(C) Rx(A) z."""
    sa, ca, sc, cc = (f(math.radians(v)) for v in (a, c) for f in (math.sin, math.cos))
    return f"{sc * sa:.12f},{-cc * sa:.12f},{ca:.12f}"


def direction(a: float, c: float) -> Floats:
    return np.array([float(v) for v in axis_of(a, c).split(",")])


def read(text: str, folder: Path) -> Toolpath:
    file = folder / "part.cls"
    file.write_text(text, encoding="utf-8")
    return read_cl(file)


@settings(max_examples=examples(12), suppress_health_check=SLOW)
@given(data=st.data(), turns=st.lists(AXES | st.just((0.0, 0.0)), min_size=1, max_size=3))
def test_milling_in_planes_with_circles_is_proven(
    data: st.DataObject, turns: list[tuple[float, float]], folder: Path
) -> None:
    parts = [data.draw(circles(direction(*turn))) for turn in turns]
    text = "".join(START.replace("OP1", f"OP{k}") + part + END for k, part in enumerate(parts))
    written = proven(read(text, folder), folder)
    level = control_capabilities(CONTROL, {}).negligible_tilt  # what leans less is upright, for nobody prints it
    tilted = sum(axis[2] < 0.0 or float(np.hypot(*axis[:2])) >= level for axis in (direction(*t) for t in turns))
    assert written.count("G154\n") == 2 * tilted  # taken up, and the plane of the machine at the end
    assert not re.search(r"G[23] .*Z.*I.*J", written), "circles in G17 do not rise"


@settings(max_examples=examples(20), suppress_health_check=SLOW)
@given(
    data=st.data(),
    turns=st.lists(AXES | st.just((0.0, 0.0)), min_size=1, max_size=4),
    travel=st.sampled_from(sorted(MACHINES)),
)
def test_holes_of_all_cycles_are_proven(
    data: st.DataObject, turns: list[tuple[float, float]], travel: str, folder: Path
) -> None:
    text = START + data.draw(holes_in([direction(*turn) for turn in turns])) + END
    proven(read(text, folder), folder, MACHINES[travel])


@pytest.mark.parametrize("travel", MACHINES)
def test_the_published_holes_are_proven_whatever_is_known_of_the_travel(travel: str, folder: Path) -> None:
    found, text = posted(read_cl(FIDIA / "radial_holes.cls"), folder, MACHINES[travel])
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]
    assert text.count("M242") == 2, "the CL file draws the tool back between its holes"


HOLES = (
    f"CYCLE/DRILL,{HEIGHTS}RTRCTO,3,MMPM,90\nGOTO/0,0,0,0,0,1\n"
    "GOTO/0,-30,0,0.0,-0.707106781187,0.707106781187\nCYCLE/OFF\n"
)


@pytest.mark.parametrize("travel", MACHINES)
def test_between_planes_the_tool_is_drawn_back_where_the_cl_file_does_not(travel: str, folder: Path) -> None:
    start = START + "RAPID\nGOTO/0,0,50,0,0,1\n"
    found, text = posted(read(start + HOLES + END, folder), folder, MACHINES[travel])
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]
    lines = [line.partition(" ")[2] for line in text.splitlines()]
    turn = lines.index("G01 C0. A45. F3000")
    assert lines[turn - 2 : turn] == ["G80", "M242"]
    number = next(k for k, line in enumerate(text.splitlines()) if line.endswith(" G01 C0. A45. F3000"))
    dropped = [line for k, line in enumerate(text.splitlines()) if k != number - 1]
    (folder / "low.txt").write_text("\n".join(dropped) + "\n", encoding="utf-8")
    run = run_program(folder / "low.txt", MACHINES[travel])
    asked = ExpectedValues(rapid_feed=3000.0)
    assert "turns" in [
        check.key for check in failures(verify(run, [read(start + HOLES + END, folder)], settings=asked))
    ]


def test_what_the_end_of_an_operation_switches_off_is_not_switched_off_twice(folder: Path) -> None:
    text = "RAPID\nGOTO/0,0,50,0,0,1\nCOOLNT/FLOOD\nFEDRAT/MMPM,500\nGOTO/9,0,5\nCOOLNT/OFF\nSPINDL/OFF\n"
    written = proven(read(START + text + END, folder), folder)
    assert [written.count(f"{word}\n") for word in ("M5", "M8", "M9")] == [1, 1, 1]
    later = text.replace("COOLNT/OFF", "COOLNT/OFF\nGOTO/20,0,5")
    assert proven(read(START + later + END, folder), folder).count("M9\n") == 2


@pytest.mark.parametrize("mode", CYCLES)
def test_each_cycle_has_its_word(mode: str, folder: Path) -> None:
    cycle = f"CYCLE/{mode.removesuffix(',DWELL')},{CYCLES[mode][1]}\nGOTO/10,5,2\nGOTO/20,5,2\nCYCLE/OFF\n"
    written = proven(read(START + "RAPID\nGOTO/10,5,50,0,0,1\n" + cycle + END, folder), folder)
    call = next(line for line in written.splitlines() if re.search(r" G8[1-9] ", line))
    found = re.fullmatch(r"N\d+ (G8\d) X10\. Y5\. Z([\d.]+) E-10\. R5\.( D2\.5)?( H0\.5)? F(\d+)", call)
    assert found, call
    assert found[1] == CYCLES[mode][0]
    assert bool(found[3]) == ("DEEP" in mode)
    assert bool(found[4]) == ("DWELL" in mode)
    assert found[5] == ("5000" if mode == "TAP" else "90")
    after = written.splitlines()[written.splitlines().index(call) + 1 :][:2]
    assert [line.partition(" ")[2] for line in after] == ["X20. Y5.", "G80"]


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (f"CYCLE/BORE,NODRAG,90,{HEIGHTS}MMPM,90\nGOTO/10,5,2\n", "no documented cycle for BORE,NODRAG"),
        (f"CYCLE/TAP,{HEIGHTS}MMPR,1.0001\nGOTO/10,5,2\n", "the pitch would be wrong"),
        (f"SPINDL/RPM,500,CCLW\nCYCLE/TAP,{HEIGHTS}MMPR,1\nGOTO/10,5,2\n", "left hand"),
        ("FEDRAT/MMPR,0.2\nGOTO/10,5,2\n", "feed per revolution"),
    ],
)
def test_what_cannot_be_said_is_refused(text: str, what: str, folder: Path) -> None:
    with pytest.raises((RefusedError, InputError), match=what):
        posted(read(START + "RAPID\nGOTO/10,5,50,0,0,1\n" + text + END, folder), folder)


def test_a_feed_that_would_print_as_nothing_is_refused(folder: Path) -> None:
    for text in ("FEDRAT/MMPM,0.3\nGOTO/10,5,2\n", f"CYCLE/DRILL,{HEIGHTS}MMPM,0.3\nGOTO/10,5,2\n"):
        with pytest.raises(InputError, match="is below the least that the control reads"):
            posted(read(START + "RAPID\nGOTO/10,5,50,0,0,1\n" + text + END, folder), folder)


def test_without_tcp_there_is_nothing_but_planes(folder: Path) -> None:
    text = START + "RAPID\nGOTO/10,5,50,0,0,1\nFEDRAT/MMPM,300\nGOTO/10,5,20,0.1,0,0.994987437107\n" + END
    with pytest.raises((RefusedError, InputError), match="does not support the mode"):
        posted(read(text, folder), folder, tcp="off")


def test_a_cut_past_the_end_of_a_turn_is_warned_of(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "tilted.nc"
    assert (
        main(["post", str(TESTS / "data" / "cases" / "tilted.cls"), "--machine", "hs664rt", "--output", str(program)])
        == 0
    )
    text, err = program.read_text(encoding="utf-8"), capsys.readouterr().err
    line = 1 + next(k for k, block in enumerate(text.splitlines()) if block.endswith("A-42.732 C0."))
    assert f":{line}: warning: C passes the end of its turn in the cut" in err
    assert err.count("NC342") == 1
