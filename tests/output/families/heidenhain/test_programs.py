"""Whole Klartext programs: operations in every machining mode, with random settings, read back and proven."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, event, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext import CONTROLS, MODES, OWN, proven
from tests.support.planes import reachable
from trunnion.cl import read_cl
from trunnion.errors import InputError, RefusedError
from trunnion.machines import Machine

START = """TOOL PATH/OP{n},TOOL,D{tool}
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
INTOL/0.01
OUTTOL/0.02
LOAD/TOOL,{tool},ADJUST,1
SPINDL/RPM,{speed},CLW
"""
END = "RAPID\n{back}\nEND-OF-PATH\n"

#: Every setting of what is said in more than one way.
SETTINGS = st.fixed_dictionaries(
    {
        "plane": st.sampled_from(["spatial", "vector", "cycle19"]),
        "plane_move": st.sampled_from(["turn", "move", "stay"]),
        "plane_solution": st.sampled_from(["SEQ", "SYM"]),
        "tcpm": st.sampled_from(["m128", "function"]),
        "orientation": st.sampled_from(["angles", "vector"]),
        "retract": st.sampled_from(["home", "m140"]),
        "rotary_feed": st.sampled_from(["degrees", "tip"]),
        "tcp": st.sampled_from(["on", "on", "off"]),
        "blank": st.sampled_from(["", "extents", "-50,-50,-20,50,50,5.5"]),
        "delta_length": st.sampled_from(["", "0.05", "-1.25"]),
        "delta_radius": st.sampled_from(["", "-0.05"]),
        "work_offset": st.sampled_from(["1", "7"]),
        "disengage": st.sampled_from(["1", "2", "3", "4"]),
        "hsc_mode": st.sampled_from(["", "0"]),
    }
)
KIND = st.sampled_from(["flat", "arc", "holes", "turning"])
SHARE = st.tuples(st.floats(0.01, 0.99), st.floats(0.01, 0.99))
OPERATION = st.tuples(KIND, SHARE, st.sampled_from(MODES), st.integers(1, 3), st.sampled_from([3000, 4500]))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("programs")


def goto(point: np.ndarray, axis: np.ndarray) -> str:
    return "GOTO/" + ",".join(f"{v:.6f}" for v in point) + "," + ",".join(f"{v:.9f}" for v in axis)


def operation(n: int, kind: str, axis: np.ndarray, mode: str, tool: int, speed: int) -> str:
    """One operation: about +Z, or along or about a tilted axis."""
    up = np.array([0.0, 0.0, 1.0])
    lines = ["RAPID"]
    if kind in ("flat", "arc"):
        lines += [goto(np.array([10.0, 0.0, 30.0]), up), "FEDRAT/MMPM,500.0", goto(np.array([10.0, 0.0, 2.0]), up)]
        if kind == "arc":
            lines.append("CIRCLE/0.0,0.0,2.0,0.0,0.0,1.0,10.0,0.06,0.5,10.0,0.0")
        lines.append(goto(np.array([0.0, 10.0, 2.0]), up))
        back = goto(np.array([0.0, 10.0, 30.0]), up)
    elif kind == "holes":
        side = np.cross(axis, [0.6, 0.8, 0.0] if abs(axis[2]) > 0.5 else [0.0, 0.0, 1.0])
        side /= np.linalg.norm(side)
        feed = "MMPR,1.25" if mode.startswith("TAP") else "MMPM,250"
        lines += [goto(25.0 * axis, axis), f"CYCLE/{mode},RAPTO,2.0,FEDTO,-12.0,RTRCTO,4.0,{feed}"]
        lines += [goto(step * side, axis) for step in (0.0, 7.5, -4.0)] + ["CYCLE/OFF"]
        back = goto(25.0 * axis, axis)
    else:
        lean = [up + 0.2 * share * (axis - up) for share in (0.5, 0.75, 1.0)]
        axes = [each / np.linalg.norm(each) for each in lean]
        points = [np.array([8.0 * k, 3.0, 4.0]) for k in range(3)]
        lines += [goto(points[0] + 20.0 * axes[0], axes[0]), "FEDRAT/MMPM,400.0"]
        lines += [goto(point, each) for point, each in zip(points, axes, strict=True)]
        back = goto(points[2] + 20.0 * axes[2], axes[2])
    return START.format(n=n, tool=tool, speed=speed) + "\n".join(lines) + "\n" + END.format(back=back)


def placed(machine: Machine) -> Machine:
    """A machine with wide limits, a known workpiece zero and a known tool length."""
    axes = tuple(
        axis if axis.is_rotary else replace(axis, low=-1e4, high=1e4, home=axis.home or 0.0) for axis in machine.axes
    )
    return replace(machine, axes=axes, workpiece_zero=(3.0, -4.0, 50.0), tool_length=90.0)


@settings(max_examples=examples(20))
@given(name=st.sampled_from(sorted(OWN)), operations=st.lists(OPERATION, min_size=1, max_size=4), said=SETTINGS)
def test_programs_of_all_manners_are_proven_on_every_machine_of_these_controls(
    name: str, operations: list[tuple[str, tuple[float, float], str, int, int]], said: dict[str, str], folder: Path
) -> None:
    machine = placed(OWN[name])
    text = "".join(
        operation(n, kind, reachable(machine, share), mode, tool, speed)
        for n, (kind, share, mode, tool, speed) in enumerate(operations, 1)
    )
    file = folder / "all.cls"
    file.write_text(text, encoding="utf-8")
    try:
        run = proven(read_cl(file), machine, CONTROLS[name], folder, **said).run
    except (RefusedError, InputError) as why:
        event(f"refused: {str(why).split(': ')[-1][:60]}")
        assume(False)
    if said["tcp"] == "off":
        assert not run.tcp.any()
