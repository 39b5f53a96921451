"""Klartext without TCP: axis positions, and an F that gives the tip its programmed feed."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, assume, event, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext import CONTROLS, MACHINES, SIMULTANEOUS, Post, proven, toolpath_of
from tests.support.operations import moves_of
from tests.support.without_tcp import steps
from trunnion.conversion import convert
from trunnion.errors import InputError, RefusedError
from trunnion.machines import Machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.output.coordinates.axis_coordinates import FEED_AT_TIP
from trunnion.readers import run_program
from trunnion.verification import ExpectedValues, Tolerances, failures, verify

#: Tool axes by the pole as well; nearer than 2e-5 four decimals cannot tell.
LEAN = st.one_of(st.floats(-0.6, 0.6), st.floats(-1e-3, 1e-3)).map(lambda v: v if abs(v) > 2e-5 else 0.0)
KINDS = st.lists(st.sampled_from([Kind.LINEAR, Kind.LINEAR, Kind.RAPID]), min_size=4, max_size=4)


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


def placed(machine: Machine) -> Machine:
    """A machine with wide limits, a known workpiece zero and a known tool length."""
    axes = tuple(axis if axis.is_rotary else replace(axis, low=-1e4, high=1e4) for axis in machine.axes)
    return replace(machine, axes=axes, workpiece_zero=(12.0, -7.0, 60.0), tool_length=110.0)


def seconds_by_hand(run: Run, row: int) -> float:
    """What a block takes by its F: all axes as one way."""
    steps = run.joints[row] - run.joints[row - 1]
    return 60.0 * float(np.sqrt((steps**2).sum())) / float(run.feed[row])


@settings(max_examples=examples(25), phases=[Phase.generate])
@given(
    name=st.sampled_from(sorted(MACHINES)),
    path=st.lists(st.tuples(steps, LEAN, LEAN), min_size=2, max_size=4),
    kinds=KINDS,
    tolerance=st.sampled_from([0.001, 0.01, 0.1]),
    rule=st.sampled_from(["degrees", FEED_AT_TIP]),
    feed=st.sampled_from([100.0, 3.0, 5000.0]),
)
def test_whatever_is_planned_without_tcp_is_proven(
    name: str,
    path: list[tuple[tuple[float, float, float], float, float]],
    kinds: list[Kind],
    tolerance: float,
    rule: str,
    feed: float,
    folder: Path,
) -> None:
    machine = placed(MACHINES[name])
    assume(rule != FEED_AT_TIP or not machine.has_rotary_head)
    tip = np.round(np.cumsum([step for step, _, _ in path], axis=0), 4)
    assume(np.linalg.norm(np.diff(tip, axis=0), axis=1).min() > 0.1)
    axis = np.array([[i, j, 1.0] for _, i, j in path])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    kind = np.array([Kind.RAPID, *kinds[1 : len(path)]], np.uint8)
    moves = moves_of(tip, axis)
    moves = replace(moves, kind=kind, feed=np.full(len(moves), feed))
    said = {"tcp": "off", "tip_tolerance": str(tolerance), "rotary_feed": rule}
    try:
        run = proven(toolpath_of(moves), machine, CONTROLS["mikron_600u"], folder, **said).run
    except (RefusedError, InputError):
        event("refused")
        assume(False)
    turning = np.abs(np.diff(run.joints[:, list(machine.rotary)], axis=0)).max(axis=1, initial=0.0) > 1e-9
    cuts = 1 + np.flatnonzero(turning & (run.kind[1:] == Kind.LINEAR))
    event(f"blocks that turn: {len(cuts) > 0}")
    assert not run.tcp.any()
    if rule == FEED_AT_TIP:
        assert (run.feed[run.kind == Kind.LINEAR] == feed).all()
        return
    for row in cuts.tolist():
        way = float(np.linalg.norm(run.tip[row] - run.tip[row - 1]))
        if way > 0.05 and run.feed[row] < 99999.0:  # rounding is no small part of it; no F is greater
            assert seconds_by_hand(run, row) == pytest.approx(60.0 * way / feed, rel=0.02)


def test_a_program_without_tcp_says_for_what_it_is_made_and_what_f_counts(post: Post) -> None:
    given = [text for one in ("tcp=off", "zero=0,0,100", "tool_length=80") for text in ("--set", one)]
    blocks = post(SIMULTANEOUS, *given)
    begin = blocks.index("; without TCP, for a workpiece zero at X0 Y0 Z100 of the machine")
    assert blocks[begin + 1 : begin + 3] == ["; and a tool length of 80", "M129"]
    assert not any(block.startswith(("M128", "M116", "M117")) for block in blocks)
    assert blocks.index("M126") < blocks.index("M3") < blocks.index("M5") < blocks.index("M127")
    turning = [
        block for block in blocks if block.startswith("L ") and " F" in block and (" A" in block or " C" in block)
    ]
    feeds = [float(block.split(" F")[1]) for block in turning if "FMAX" not in block]
    assert len(set(feeds)) > 1
    assert 500.0 not in feeds
    blocks = post(SIMULTANEOUS, *given, "--set", "rotary_feed=tip")
    assert blocks.index("M126") + 1 == blocks.index("M116")
    assert blocks.index("M117") + 1 == blocks.index("M127")
    assert len([block for block in blocks if " F" in block and "FMAX" not in block]) == 1


def test_a_head_has_no_m116(post: Post) -> None:
    machine = post.folder / "head.toml"
    machine.write_text(
        'extends = "generic_head_table_bc"\n[control]\nextends = "heidenhain_tnc640"\n', encoding="utf-8"
    )
    given = [text for one in ("tcp=off", "zero=0,0,0", "tool_length=80", "rotary_feed=tip") for text in ("--set", one)]
    code, out, err = post.all(SIMULTANEOUS, *given, machine=str(machine))
    assert (code, out) == (2, "")
    assert "leaves out the turns of B in the head" in err


@settings(max_examples=examples(8), phases=[Phase.generate])
@given(name=st.sampled_from(sorted(MACHINES)), share=st.sampled_from([0.5, 0.98, 1.03, 2.0]), at=st.floats(0.0, 0.999))
def test_another_f_in_any_block_that_turns_is_found(name: str, share: float, at: float, folder: Path) -> None:
    machine = placed(MACHINES[name])
    tip = np.array([[0.0, 0.0, 5.0], [20.0, 3.0, 4.0], [40.0, 0.0, 5.0]])
    axis = np.array([[0.1, 0.0, 1.0], [0.2, 0.1, 1.0], [0.25, 0.2, 1.0]])
    moves = moves_of(tip, axis / np.linalg.norm(axis, axis=1)[:, None])
    toolpath = toolpath_of(moves)
    proven(toolpath, machine, CONTROLS["mikron_600u"], folder, tcp="off")
    file = folder / "part.h"
    lines = file.read_text(encoding="utf-8").split("\n")
    said = [k for k, line in enumerate(lines) if re.search(r" F[0-9.]+$", line)]
    k = said[int(at * len(said))]
    lines[k] = re.sub(r" F([0-9.]+)$", lambda f: f" F{share * float(f[1]):.3f}", lines[k])
    file.write_text("\n".join(lines), encoding="utf-8")
    asked, allowed = ExpectedValues(span=0.05, span_tip=0.005), Tolerances(tip=2e-4, angle=2e-4, feed=0.001)
    found = verify(run_program(file, machine), [toolpath], tolerances=allowed, settings=asked)
    assert [check.key for check in failures(found)] == ["feed"]


@settings(max_examples=examples(6), phases=[Phase.generate])
@given(name=st.sampled_from(sorted(MACHINES)), feed=st.floats(20.0, 3000.0).map(lambda f: round(f, 1)))
def test_on_the_way_back_the_tip_has_the_feed_that_was_asked_for(name: str, feed: float, folder: Path) -> None:
    """Converted to a CL file again."""
    machine, control = placed(MACHINES[name]), CONTROLS["mikron_600u"]
    tip = np.array([[0.0, 0.0, 5.0], [20.0, 3.0, 4.0], [40.0, 0.0, 5.0]])
    axis = np.array([[0.1, 0.0, 1.0], [0.2, 0.1, 1.0], [0.25, 0.2, 1.0]])
    moves = moves_of(tip, axis / np.linalg.norm(axis, axis=1)[:, None])
    moves = replace(moves, feed=np.full(3, feed))
    run = proven(toolpath_of(moves), machine, control, folder, tcp="off").run
    (operation,) = convert(run, control).toolpath.operations
    cuts = operation.moves.kind != Kind.RAPID
    assert cuts.any()
    assert operation.moves.feed[cuts] == pytest.approx(feed, rel=2e-3)
