"""Fanuc orientations as vectors (G43.5): the control gets where the plan goes, or the operation has rotary words."""

import itertools
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, assume, event, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.fanuc import CONTROL, MACHINES, SLOW, body, machine, proven, read
from tests.support.fidia import END
from tests.support.jobs import post_job
from tests.support.path_strategies import short_paths, smooth_paths, winding
from tests.support.posting import HEAD, LEANING
from tests.support.read_back import toolpath_of
from trunnion.arrays import Floats
from trunnion.errors import InputError, RefusedError, Severity
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import Machine, Mount, inverse, load_machine
from trunnion.model.motion import MachiningMode
from trunnion.model.run import Orientation, ProgrammedWord
from trunnion.model.toolpath import Moves, Toolpath
from trunnion.output.coordinates.tool_vectors import (
    first_row_at_other_pose,
    leading_axis_pose_is_planned,
    tool_vectors_at,
)
from trunnion.output.program import Program
from trunnion.output.validation import check_program
from trunnion.readers import run_program

VECTORS = {"orientation": "vector"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("vectors")


def planned(toolpath: Toolpath, model: Machine) -> Program:
    return plan_program([toolpath], post_job(model, CONTROL, parse_plan_options(VECTORS, CONTROL), VECTORS))[0]


def test_a_whole_operation_by_vectors(folder: Path) -> None:
    more = "GOTO/20.0,0.0,5.0\nGOTO/30.0,0.0,5.0,0.48,0.36,0.8\n"
    text = proven(read(LEANING + more + END, folder), folder, load_machine("matsuura_mx330"), **VECTORS)
    assert body(text) == [
        "G54",
        "G0 A-30. C0.",
        "G05.1 Q1",
        "S4000 M3",
        "G0 G43.5 H1 X0. Y0. Z50.",
        "G1 X10. Z5. I0. J0.6 K0.8 F500.",
        "X20.",
        "X30. I0.48 J0.36 K0.8",
        "G49 G53 G0 Z0.",
        "G53 G0 X0. Y0. A0. C0.",
        "G05.1 Q0",
        "M5",
    ]


def test_planes_and_three_axes_stay_as_they_are_and_keep_their_circles(folder: Path) -> None:
    circle = "GOTO/20,0,5\nCIRCLE/20.0,10.0,5.0,0.0,0.0,1.0,10.0,0.06,0.5,10.0,0.0\nGOTO/30,10,5\n"
    path, model = read(HEAD + circle + END, folder), load_machine("matsuura_mx330")
    assert proven(path, folder, model, **VECTORS) == proven(path, folder, model)


def test_circles_become_lines_where_their_letters_are_those_of_vectors(folder: Path) -> None:
    circle = "GOTO/20,0,5\nCIRCLE/20.0,10.0,5.0,0.0,0.0,1.0,10.0,0.06,0.5,10.0,0.0\nGOTO/30,10,5\n"
    path, model = read(LEANING + circle + END, folder), load_machine("matsuura_mx330")
    assert any(line.startswith("G3 ") for line in body(proven(path, folder, model)))
    by_vectors = body(proven(path, folder, model, **VECTORS))
    assert not any(re.match(r"(G1[789] )?G[23] ", line) for line in by_vectors)
    assert len(by_vectors) > 40


def leaning_to(angles: tuple[float, ...], turned: float) -> Toolpath:
    """A cut whose tool leans by angles, towards one side of the workpiece."""
    n, tilts, side = len(angles), np.radians(angles), np.radians(turned)
    axis = np.column_stack([np.sin(tilts) * np.cos(side), np.sin(tilts) * np.sin(side), np.cos(tilts)])
    tip, lines = np.outer(np.arange(n), (20.0, 0.0, 0.0)), np.arange(n, dtype=np.int32)
    rapid, cut = np.array([0] + [1] * (n - 1), np.uint8), np.array([1] + [4] * (n - 1), np.uint8)
    return toolpath_of(Moves(tip, axis, rapid, cut, np.full(n, 100.0), np.zeros(n, np.bool_), lines, None))


@pytest.mark.parametrize(
    ("last", "turned", "by_vectors"), [(-11, 277.4, False), (-11, 299.3, False), (-10.9, 299.3, True)]
)
def test_a_vector_that_its_last_digit_turns_beyond_a_limit_is_not_used(
    last: float, turned: float, by_vectors: bool, folder: Path
) -> None:
    text = proven(leaning_to((-5, -8, last), turned), folder, machine("yl569"), mode="tcp", **VECTORS)
    assert ("G43.5" in text) is by_vectors


PATHS = st.one_of(
    smooth_paths(60.0),
    short_paths(12),
    st.builds(winding, st.floats(3.0, 29.0), st.floats(-180.0, 180.0), st.floats(200.0, 900.0), st.just(90)),
)


@pytest.mark.third
@pytest.mark.parametrize("name", MACHINES)
@settings(max_examples=examples(6), suppress_health_check=SLOW, phases=[Phase.generate])
@given(moves=PATHS)
def test_the_axes_stand_where_rotary_words_would_have_them(name: str, moves: Moves, folder: Path) -> None:
    model, path = machine(name), toolpath_of(moves)
    try:
        proven(path, folder, model, mode="tcp")
    except (RefusedError, InputError):
        assume(False)
    words = run_program(folder / "part.nc", model)
    text = proven(path, folder, model, mode="tcp", **VECTORS)
    vectors = run_program(folder / "part.nc", model)
    by_vectors = "G43.5" in text
    event(f"vectors: {by_vectors}")
    assert by_vectors != ("G43.4" in text)
    tips = vectors.tcp & ~vectors.machine_frame
    other = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND if by_vectors else ProgrammedWord.VECTOR)
    assert not (vectors.programmed[tips] & other).any()
    assert (vectors.orientation[tips] == Orientation.ANGLES).all()
    assert len(words) == len(vectors)
    # Half of the last digit of an angle, and what seven decimals of a vector leave open of the axes near a pole.
    sines = np.linalg.svd(_ways(model, words.rotary), compute_uv=False)[:, -1]
    allowed = 0.0005 + np.degrees(2e-7) / np.maximum(sines, 1e-6) + 1e-6
    apart = np.abs(words.rotary - vectors.rotary)
    apart = np.minimum(apart, np.abs(apart - 360.0)).max(axis=1)
    assert (apart <= np.minimum(allowed, 0.3)).all()


def _ways(model: Machine, rotary: Floats) -> Floats:
    """(n, 2, 3): how the tool axis goes as either axis turns, per radian."""
    step = np.eye(2) * 0.01
    return np.stack(
        [
            (tool_vectors_at(model, rotary + one) - tool_vectors_at(model, rotary - one)) / np.radians(0.02)
            for one in step
        ],
        axis=1,
    )


def chosen(model: Machine, vector: Floats, stands: Floats, inside: bool) -> Floats:
    """The choice as the manual describes it, one by one (A-79348E, B-63944EN, *angle of the rotary axis*)."""
    solved = inverse(model, np.zeros((1, 3)), vector[None])
    axes = [model.axes[column] for column in model.rotary]
    candidates = []
    for branch in range(2):
        pair = solved.joints[branch, 0][list(model.rotary)]
        turns = itertools.product(range(-3, 4), repeat=2)
        candidates += [pair + 360.0 * np.array(turn) for turn in turns]
    if inside:
        low, high = np.array([(axis.low, axis.high) for axis in axes]).T
        within = [pair for pair in candidates if ((pair >= low - 1e-6) & (pair <= high + 1e-6)).all()]
        candidates = within or candidates
    tables = [axis.mount is Mount.PART for axis in axes]
    first = 1 if all(tables) else 0  # the one that carries the other; where only one is a table, that one
    order = [first, 1 - first]

    def key(pair: Floats) -> tuple[float, ...]:
        ways = [round(abs(pair[k] - stands[k]), 7) for k in order]
        rest = [round(abs(pair[k] - 360.0 * np.rint(pair[k] / 360.0)), 7) for k in order]
        return (*ways, *rest)

    return np.asarray(min(candidates, key=key))


@settings(max_examples=examples(100), suppress_health_check=[HealthCheck.filter_too_much])
@given(
    name=st.sampled_from(MACHINES),
    stands=st.tuples(st.floats(-100.0, 100.0), st.floats(-170.0, 170.0)),
    step=st.tuples(st.floats(-30.0, 30.0), st.floats(-90.0, 90.0)),
    inside=st.booleans(),
    placed=st.booleans(),
    off=st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)),
)
def test_where_it_is_said_to_lead_there_the_control_chooses_so(
    name: str,
    stands: tuple[float, float],
    step: tuple[float, float],
    inside: bool,
    placed: bool,
    off: tuple[float, float],
) -> None:
    model = machine(name)
    before = np.array([stands])
    rotary = before + step
    vector = tool_vectors_at(model, rotary)
    shown = np.round(vector, 7)
    deciding = 1 if all(model.axes[column].mount is Mount.PART for column in model.rotary) else 0
    leads = bool(leading_axis_pose_is_planned(model, shown, rotary, before, deciding, np.array([placed]))[0])
    if not placed:  # the vector before may have left an axis a little off
        before = before + np.array([off]) * 1e-5
    event(f"leads: {leads}")
    low, high = np.array([(model.axes[column].low, model.axes[column].high) for column in model.rotary]).T
    assume(not inside or ((rotary >= low).all() and (rotary <= high).all()))
    goes = chosen(model, shown[0], before[0], inside) - rotary[0]
    if leads:
        assert np.abs(goes - 360.0 * np.rint(goes / 360.0)).max() < 0.3


@settings(max_examples=examples(60))
@given(
    name=st.sampled_from(MACHINES),
    stands=st.tuples(st.floats(-60.0, 60.0), st.floats(-170.0, 170.0)),
    step=st.tuples(st.floats(-50.0, 50.0), st.floats(-170.0, 170.0)),
)
def test_the_reader_chooses_as_the_manual_says(
    name: str, stands: tuple[float, float], step: tuple[float, float], tmp_path_factory: pytest.TempPathFactory
) -> None:
    model = machine(name)
    low, high = np.array([(model.axes[column].low, model.axes[column].high) for column in model.rotary]).T
    before = np.round(np.clip(np.array(stands), low, high), 3)
    there = np.clip(before + step, low, high)
    vector = np.round(tool_vectors_at(model, there[None])[0], 9)
    solved = inverse(model, np.zeros((1, 3)), vector[None])
    assume(not solved.pole[0])
    letters = [model.axes[column].name for column in model.rotary]
    words = " ".join(f"{letter}{value:.3f}" for letter, value in zip(letters, before, strict=True))
    program = tmp_path_factory.getbasetemp() / "chosen.nc"
    components = " ".join(f"{letter}{value:.9f}" for letter, value in zip("IJK", vector, strict=True))
    program.write_text(f"O1\nG54 G0 {words}\nG43.5 H1 X0. Y0. Z0.\nG1 {components} F100.\nG49 G53 Z0.\nM30\n")
    run = run_program(program, model)
    assert run.errors == ()
    row = int(np.flatnonzero(run.line == 4)[0])
    stood = run.rotary[row - 1]
    goes, wanted = run.rotary[row] - stood, chosen(model, vector, stood, True) - stood
    # Half a turn is as far either way.
    np.testing.assert_allclose(np.abs(goes), np.abs(wanted), atol=1e-5)
    assert np.abs(np.remainder(goes - wanted + 180.0, 360.0) - 180.0).max() < 1e-5


def test_a_rewind_keeps_its_operation_at_rotary_words_and_the_next_one_at_vectors(folder: Path) -> None:
    model = machine("generic_head_head_ca")
    model = replace(model, axes=tuple(replace(a, low=-200.0, high=200.0) if a.name == "C" else a for a in model.axes))
    angles = np.radians(np.arange(0.0, 600.0, 10.0))
    rows = "".join(
        f"GOTO/{30 * np.cos(a):.4f},{30 * np.sin(a):.4f},5,{0.5 * np.cos(a):.7f},{0.5 * np.sin(a):.7f},0.8660254\n"
        for a in angles
    )
    path = read(HEAD + rows + END + LEANING.replace("OP1", "OP2") + END, folder)
    program = planned(path, model)
    said = [problem for problem in check_program(program) if "rotary positions" in problem.what]
    assert [problem.severity for problem in said] == [Severity.WARNING]
    assert "operation OP1" in said[0].what
    text = proven(path, folder, model, **VECTORS)
    assert re.findall(r"G43\.\d", text) == ["G43.4", "G43.5"]


def test_a_turn_at_the_pole_is_nothing_that_a_vector_says(folder: Path) -> None:
    path = toolpath_of(winding(20.0, 0.0, 90.0, 10))
    program = planned(path, load_machine("matsuura_mx330"))
    motion = next(motion for motion in program.motions if motion.mode is MachiningMode.TCP)
    words = CONTROL.block_words("A", "C", motion.three_axis)
    assert first_row_at_other_pose(program.machine, motion, words) == -1
    upright = motion.rotary.copy()
    upright[5:7, list(program.machine.rotary).index(program.machine.column("A"))] = 0.0
    assert first_row_at_other_pose(program.machine, replace(motion, rotary=upright), words) == 5


def test_words_of_the_reader_for_vectors(tmp_path: Path) -> None:
    model = load_machine("matsuura_mx330")
    program = tmp_path / "p.nc"
    program.write_text(
        "O1\nG54 G0 A-30. C0.\nG43.5 H1 P1 X0. Y0. Z50. I0 J0 K1.\nG1 X10. J.6 K.8 F100.\nG43.4 X11.\n"
        "G49 G53 Z0.\n"
        "G43.5 P2 H1 Z1.\nG49 G53 G0 Z0.\nM30\n"
    )
    run = run_program(program, model)
    assert [(finding.line, str(finding.severity)) for finding in run.diagnostics] == [
        (3, "error"),
        (5, "warning"),
        (7, "error"),
    ]
    assert run.orientation[run.line == 4].tolist() == [Orientation.GREAT_CIRCLE]
    assert run.orientation[run.line == 5].tolist() == [Orientation.ANGLES]
