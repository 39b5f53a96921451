"""Tilted planes right at a limit of a rotary axis: the control must find them within it, for the angles as printed."""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.jobs import post_job
from tests.support.operations import moves_of, operation_of
from trunnion.controls import load_control
from trunnion.jobs.post.expected_values import expectation
from trunnion.jobs.post.planning import plan_program
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import Machine, forward, load_machine
from trunnion.model.toolpath import Frame, LoadTool, SpindleOn, Toolpath
from trunnion.output.coordinates.plane_from_pose import with_plane_inside_limits
from trunnion.output.program_writer import write_program
from trunnion.planning import plan
from trunnion.readers import run_program
from trunnion.verification import failures, verify

NAMES = ("dmu65", "mikron_600u", "ucp800", "yl569")


def machine(name: str) -> Machine:
    """A shipped machine with wide limits of its linear axes."""
    model = load_machine(name)
    axes = tuple(axis if axis.is_rotary else replace(axis, low=-np.inf, high=np.inf) for axis in model.axes)
    return replace(model, axes=axes)


def at_limit(model: Machine, high: bool, first: float, twist: float) -> Toolpath:
    """A cut in a coordinate system square to the tool with the second rotary axis at its limit.

    ``twist`` turns X of that system about the tool, degrees.
    """
    joints = np.zeros((1, 5))
    joints[0, list(model.rotary)] = first, model.axes[model.rotary[1]].high if high else model.axes[model.rotary[1]].low
    z = forward(model, joints)[1][0]
    across = np.cross([0.3, 0.7, 0.2], z)
    across /= np.linalg.norm(across)
    x = np.cos(np.radians(twist)) * across + np.sin(np.radians(twist)) * np.cross(z, across)
    frame = Frame((0.0, 0.0, 0.0), tuple(x.tolist()), tuple(np.cross(z, x).tolist()))
    tip = np.array([[0.0, 0.0, 50.0], [0.0, 0.0, 5.0], [10.0, 5.0, 5.0]])
    upright = moves_of(tip, np.repeat([[0.0, 0.0, 1.0]], 3, axis=0))
    events = LoadTool(0, 1, 1), SpindleOn(0, 2, 1000.0)
    top, side = (
        replace(operation_of(upright, name), events=events, intol=0.01, outtol=0.01) for name in ("TOP", "SIDE")
    )
    return Toolpath("part.cls", (top, replace(side, frame=frame)))


@settings(max_examples=examples(20))
@given(
    st.sampled_from(NAMES),
    st.booleans(),
    st.floats(-180.0, 180.0),
    st.floats(-180.0, 180.0),
    st.sampled_from(["", "vector", "cycle19"]),
)
def test_a_plane_at_a_limit_is_proven(name: str, high: bool, first: float, twist: float, words: str) -> None:
    model = machine(name)
    control = load_control(model.control)
    said = {"plane": words} if words in control.family.PLANE_COMMANDS else {}
    path = at_limit(model, high, first, twist)
    program = plan_program([path], post_job(model, control, parse_plan_options(said, control), said))[0]
    with TemporaryDirectory() as folder:
        file = Path(folder) / "part.nc"
        with file.open("wb") as sink:
            write_program(program, sink)
            expected = expectation(program)
        found = verify(run_program(file, model), [path], tolerances=expected.tolerances, settings=expected.settings)
    assert not failures(found), [(check.key, check.summary) for check in failures(found)]


def test_a_plane_turns_inside_only_where_its_angles_would_lie_beyond() -> None:
    model = machine("mikron_600u")
    turned = []
    for twist in np.linspace(-180.0, 180.0, 37).tolist():
        motion = plan([at_limit(model, True, 20.0, twist)], model, 0.001).motions[1]
        inside = with_plane_inside_limits(model, motion, 4)
        turned.append(inside is not motion)
        off = np.abs(inside.rotary[0] - motion.rotary[0])
        assert off.max() == pytest.approx(1.5e-4 if turned[-1] else 0.0, abs=1e-9)
        joints = np.zeros((1, 5))
        joints[0, list(model.rotary)] = inside.rotary[0]
        axis = forward(model, joints)[1][0]
        assert inside.plane is not None
        assert inside.plane.matrix()[:, 2] == pytest.approx(axis, abs=1e-9)
    assert 0 < sum(turned) < len(turned)
