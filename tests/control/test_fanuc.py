"""Fanuc programs: the whole text of a few, and random operations of all manners written, read back and proven."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from tests.control.test_fidia import END, START, circles, holes_in
from tests.control.test_planes import SHARES, reachable
from tests.machines import at_zero
from tests.plan.test_optimum import short_paths, smooth_paths
from tests.plan.test_read_back import toolpath_of
from trunnion.cl import read_cl
from trunnion.cli.post import planned_program, write
from trunnion.cli.settings import wishes_of
from trunnion.control import load_control
from trunnion.errors import InputError, Refused
from trunnion.machine import Machine, load_machine
from trunnion.reader import run_program
from trunnion.toolpath import Moves, Toolpath
from trunnion.verify import Verification, failures, verify

FANUC = load_machine("matsuura_mx330").control
CONTROL = load_control(FANUC)
MACHINES = [
    "matsuura_mx330",
    "hs664rt",
    "yl569",
    "generic_head_head_ca",
    "generic_head_table_bc",
    "generic_nutated_b45_c",
]
SLOW = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture, HealthCheck.filter_too_much]

#: A word of a block that a whole number would make a thousand times smaller.
POINTLESS = re.compile(r"(?<![A-Z])[XYZABCIJKRF]-?\d+(?![\d.])")


def machine(name: str) -> Machine:
    """A machine with a Fanuc and room for its slides."""
    model = at_zero(name)
    axes = tuple(axis if axis.is_rotary else replace(axis, low=-np.inf, high=np.inf) for axis in model.axes)
    return replace(model, axes=axes, control=FANUC)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("fanuc")


def posted(toolpath: Toolpath, folder: Path, model: Machine, **asked: str) -> tuple[Verification, str]:
    """The proof of the program of a toolpath, and its text."""
    wishes = wishes_of(asked, CONTROL)
    printed = {key: value for key, value in asked.items() if key in CONTROL.settings}
    program, _ = planned_program([toolpath], model, CONTROL, printed, False, wishes)
    target = folder / "part.nc"
    with target.open("wb") as sink:
        claim = write(program, sink, wishes)
    found = verify(run_program(target, model), [toolpath], allowed=claim.allowed, settings=claim.settings)
    return found, target.read_text(encoding="ascii")


def proven(toolpath: Toolpath, folder: Path, model: Machine, **asked: str) -> str:
    """The text of a program that is proven, and has the form that a Fanuc takes."""
    found, text = posted(toolpath, folder, model, **asked)
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]
    lines = text.splitlines()
    assert (lines[0], lines[1][:5], lines[-1]) == ("%", "O0001", "%")
    blocks = [line for line in lines[2:-1] if not line.startswith("(")]
    assert all(re.match(r"N[1-9]\d{1,4} ", line) for line in blocks)
    assert not [line for line in blocks if POINTLESS.search(line)]
    assert not [line for line in blocks if len(re.findall(r"M\d", line)) > 1], "one M word a block"
    # The length goes on and off with a motion to a place of its own, before any plane goes off.
    assert all(" Z" in line for line in blocks if re.search(r"G43|G49", line))
    state = ""
    for line in blocks:
        state = {"G43": "on", "G49": "off"}.get(re.search(r"G4[39]|$", line)[0], state)  # type: ignore[index]
        assert not (state == "on" and re.search(r"G69|G68|M6|G53(?!\.)|M30", line)), line
    return text


def read(text: str, folder: Path) -> Toolpath:
    file = folder / "part.cls"
    file.write_text(text, encoding="utf-8")
    return read_cl(file)


@pytest.mark.parametrize("name", MACHINES)
@settings(max_examples=8, suppress_health_check=SLOW, phases=[Phase.generate])
@given(moves=smooth_paths(60.0) | short_paths(12))
def test_simultaneous_motion_is_proven(name: str, moves: Moves, folder: Path) -> None:
    try:
        text = proven(toolpath_of(moves), folder, machine(name))
    except (Refused, InputError):
        assume(False)
        return
    assert "G43.5" not in text


@pytest.mark.parametrize("name", MACHINES)
@settings(max_examples=6, suppress_health_check=SLOW, phases=[Phase.generate])
@given(moves=smooth_paths(40.0) | short_paths(6))
def test_motion_without_tcp_is_proven(name: str, moves: Moves, folder: Path) -> None:
    model = machine(name)
    model = replace(model, workpiece_zero=(37.0, -21.0, 110.0), tool_length=83.7 if model.turns_tool else None)
    try:
        text = proven(toolpath_of(moves), folder, model, tcp="off", manner="auto")
    except (Refused, InputError):
        assume(False)
        return
    assert "G43.4" not in text


@pytest.mark.parametrize("name", MACHINES)
@settings(max_examples=6, suppress_health_check=SLOW, phases=[Phase.generate])
@given(data=st.data(), shares=st.lists(SHARES, min_size=1, max_size=2))
def test_milling_in_planes_with_circles_is_proven(
    name: str, data: st.DataObject, shares: list[tuple[float, float]], folder: Path
) -> None:
    model = machine(name)
    parts = [data.draw(circles(reachable(model, share))) for share in shares]
    text = "".join(START.replace("OP1", f"OP{k}") + part + END for k, part in enumerate(parts))
    proven(read(text, folder), folder, model)


@pytest.mark.parametrize("name", MACHINES)
@settings(max_examples=6, suppress_health_check=SLOW, phases=[Phase.generate])
@given(data=st.data(), shares=st.lists(SHARES, min_size=1, max_size=3))
def test_holes_of_all_cycles_are_proven(
    name: str, data: st.DataObject, shares: list[tuple[float, float]], folder: Path
) -> None:
    model = machine(name)
    axes = [reachable(model, share) for share in shares]
    text = START + data.draw(holes_in([np.array([0.0, 0.0, 1.0]), *axes])) + END
    proven(read(text, folder), folder, model)
