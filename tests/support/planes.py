"""CL text with tilted planes, on every machine with a Sinumerik."""

from pathlib import Path

from hypothesis import strategies as st

from tests.support.machines import five_axis_machines
from tests.support.posting import FOOT, HEAD
from trunnion.arrays import Floats
from trunnion.cl import read_cl
from trunnion.controls import load_control
from trunnion.errors import InputError
from trunnion.machines import Machine, forward, load_machine
from trunnion.output.families.sinumerik import writer as sinumerik
from trunnion.readers import run_program
from trunnion.verification import ExpectedValues, failures, verify

ANGLES = st.one_of(st.sampled_from([0.0, 90.0, -90.0, 180.0, 45.0]), st.floats(-180.0, 180.0))


def sinumeriks() -> list[str]:
    """Shipped machines with a Sinumerik."""
    found = []
    for name in five_axis_machines():
        try:
            control = load_control(load_machine(name).control)
        except InputError:
            continue
        if control.family is sinumerik:
            found.append(name)
    return found


def reachable(machine: Machine, share: tuple[float, float]) -> Floats:
    """The tool axis at two rotary positions, each a share of what the axis has."""
    joints = machine.home.copy()
    for part, column in zip(share, machine.rotary, strict=True):
        axis = machine.axes[column]
        low, high = (0.0, 360.0) if axis.endless else (axis.low, axis.high)
        joints[column] = low + part * (high - low)
    direction: Floats = forward(machine, joints[None])[1][0]
    return direction


def text_of(axes: list[Floats], tips: list[tuple[float, float, float]]) -> str:
    """CL text of an upright operation, then of one with each of the tool axes."""
    lines = [HEAD + FOOT]
    for n, axis in enumerate(axes):
        head = HEAD.replace("OP1", f"OP{n + 2}").replace("0.0,0.0,1.0\n", ",".join(f"{v:.12f}" for v in axis) + "\n")
        lines.append(head + "".join(f"GOTO/{x:.4f},{y:.4f},{z:.4f}\n" for x, y, z in tips) + FOOT)
    return "".join(lines)


SHARES = st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0))


def proven(lines: list[str], cl: Path, folder: Path) -> list[str]:
    """The keys of the checks that a program fails."""
    nc = folder / "changed.mpf"
    nc.write_text("\n".join(lines) + "\n", encoding="utf-8")
    run = run_program(nc, load_machine("yl569"))
    found = verify(run, [read_cl(cl)], settings=ExpectedValues(work_offset=54, edge=1), columns=False)
    return [check.key for check in failures(found)]
