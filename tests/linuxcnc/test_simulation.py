"""One CL file, posted with TCP and without, on a whole LinuxCNC with simulated joints."""

from pathlib import Path

import numpy as np
import pytest

from tests.support.linuxcnc.simulator import Bench, motions, needs_simulator, rests_of, with_rests
from trunnion.cli import main
from trunnion.machines import load_machine, slide_positions

LENGTH = 80.0
ZERO = (12.0, -7.5, -40.0)

BENCHES = {
    "xyzac_trt": Bench("xyzac-trt-kins", {"y-offset": 20.0, "z-offset": 10.0}, "XYZAC", ZERO, LENGTH),
    "xyzbc_trt": Bench("xyzbc-trt-kins", {"x-offset": -20.0, "z-offset": -15.0}, "XYZBC", ZERO, LENGTH),
}


def points() -> tuple[np.ndarray, np.ndarray]:
    """A tip that goes round, and a tool axis that leans and turns with it; then a fixed tilt."""
    t = np.linspace(0.0, 1.0, 12)
    tip = np.column_stack((20 * np.cos(4 * t), 20 * np.sin(4 * t), 10 * t))
    lean, turn = 0.2 + 0.4 * t, 0.3 + 3.0 * t
    axis = np.column_stack((np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)))
    return np.round(tip, 4), np.round(axis / np.linalg.norm(axis, axis=1)[:, None], 9)


def cl_text() -> str:
    tip, axis = points()
    rows = [
        f"GOTO/{x:.4f},{y:.4f},{z:.4f},{i:.9f},{j:.9f},{k:.9f}" for (x, y, z), (i, j, k) in zip(tip, axis, strict=True)
    ]
    return "\n".join(
        [
            "TOOL PATH/ROUND,TOOL,D6",
            "TLDATA/MILL,6.0,3.0,75.0,0.0,0.0",
            "MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0",
            "INTOL/0.005",
            "OUTTOL/0.005",
            "LOAD/TOOL,1",
            "SPINDL/RPM,3000,CLW",
            "RAPID",
            rows[0],
            "FEDRAT/MMPM,6000.0",
            *rows[1:],
            "END-OF-PATH",
            "",
        ]
    )


@needs_simulator
@pytest.mark.nightly  # the controller moves in real time
@pytest.mark.parametrize("name", ["xyzbc_trt"])
def test_with_tcp_and_without_the_machine_comes_to_the_same_joints_at_every_block_end(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """Without TCP no points are put in between, for the tolerances are wide: the blocks are the same ones."""
    (tmp_path / "part.cls").write_text(cl_text())
    zero = ",".join(str(value) for value in ZERO)
    given = ["--machine", name, f"--set=zero={zero}", f"--set=tool_length={LENGTH}"]
    wide = ["--set=tcp=off", "--set=tip_tolerance=10", "--set=axis_tolerance=10"]
    programs = []
    for file, extra in (("with.ngc", []), ("without.ngc", wide)):
        assert main(["post", str(tmp_path / "part.cls"), *given, *extra, "--output", str(tmp_path / file)]) == 0
        programs.append((tmp_path / file).read_text())
    capfd.readouterr()
    assert "M428" in programs[0]
    assert "M428" not in programs[1]
    run = motions(BENCHES[name], [with_rests(program) for program in programs])
    # No joint jumps, as it would where a tool length changes under TCP; motions make tenths of a mm in a millisecond.
    assert max(np.abs(np.diff(joints, axis=0)).max() for joints in run) < 1.0
    held, led = map(rests_of, run)
    assert held.shape == led.shape
    np.testing.assert_allclose(held, led, atol=1e-4, rtol=0)
    # and these are the joints of the points, by our own chain
    machine = load_machine(name, {"workpiece": {"zero_mm": list(ZERO)}})
    order = [BENCHES[name].letters.index(axis.name) for axis in machine.axes]
    joints = held[:, order]
    tip, _ = points()
    ours = slide_positions(machine, tip, joints[-len(tip) - 2 : -2][:, list(machine.rotary)], LENGTH)
    np.testing.assert_allclose(joints[-len(tip) - 2 : -2], ours, atol=1e-4, rtol=0)


def test_a_jump_of_the_tool_length_is_no_end_of_a_motion() -> None:
    """Joints that a length under TCP has moved at once stand until the next block is read: longer under load."""
    speed = np.concatenate((np.linspace(0.0, 0.3, 60), np.linspace(0.3, 0.0, 60)))
    way = np.cumsum(speed)
    jumped = way[-1] + np.array([2.6, 13.2, 15.9])
    for stands in (3, 30):
        one = np.concatenate((np.zeros(20), way, np.full(20, way[-1]), jumped, np.full(stands, jumped[-1])))
        joint = np.concatenate((one, jumped[-1] + way, np.full(20, jumped[-1] + way[-1])))
        found = rests_of(np.column_stack((joint, *np.zeros((4, len(joint))))))
        np.testing.assert_allclose(found[:, 0], [0.0, way[-1], jumped[-1] + way[-1]])
