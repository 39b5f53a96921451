"""Klartext with surface normals: LN blocks with NX NY NZ, read back and proven."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, event, example, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext import CONTROLS, MACHINES, PATHS, SHARES, Post, motion, proven, toolpath_of
from tests.support.operations import moves_of, rapids_at
from tests.support.path_strategies import directions, winding
from tests.support.planes import reachable
from tests.support.posting import FOOT, HEAD
from trunnion.arrays import Floats
from trunnion.cli import main
from trunnion.errors import InputError, RefusedError
from trunnion.model.axis_tolerance import AxisTolerance
from trunnion.model.toolpath import Kind, Moves
from trunnion.verification import Verification


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


NORMALS = ("--set", "normals=contact")
VECTOR = (*NORMALS, "--set", "orientation=vector")

BALL = HEAD.replace("10.0000,0.0000,75", "10.0000,5.0000,75").replace("RAPID", "$$ centerline and contact point\nRAPID")
#: Normals (0, 0, 1), (0.6, 0, 0.8) and, under a tool that leans, (0, 0, 1) again.
UPRIGHT = BALL + "GOTO/20,0,5 $$ 20,0,5\nGOTO/30,0,5 $$ 27,0,6\n"
LEANING = UPRIGHT + "GOTO/40,0,5,0.5,0,0.8660254038 $$ 42.5,0,4.330127\nGOTO/50,0,5 $$ 52.5,0,4.330127\n"


def cut(post: Post, text: str, *arguments: str) -> list[str]:
    """The motion blocks of a program that has points without a contact point."""
    code, out, err = post.all(text + FOOT, *arguments)
    assert code == 0
    assert "points; the control does not compensate the tool there" in err
    return motion([line.split(" ", 1)[1] for line in out.splitlines()])


def test_a_line_with_a_contact_point_says_place_and_normal_whole(post: Post) -> None:
    assert cut(post, UPRIGHT, *NORMALS) == [
        "L X+0 Y+0 Z+50 FMAX",
        "L X+10 Z+5 F500",
        "LN X+20 Y+0 Z+5 NX+0 NY+0 NZ+1",
        "LN X+30 Y+0 Z+5 NX+0.6 NY+0 NZ+0.8",
    ]


def test_with_tcp_the_tool_axis_stands_beside_each_normal(post: Post) -> None:
    """Without it the control would align the tool with the normal."""
    assert cut(post, LEANING, *VECTOR)[2:] == [
        "LN X+20 Y+0 Z+5 NX+0 NY+0 NZ+1 TX+0 TY+0 TZ+1",
        "LN X+30 Y+0 Z+5 NX+0.6 NY+0 NZ+0.8 TX+0 TY+0 TZ+1",
        "LN X+40 Y+0 Z+5 NX+0 NY+0 NZ+1 TX+0.5 TY+0 TZ+0.8660254",
        "LN X+50 Y+0 Z+5 NX+0 NY+0 NZ+1 TX+0.5 TY+0 TZ+0.8660254",
    ]


def test_without_the_setting_contact_points_are_comments(post: Post) -> None:
    assert not any(block.startswith("LN") for block in post(LEANING + FOOT))


WITHOUT = ("--set", "tcp=off", "--set", "zero=0,0,0", "--set", "tool_length=50")
REFUSED = {
    (LEANING, NORMALS): "--set orientation=vector writes the tool axis as well",
    (
        LEANING,
        (*NORMALS, "--set", "tcp=off", "--set", "zero=0,0,0", "--set", "tool_length=50"),
    ): "X, Y and Z are axis positions",
    (UPRIGHT + "CIRCLE/40,0,5,0,0,1,10,0.06,0.5,10,0\nGOTO/40,10,5\n", NORMALS): "output lines only",
    (
        UPRIGHT + "GOTO/40,0,5,0.5,0,0.8660254038 $$ 42.5,0,4.3\nGOTO/50,40,5,0,0.8,0.6 $$ 50,42.5,4.3\n",
        (*VECTOR, "--set", "axis_tolerance=0.01"),
    ): "leave the setting axis_tolerance out",
}


@pytest.mark.parametrize(("given", "why"), REFUSED.items())
def test_normals_that_cannot_be_said_are_refused(given: tuple[str, tuple[str, ...]], why: str, post: Post) -> None:
    code, out, err = post.all(given[0] + FOOT, *given[1])
    assert (code, out) == (2, "")
    assert why in err


def test_points_without_a_contact_point_are_told(post: Post) -> None:
    _, _, err = post.all(UPRIGHT + FOOT, *NORMALS)
    assert "no contact point at 1 of 4 points" in err
    _, _, err = post.all(HEAD + FOOT, *NORMALS)
    assert "has no contact points, and so no surface normals" in err


# Whatever is planned


def touched(moves: Moves, seed: int) -> Moves:
    """The moves with normals of any direction at some of their lines."""
    random = np.random.default_rng(seed)
    normal = random.normal(size=(len(moves), 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    normal[(random.random(len(moves)) < 0.3) | (moves.kind != Kind.LINEAR)] = np.nan
    return replace(moves, normal=normal)


def said(folder: Path) -> Floats:
    """The normals of a program, line by line."""
    text = (folder / "part.h").read_text(encoding="utf-8")
    found = re.findall(r" LN .* NX(\S+) NY(\S+) NZ(\S+)", text)
    return np.array([[float(v) for v in row] for row in found]).reshape(-1, 3)


def summary(found: Verification) -> str:
    return next((check.summary for check in found.checks if check.key == "normal"), "")


#: A tool axis near the pole, which the digits of a vector place better than the rotary axis there.
NEAR_POLE = rapids_at(
    moves_of(np.linspace([-40.0, 0.0, 0.0], [40.0, 0.0, 5.0], 3), directions(np.full(3, 1.5), np.full(3, 1.5))), [0]
)


@settings(max_examples=examples(25))
@given(name=st.sampled_from(sorted(MACHINES)), moves=PATHS, seed=st.integers(0, 99))
@example(name="dmu65", moves=NEAR_POLE, seed=0)
@example(name="generic_head_head_ca", moves=winding(12.0, 0.0, 700.0, 30), seed=0)  # draws back to turn
def test_normals_beside_a_tool_axis_that_changes_are_proven(name: str, moves: Moves, seed: int, folder: Path) -> None:
    shift = 20.0 * np.sin(np.arange(len(moves)))[:, None] * [1.0, 0.5, 0.2]
    moves = touched(replace(moves, tip=np.round(moves.tip + shift, 5)), seed)
    try:
        given = {"orientation": "vector", "normals": "contact", "mode": "tcp"}
        # Coarse steps stay as they are: between CL points no normal is known.
        control = replace(CONTROLS["mikron_600u"], axis_tolerance=AxisTolerance(180.0, 180.0))
        found = proven(toolpath_of(moves), MACHINES[name], control, folder, **given)
    except (RefusedError, InputError):
        event("refused")
        assume(False)
    assert moves.normal is not None
    wanted = moves.normal[np.isfinite(moves.normal[:, 0])]
    printed = said(folder)
    event(f"all said: {len(printed) == len(wanted)}")
    # In their order, all but those of blocks that place the rotary axes.
    at = 0
    for row in printed:
        while np.abs(wanted[at] - row).max() > 5.1e-8:
            at += 1
    lines = (folder / "part.h").read_text(encoding="utf-8").splitlines()
    placing = [line for line in lines if re.match(r"\d+ L X.* [ABC][-+]", line)]
    assert len(wanted) - len(printed) <= len(placing)
    assert (f"{len(printed)} normal" in summary(found)) == bool(len(wanted))


@settings(max_examples=examples(25))
@given(
    name=st.sampled_from(sorted(MACHINES)),
    share=SHARES,
    seed=st.integers(0, 99),
    way=st.sampled_from(["spatial", "vector", "cycle19"]),
)
def test_normals_in_planes_are_proven(name: str, share: tuple[float, float], seed: int, way: str, folder: Path) -> None:
    machine = MACHINES[name]
    tips = np.round(np.random.default_rng(seed).uniform(-60.0, 60.0, (6, 3)), 4)
    moves = touched(moves_of(tips, np.tile(reachable(machine, share), (6, 1))), seed)
    try:
        found = proven(toolpath_of(moves), machine, CONTROLS["mikron_600u"], folder, plane=way, normals="contact")
    except (RefusedError, InputError):
        assume(False)
    assert moves.normal is not None
    count = int(np.isfinite(moves.normal[:, 0]).sum())
    assert len(said(folder)) == count
    assert (f"{count} normals" in summary(found)) == bool(count)


def test_a_rewind_draws_back_without_a_normal_and_comes_back_with_it(
    post: Post, capfd: pytest.CaptureFixture[str]
) -> None:
    machine = post.folder / "ended.toml"
    text = 'extends = "generic_head_head_ca"\n[control]\nextends = "heidenhain_tnc640"\n'
    machine.write_text(text, encoding="utf-8")
    rows = ""
    for a in np.radians(np.arange(0.0, 1200.0, 10.0)):
        tip = np.array([30.0 * np.cos(a), 30.0 * np.sin(a), 5.0])
        axis = np.array([0.5 * np.cos(a), 0.5 * np.sin(a), 0.8660254])
        there = tip + 5.0 * axis - [0.0, 0.0, 5.0]
        vector, point = (",".join(f"{v:.7f}" for v in each) for each in (axis, there))
        rows += f"GOTO/{tip[0]:.4f},{tip[1]:.4f},{tip[2]:.4f},{vector} $$ {point}\n"
    code, out, err = post.all(BALL + rows + FOOT, *VECTOR, machine=str(machine))
    assert code == 0, err
    assert "draws back 50 mm in the cut to rewind" in err
    lines = [line.split(" ", 1)[1] for line in out.splitlines()]
    turn = next(k for k, line in enumerate(lines) if re.match(r"L C\S+ A\S+ FMAX", line))
    away = next(line for line in lines[turn - 1 :: -1] if line.startswith("L"))
    near, back = [line for line in lines[turn + 1 :] if line.startswith("L")][:2]
    assert "NX" not in away + near
    assert " NZ+1 TX" in back
    # Its normal is proven too, though it goes to no CL point of its own.
    file = post.folder / "part.h"
    for new in (" NX+0 NY+0 NZ+1", " NX+0.6 NY+0 NZ+0.8", ""):
        changed = out.replace(back, back.replace(" NX+0 NY+0 NZ+1", new))
        file.write_text(changed, encoding="utf-8")
        code = main(["verify", str(file), "--machine", str(machine), "--cl", str(post.folder / "part.cls")])
        (told,) = [line for line in capfd.readouterr().out.splitlines() if line.startswith("normal ")]
        assert (code, "1 are not" in told) == ((0, False) if changed == out else (1, True))


# Whoever verifies looks at them


@pytest.fixture
def program(post: Post) -> tuple[Path, Path]:
    """A program with normals, and its CL file."""
    code, out, err = post.all(LEANING + FOOT, *VECTOR)
    assert code == 0, err
    (post.folder / "part.h").write_text(out, encoding="utf-8")
    return post.folder / "part.h", post.folder / "part.cls"


FAULTS = {
    "as it is": ("", "", "ok    4 normals as the contact points have them"),
    "a sign": ("NX+0.6", "NX-0.6", "1 are not"),
    "a digit": ("NX+0.6", "NX+0.600002", "1 are not"),
    "left out": (" NX+0.6 NY+0 NZ+0.8", "", "1 are not"),
    "a component left out": (" NX+0.6", "", "1 are not"),
    "put in": ("L X+10 Z+5", "LN X+10 Z+5 NX+0 NY+0 NZ+1", "1 are not"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_of_a_normal_is_found(
    fault: str, program: tuple[Path, Path], capfd: pytest.CaptureFixture[str]
) -> None:
    file, cl = program
    old, new, told = FAULTS[fault]
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1) if old else text, encoding="utf-8")
    code = main(["verify", str(file), "--machine", "dmu65", "--cl", str(cl)])
    (line,) = [line for line in capfd.readouterr().out.splitlines() if line.startswith("normal ")]
    assert told in line
    assert (code == 0) == (fault == "as it is")


def test_normals_that_no_contact_point_asks_for_are_told(
    program: tuple[Path, Path], capfd: pytest.CaptureFixture[str]
) -> None:
    file, cl = program
    cl.write_text(re.sub(r" \$\$ .*", "", cl.read_text(encoding="utf-8")), encoding="utf-8")
    assert main(["verify", str(file), "--machine", "dmu65", "--cl", str(cl)]) == 0
    assert "no contact points to compare them with" in capfd.readouterr().out


def test_normals_stay_behind_when_a_program_becomes_a_cl_file(
    program: tuple[Path, Path], capfd: pytest.CaptureFixture[str]
) -> None:
    main(["convert", str(program[0]), "--machine", "dmu65", "--to-cl", "--output", "-"])
    assert "4 blocks with a surface normal, which is not carried over" in capfd.readouterr().err
