"""A four-axis program on a whole LinuxCNC with plain axes (trivkins): its joints are those that our reader says."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.linuxcnc.simulator import Bench, motions, needs_simulator, rests_of, with_rests
from tests.support.locations import GOLDEN
from trunnion.machines import load_machine
from trunnion.readers import run_program

ZERO = (-200.0, -90.0, -120.0)
LENGTH = 60.0
BENCH = Bench("trivkins", {}, "XYZA", ZERO, LENGTH)

#: Lines of the program that run: a flat and turns to others, and a part of the winding groove with its inverse time.
LINES = (slice(0, 90), slice(208, 250))


@needs_simulator
@pytest.mark.nightly  # the controller moves in real time
def test_the_controller_takes_each_joint_where_our_reader_says(tmp_path: Path) -> None:
    lines = (GOLDEN / "four_axis" / "roller.expected.ngc").read_text(encoding="utf-8").splitlines()
    program = "\n".join([line for part in LINES for line in lines[part]] + ["G94", "M2"]) + "\n"
    assert "G93" in program
    (tmp_path / "part.ngc").write_text(program, encoding="utf-8")
    machine = replace(load_machine("desk_mill_a", {"workpiece": {"zero_mm": list(ZERO)}}), tool_length=LENGTH)
    run = run_program(tmp_path / "part.ngc", machine)
    assert not run.errors
    columns = [next(k for k, axis in enumerate(machine.axes) if axis.name == letter) for letter in BENCH.letters]
    wanted = run.positions(np.arange(len(run))).joints[:, columns]
    moves = np.abs(np.diff(wanted, axis=0)).max(axis=1) > 1e-6
    (joints,) = motions(BENCH, [with_rests(program)], 200.0)
    found = rests_of(joints)
    np.testing.assert_allclose(found, wanted[np.concatenate(([True], moves))], atol=1e-4, rtol=0)
    assert np.ptp(found[:, 3]) > 30.0
