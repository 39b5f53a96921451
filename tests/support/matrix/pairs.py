"""A control on a machine: programs posted for the pair, and what they must do."""

import io
import math
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck, Phase, settings

from tests.support.matrix.expected import REFUSED, WITHOUT_TCP
from tests.support.matrix.paths import holes
from trunnion.arrays import Floats
from trunnion.cl import read_cl
from trunnion.cli import main
from trunnion.controls import Control, control_library, load_control
from trunnion.controls.definition_files import load_control_table
from trunnion.families import FAMILIES as CONTROL_FAMILIES
from trunnion.families import load_writer
from trunnion.jobs.inputs.stated_setup import apply_setup
from trunnion.machines import Machine, load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import CycleOn
from trunnion.readers import run_program

CONTROLS = sorted(
    entry.name.removesuffix(".toml") for entry in control_library().iterdir() if entry.name.endswith(".toml")
)

#: Each example is another path; the first one of Hypothesis is the simplest there is.
FEW = settings(
    max_examples=2, derandomize=True, database=None, phases=[Phase.explicit, Phase.generate],
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


@cache
def pair_of(control: str, name: str, folder: Path) -> Pair:
    """The definition of a pair, with wide limits of the linear axes."""
    file = folder / f"{name}_{control}.toml"
    slides = [axis.name for axis in load_machine(name).axes if not axis.is_rotary]
    room = "".join(f'[[axis]]\nname = "{slide}"\nlimits_mm = [-3000, 3000]\n' for slide in slides)
    # Whether a machine's control has TCP is said of its own control, not of these.
    tcp = str(load_control(load_control_table(control)).tcp).lower()
    text = f'extends = "{name}"\n[control]\nextends = "{control}"\ntcp = {tcp}\n{room}'
    file.write_text(text, encoding="utf-8")
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
    """Every check has passed, and every CL point that is not a hole is met, by a search of this test.

    A Fidia does not say how far its retract goes: on a head, the way from there may be refused.
    """
    if pair.family == "fidia_nc15" and "the way from home leads through the part" in done.err:
        assert pair.machine.has_rotary_head
        assert [line.split()[0] for line in done.failed] == ["modal"]
        return
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


def simplest(mode: str) -> str:
    """A CL file with two holes of a cycle."""
    return holes([mode], [(0.0, 0.0, 0.0, 0.0)])
