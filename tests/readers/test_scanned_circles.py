"""Plain circles that the scan reads, against the interpreter; it must read them alike, and leave odd ones to it."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.run_comparison import same
from trunnion.machines import Machine, load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.readers.families.fanuc.interpreter import FanucInterpreter
from trunnion.readers.families.linuxcnc.interpreter import LinuxcncInterpreter
from trunnion.readers.families.sinumerik.interpreter import SinumerikInterpreter
from trunnion.readers.program.interpreter import Interpreter

#: A machine, the reader of its programs, and what stands before its circles.
CONTROLS: dict[str, tuple[Machine, type[Interpreter[Any]], str]] = {
    "sinumerik": (load_machine("yl569"), SinumerikInterpreter, "G54 D1\n"),
    "fanuc": (load_machine("matsuura_mx330"), FanucInterpreter, "G90 G54 G43 H1\n"),
    "linuxcnc": (load_machine("xyzac_trt"), LinuxcncInterpreter, "G90 G54\n"),
}
PLANES = {"G17": (0, 1), "G18": (2, 0), "G19": (1, 2)}
MODES = {
    "sinumerik": ["TRAORI", "TRAFOOF", "TRANS X5 Y-3", "AROT Z30", "SCALE X2", "SCALE X2 Y2 Z2", "MIRROR X0", "G70",
                  "G71", "CT", "CIP", "G41", "G40", "C=45", "B10", "G1 X1 RND=1", "RNDM=2", "RNDM=0"],
    "fanuc": ["G43.4 H1", "G49", "G68 X0. Y0. R30.", "G69", "G51.1 X0.", "G50.1 X0.", "G20", "G21", "G52 X4.", "C45.",
              "B10.", "G43.5 H1", "G16", "G15", "G81 R1. Z-1.", "G80"],
    "linuxcnc": ["M428", "M429", "G92 X4", "G92.1", "G10 L2 P1 R30", "G20", "G21", "C45", "A10", "G90.1", "G91.1",
                 "G80", "G81 R1 Z-1"],
}  # fmt: skip

#: What may stand between circles on all of them.
BETWEEN = ("G1 X3. Y4. Z1.", "G1 C30.", "G1 X1. C20.", "G0", "Z2.", "F50.", "S9", "G3 I1.", "G2", "G3 X1. Y1. R9.")


def twice(path: Path, machine: Machine, interpreter: type[Interpreter[Any]]) -> tuple[Run, Run]:
    """Run a program with the scan, which is tried at every line, and without."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("trunnion.readers.program.interpreter._LINES_WITHOUT_SCAN", 0)
        fast = run_program(path, machine)
        patch.setattr(interpreter, "_may_scan", lambda *_: False)
        return fast, run_program(path, machine)


def circle(plane: str, places: list[int], turn: str, helix: int) -> Callable[[dict[str, float]], str]:
    """Return what writes a circle from a position, which it changes: its centre, and one of the points around it."""

    def write(position: dict[str, float]) -> str:
        u, v = ("XYZ"[axis] for axis in PLANES[plane])
        i, j = ("IJK"[axis] for axis in PLANES[plane])
        across = next(name for name in "XYZ" if name not in (u, v))
        way, off, error = (place / 1000.0 for place in places)
        angle = math.radians(7.0 * helix)
        end_u = position[u] + way - (way * math.cos(angle) - off * math.sin(angle)) + error
        end_v = position[v] + off - (way * math.sin(angle) + off * math.cos(angle))
        position[u], position[v] = round(end_u, 3), round(end_v, 3)
        words = [f"{turn} {u}{position[u]:.3f} {v}{position[v]:.3f}"]
        if helix % 3 == 1:
            position[across] = round(position[across] + 0.5, 3)
            words.append(f"{across}{position[across]:.3f}")
        return " ".join((*words, f"{i}{way:.3f} {j}{off:.3f}"))

    return write


numbers = st.one_of(st.integers(-30000, 30000), st.integers(-30, 30))
errors = st.sampled_from([0, 0, 0, 1, 3, 6, 9, 30, 600])


@pytest.mark.parametrize("family", CONTROLS)
@settings(deadline=None, max_examples=examples(60), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_circles_are_read_alike(family: str, tmp_path: Path, data: st.DataObject) -> None:
    machine, interpreter, begin = CONTROLS[family]
    plane = data.draw(st.sampled_from(sorted(PLANES)))
    lines, position = [plane, "G1 X0. Y0. Z0. F100."], dict.fromkeys("XYZ", 0.0)
    for _ in range(data.draw(st.integers(1, 6))):
        if data.draw(st.integers(0, 3)) == 0:
            lines.append(
                data.draw(st.sampled_from([*MODES[family], "G1 X3. Y4. Z1.", "G0", "Z2.", "F50.", "S9", "G3 I1."]))
            )
        places = [data.draw(numbers), data.draw(numbers), data.draw(errors)]
        turn = data.draw(st.sampled_from(["G2", "G3", "", "G03 F9."]))
        lines.append(circle(plane, places, turn, data.draw(st.integers(-3, 60)))(position))
    path = tmp_path / "p.nc"
    path.write_text(begin + "\n".join(lines) + "\n")
    fast, slow = twice(path, machine, interpreter)
    assert sorted(map(str, fast.diagnostics)) == sorted(map(str, slow.diagnostics))
    same(replace(fast, diagnostics=()), replace(slow, diagnostics=()))


@pytest.mark.parametrize("family", CONTROLS)
def test_plain_circles_need_no_interpreter(family: str, tmp_path: Path) -> None:
    machine, interpreter, begin = CONTROLS[family]
    path = tmp_path / "p.nc"
    turns = "G3 X10. Y0. I5. J0.\nX0. Y0. I-5. J0.\n" * 200
    path.write_text(f"{begin}G17\nG1 X0. Y0. Z0. F100.\n{turns}M30\n")
    lines: list[int] = []
    with pytest.MonkeyPatch.context() as patch:
        execute = interpreter._execute_line

        def counted(self: Interpreter[Any], active: Any, line: int, raw: str) -> None:
            lines.append(line)
            execute(self, active, line, raw)

        patch.setattr(interpreter, "_execute_line", counted)
        run = run_program(path, machine)
    assert len(run.arcs.row) == 400
    assert len(lines) < 10


@pytest.mark.parametrize("family", CONTROLS)
def test_a_turn_behind_circles_leaves_them_where_they_were(family: str, tmp_path: Path) -> None:
    machine, interpreter, begin = CONTROLS[family]
    path = tmp_path / "p.nc"
    turns = "G3 X10. Y0. I5. J0.\nX0. Y0. I-5. J0.\n" * 20
    path.write_text(f"{begin}G17\nG1 X0. Y0. Z0. F100.\n{turns}G1 C30.\n{turns}G1 X5. Y1. C50.\nX0. Y0.\n{turns}")
    fast, slow = twice(path, machine, interpreter)
    same(fast, slow)
    assert len(fast.arcs.row) == 120
