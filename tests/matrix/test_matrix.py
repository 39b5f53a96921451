"""Every control on every shipped machine: families of paths, written, read back and proven.

A path is proven, or refused for the reason in ``expected``. A control that is not named there may refuse any path, as
long as it gives a reason and leaves no program.
"""

import io
import math
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from tests.matrix.expected import FAMILIES, PAGE, REFUSED, SOMETIMES, WITHOUT_TCP, page
from tests.matrix.paths import CYCLES, cycles, holes, off_the_pole
from trunnion.api.settings import apply_setup
from trunnion.arrays import Floats
from trunnion.cl import read_cl
from trunnion.cli import main
from trunnion.controls import Control, control_library, load_control
from trunnion.families import FAMILIES as CONTROL_FAMILIES
from trunnion.families import load_writer
from trunnion.machines import Machine, load_machine, shipped_machines
from trunnion.model.motion import MachiningMode
from trunnion.model.run import Run
from trunnion.model.toolpath import CycleOn
from trunnion.readers import run_program

CONTROLS = sorted(
    entry.name.removesuffix(".toml") for entry in control_library().iterdir() if entry.name.endswith(".toml")
)

#: Each example is another path; the first one of Hypothesis is the simplest there is.
FEW = settings(
    max_examples=3, derandomize=True, database=None, phases=[Phase.explicit, Phase.generate],
    suppress_health_check=list(HealthCheck),
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Pair:
    """A shipped machine with a control of the library, in a file of its own."""

    name: str
    file: Path
    machine: Machine
    control: Control

    @property
    def family(self) -> str:
        """Of controls, by the first of its names in definitions; one that refuses more than its family is its own."""
        first = next(key for key in CONTROL_FAMILIES if load_writer(key) is self.control.family)
        return self.name if self.name in REFUSED else first

    @property
    def settings(self) -> tuple[str, ...]:
        """Settings that the pair needs: positions without TCP; other words for the TCP of a head on a Fidia."""
        if not self.control.tcp:
            return WITHOUT_TCP[1:]
        heads = [axis for axis in self.machine.axes if axis.is_rotary and axis.mount.value == "tool"]
        return ("tcp_on=G96", "tcp_off=G97") if heads and self.family == "fidia_nc15" else ()

    @property
    def folds(self) -> bool:
        """Whether an axis shows values within one turn, and the control has no word for the shorter way."""
        shown = [self.machine.axes[column].display_low for column in self.machine.rotary]
        return not np.isnan(shown).all() and "primary_shortest" not in self.control.family.WORDS


@dataclass(frozen=True, eq=False)
class Posted:
    """The result of posting a CL file; no program: it was refused."""

    code: int
    err: str
    cl: Path
    program: Path

    @property
    def failed(self) -> list[str]:
        return [line for line in self.err.splitlines() if line.split()[1:2] == ["FAIL"]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("matrix")


def pair_of(control: str, name: str, folder: Path) -> Pair:
    """The definition of a pair, with wide limits of the linear axes."""
    file = folder / f"{name}_{control}.toml"
    if not file.exists():
        slides = [axis.name for axis in load_machine(name).axes if not axis.is_rotary]
        room = "".join(f'[[axis]]\nname = "{slide}"\nlimits_mm = [-3000, 3000]\n' for slide in slides)
        file.write_text(f'extends = "{name}"\n[control]\nextends = "{control}"\n{room}', encoding="utf-8")
    machine = load_machine(file)
    return Pair(control, file, machine, load_control(machine.control))


def posted(text: str, pair: Pair, folder: Path, settings: Sequence[str]) -> Posted:
    """Post a CL file: the result is a proven program, or none and a reason."""
    cl, program, err = folder / "part.cls", folder / "part.nc", io.StringIO()
    cl.write_text(text, encoding="utf-8")
    program.unlink(missing_ok=True)
    said = [word for setting in (*settings, *pair.settings) for word in ("--set", setting)]
    with redirect_stderr(err), redirect_stdout(io.StringIO()):
        code = main(["post", str(cl), "--machine", str(pair.file), "--output", str(program), *said])
    return Posted(code, err.getvalue(), cl, program)


def check_proven(done: Posted, pair: Pair, settings: Sequence[str]) -> None:
    """Every check has passed, and every CL point that is not a hole is met, by a search of this test."""
    assert (done.code, done.failed) == (0, []), done.err
    assert sum(line.split()[1:2] == ["ok"] for line in done.err.splitlines()) >= 15
    machine = apply_setup(pair.machine, dict(setting.split("=") for setting in (*pair.settings, *settings)))
    check_met(run_program(done.program, machine), done.cl, *half_digits(pair))


def half_digits(pair: Pair) -> tuple[float, float]:
    """Half the last digit of positions, with the effect of half the last digit of angles, mm; and the latter, rad."""
    formats = [pair.control.number_formats(three_axis) for three_axis in (False, True)]
    place = 0.5 * 10.0 ** -min(each["coordinate"].decimals for each in formats)
    angles = [each[name].decimals for each in formats for name in ("angle", "plane_angle") if name in each]
    angle = math.radians(3.0 * 0.5 * 10.0 ** -min(angles))  # a plane has three of them
    return (1.0 + math.sqrt(3.0)) * place + 200.0 * angle, angle + 1e-6


def check_met(run: Run, cl: Path, allowed: float, turned: float) -> None:
    """Points are met in order, each within what is allowed; without the planner and the proof."""
    at = 0
    for operation in read_cl(cl).operations:
        if any(isinstance(event, CycleOn) for event in operation.events):
            continue
        for point, axis in zip(operation.moves.tip, operation.moves.axis, strict=True):
            near = met(run.tip[at:], point, allowed) & met(run.axis[at:], axis, turned)
            assert near.any(), f"nothing goes to {point} under {axis} after row {at}"
            at += int(np.argmax(near))


def met(column: Floats, wanted: Floats, allowed: float) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    return np.asarray((np.abs(column - wanted) <= allowed).all(axis=1))


def check_refused(done: Posted, reason: str) -> None:
    """There is a reason with a cure and no program; it was not the proof that refused it."""
    assert done.code in (1, 2), done.err
    assert not done.program.exists()
    errors = [line for line in done.err.splitlines() if ": error: " in line]
    assert any(reason in line and "; " in line for line in errors), done.err
    assert done.failed == []


@pytest.mark.parametrize("path", FAMILIES)
@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("name", shipped_machines())
def test_every_control_moves_every_machine(name: str, control: str, path: str, folder: Path) -> None:
    pair = pair_of(control, name, folder)
    family, asked = FAMILIES[path]

    @FEW
    @given(st.composite(family)(pair.machine))
    def every(text: str) -> None:
        done = posted(text, pair, folder, asked)
        reasons = REFUSED.get(pair.family)
        if reasons is not None and path in reasons and not (path.startswith("simultaneous") and stands(text, pair)):
            check_refused(done, reasons[path])
        elif done.code and (reasons is None or (path in SOMETIMES and pair.folds)):
            check_refused(done, SOMETIMES.get(path, "") if reasons is not None else "")
        else:
            check_proven(done, pair, asked)

    every()


def stands(text: str, pair: Pair) -> bool:
    """Whether the tool axis of a cut is the same throughout, so that it is made in a plane, where there are any."""
    axes = {tuple(line.split(",")[3:]) for line in text.splitlines() if line.startswith("GOTO") and line.count(",") > 2}
    return len(axes) == 1 and MachiningMode.TILTED in pair.control.modes({})


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("name", shipped_machines())
def test_all_cycles_that_a_control_has_are_proven(name: str, control: str, folder: Path) -> None:
    pair = pair_of(control, name, folder)
    refused = REFUSED.get(pair.family)
    if refused is None:
        refused = {mode: "" for mode in CYCLES if posted(simplest(mode), pair, folder, ()).code}

    @FEW
    @given(st.composite(cycles([mode for mode in CYCLES if mode not in refused]))(pair.machine))
    def every(text: str) -> None:
        check_proven(posted(text, pair, folder, ()), pair, ())

    every()


def simplest(mode: str) -> str:
    """A CL file with two holes of a cycle."""
    return holes([mode], [(0.0, 0.0, 0.0, 0.0)])


@pytest.mark.parametrize("mode", CYCLES)
@pytest.mark.parametrize("control", CONTROLS)
def test_cycles_are_refused_for_the_reason_that_is_said(control: str, mode: str, folder: Path) -> None:
    pair = pair_of(control, "generic_head_table_bc", folder)
    done, reasons = posted(simplest(mode), pair, folder, ()), REFUSED.get(pair.family)
    if done.code or (reasons is not None and mode in reasons):
        assert reasons is None or mode in reasons, done.err
        check_refused(done, reasons[mode] if reasons is not None else "")


@pytest.mark.parametrize("control", ["heidenhain_tnc640", "linuxcnc", "sinumerik_840d"])
@pytest.mark.parametrize(
    "name", [name for name in shipped_machines() if load_machine(name).has_rotary_head] + ["dmu65", "yl569"]
)
def test_where_a_head_turns_the_tool_a_program_without_tcp_is_for_one_length(
    name: str, control: str, folder: Path
) -> None:
    pair, zero = pair_of(control, name, folder), "10,-20,30"
    check = ["verify", str(folder / "part.nc"), "--cl", str(folder / "part.cls"), "--machine", str(pair.file)]

    def verified(length: float) -> bool:
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            return main([*check, "--zero", zero, "--span", "0.06", "--tool-length", str(length)]) == 0

    @FEW
    @given(st.composite(off_the_pole)(pair.machine), st.floats(10.0, 300.0), st.floats(20.0, 90.0))
    def every(text: str, length: float, more: float) -> None:
        asked = "tcp=off", f"zero={zero}", f"tool_length={length:.3f}"
        check_proven(posted(text, pair, folder, asked), pair, asked)
        assert verified(round(length, 3))
        assert verified(round(length + more, 3)) != (pair.machine.has_rotary_head and not stands(text, pair))

    every()


def test_the_page_says_what_is_refused() -> None:
    assert PAGE.read_text(encoding="utf-8") == page()
