"""Correct programs that are hard to match with their CL points: each of these once failed."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.jobs import post_job
from tests.support.operations import moves_of, operation_of
from tests.support.posting import FOOT, HEAD
from tests.support.without_tcp import machine, post, toolpath
from trunnion.cl import read_cl
from trunnion.controls import load_control
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import load_machine
from trunnion.model.toolpath import Kind
from trunnion.output.program_writer import write_program
from trunnion.planning import PlanOptions
from trunnion.readers import run_program
from trunnion.verification import Check, failures, verify

START = HEAD.partition("RAPID")[0]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("alignment")


def failed(text: str, name: str, folder: Path) -> list[Check]:
    """The checks that the program of a CL file fails on a shipped machine."""
    cl, nc = folder / "part.cls", folder / "part.nc"
    cl.write_text(text, encoding="utf-8")
    model = load_machine(name)
    control = load_control(model.control)
    program = plan_program([read_cl(cl)], post_job(model, control, parse_plan_options({}, control), {}))[0]
    with nc.open("wb") as sink:
        write_program(program, sink)
        expected = expectation(program)
    found = verify(run_program(nc, model), [read_cl(cl)], tolerances=expected.tolerances, settings=expected.settings)
    return failures(found)


def test_operations_are_matched_each_within_its_own_limits(folder: Path) -> None:
    """The second operation is in a plane, where half a digit is a larger error than in the first."""
    upright = "RAPID\nGOTO/0,0,20,0,0,1\nFEDRAT/MMPM,800\nGOTO/0,0,0\nGOTO/5,0,0\n"
    lean = "0.0,-0.292371704723,0.956304755963"
    helix = (
        f"RAPID\nGOTO/0,-5.847434,20.626095,{lean}\nFEDRAT/MMPM,800\nGOTO/0,0,1.5\n"
        "CIRCLE/0.301425,-0.911827,1.221227,0.0,0.292371704723,-0.956304755963,1.0,0.06,0.5,6.0,0.0\n"
        "GOTO/0.940899,-1.638465,6.227530\n"
    )
    assert failed(START + upright + FOOT + START.replace("OP1", "OP2") + helix + FOOT, "hs664rt", folder) == []


@settings(max_examples=examples(20))
@given(
    name=st.sampled_from(["hs664rt", "dmu65", "yl569", "xyzac_trt"]),
    rise=st.sampled_from([0.0, 9e-6, 1.1e-5, 1e-4, 1e-3, 0.01]),
    angle=st.sampled_from([0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, -1e-7, -1e-6, -1e-5, -1e-4, -1e-3]),
    turns=st.sampled_from(["", ",TIMES,1", ",TIMES,3"]),
    radius=st.sampled_from([1.0, 30.0]),
)
def test_circles_that_close_nearly_and_rise_hardly_are_proven(
    name: str, rise: float, angle: float, turns: str, radius: float, folder: Path
) -> None:
    end = f"{radius * math.cos(angle):.8f},{radius * math.sin(angle):.8f}"
    arc = f"CIRCLE/0.0,0.0,5.0,0.0,0.0,1.0,{radius:.7f},0.06,0.5,10.0,0.0{turns}\nGOTO/{end},{5.0 + rise:.8f}\n"
    start = f"RAPID\nGOTO/{radius},0.0,50.0,0.0,0.0,1.0\nFEDRAT/MMPM,500.0\nGOTO/{radius},0.0,5.0\n"
    assert failed(START + start + arc + f"RAPID\nGOTO/{end},50.0\n" + FOOT, name, folder) == []


#: Tips, and tool axes as they lean in X and Y, very near the pole and far from it.
NEAR_POLE = [
    (
        [[14.98734, -12.15472, 19.25685], [17.04214, -24.73153, 2.89901], [-0.11883, -19.25284, 8.04253],
         [11.35148, -12.90824, 8.81868]],
        [[0.0, -1e-7], [2e-7, 1e-7], [0.186300158, 0.365358808], [5e-7, -4e-7]],
    ),
    (
        [[-16.46276, -0.77432, 17.7083], [-33.97413, -18.92853, 1.8323]],
        [[0.0362267, 0.1298159], [-9.10874e-8, 2.70392e-8]],
    ),
]  # fmt: skip


@pytest.mark.parametrize(("tip", "lean"), NEAR_POLE)
@pytest.mark.parametrize("name", ["generic_nutated_b45_c", "generic_head_head_ca", "dmu65"])
def test_where_rotary_axes_turn_and_the_tool_hardly_moves_the_right_block_is_taken(
    name: str, tip: list[list[float]], lean: list[list[float]]
) -> None:
    axis = np.column_stack((np.array(lean), np.ones(len(lean))))
    moves = moves_of(np.array(tip), axis / np.linalg.norm(axis, axis=1)[:, None])
    kind = np.array([Kind.RAPID, *[Kind.LINEAR] * (len(tip) - 1)], np.uint8)
    done = post(machine(name), toolpath(operation_of(replace(moves, kind=kind))), PlanOptions(tcp=False))
    assert not any(problem.severity.value == "error" for problem in done.plan.problems)
    assert failures(done.found) == []


@pytest.mark.parametrize("repeats", [1, 2])
@pytest.mark.parametrize("name", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt"])
def test_a_whole_circle_is_not_the_repeated_point_before_it(name: str, repeats: int, folder: Path) -> None:
    """The circle ends where it starts, and the CL file has its start twice; another point prints as the one before."""
    circle = "CIRCLE/{},0,0,0,0,1,{},0.06,0.5,10.0,0.0\nGOTO/0,0,0\n"
    path = (
        "RAPID\nGOTO/0,0,20,0,0,1\nFEDRAT/MMPM,800\nGOTO/0,0,0\n"
        + circle.format(4, "4")
        + "GOTO/0,0,0\n" * repeats
        + circle.format(6, "6")
        + "GOTO/5,0,0\nGOTO/5.00001,0,0\nRAPID\nGOTO/5,0,20\n"
    )
    assert failed(START + path + FOOT, name, folder) == []
