"""Turns at the pole in a cut, and the tool axis between points where nobody asks for a tolerance."""

import math
from pathlib import Path

import numpy as np
import pytest

from tests.support.verifying import check
from trunnion import plan, verify
from trunnion.cli import main
from trunnion.machines import load_machine
from trunnion.model.toolpath import Kind

#: No B beyond 30 (or the like): half-way over the sphere the table must turn by 180 degrees.
TURNING = ["mikron_600u", "yl569", "dmu65", "matsuura_mx330"]


def sphere(angles: list[float], name: str = "CAP", tolerance: float = 0.03) -> str:
    """CL text of a cut over a sphere of 50 mm, with the tool square to it at these angles from Z, degrees."""
    lines = [f"TOOL PATH/{name},TOOL,BALL_10", "TLDATA/MILL,10.0000,5.0000,75.0000,0.0000,0.0000"]
    lines += ["MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0", f"INTOL/{tolerance}", f"OUTTOL/{tolerance}"]
    lines += ["LOAD/TOOL,1,ADJUST,1", "SPINDL/RPM,4000.0,CLW", "PAINT/COLOR,186", "RAPID"]
    for k, angle in enumerate([angles[0], *angles]):
        sin, cos = math.sin(math.radians(angle)), math.cos(math.radians(angle))
        radius = 90.0 if k == 0 else 50.0
        lines.append(f"GOTO/{radius * sin:.4f},0.0,{radius * cos:.4f},{sin:.9f},0.0,{cos:.9f}")
        lines += ["PAINT/COLOR,31", "FEDRAT/MMPM,500.0"] if k == 0 else []
    return "\n".join([*lines, "END-OF-PATH", ""])


CAP = sphere([-75.0, -60.0, -30.0, 0.0, 30.0, 60.0, 75.0])


@pytest.mark.parametrize("machine", TURNING)
def test_the_table_turns_at_the_pole_in_a_block_of_its_own(tmp_path: Path, machine: str) -> None:
    file = tmp_path / "cap.cls"
    file.write_text(CAP, encoding="utf-8")
    motion = plan(file, machine=machine).motions[0]
    moves = motion.operation.moves
    turn = np.abs(np.diff(motion.rotary[:, 0]))
    turn = np.abs(turn - 360.0 * np.rint(turn / 360.0))
    rows = 1 + np.flatnonzero((turn > 1.0) & (moves.kind[1:] != Kind.RAPID))
    assert len(rows) == 1
    row = int(rows[0])
    assert (moves.tip[row] == moves.tip[row - 1]).all()
    assert (moves.axis[row] == [0.0, 0.0, 1.0]).all()
    assert motion.rotary[row, 1] == motion.rotary[row - 1, 1] == pytest.approx(0.0, abs=1e-9)
    program = tmp_path / "cap.nc"
    for setting in ("rewind=insert", "rewind=none"):
        assert main(["post", str(file), "--machine", machine, "--set", setting, "--output", str(program)]) == 0
    found = verify(program, machine=machine, cl=file)
    assert found.passed, [one.summary for one in found.checks if not one.passed]
    assert check(found, "span").worst == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize("chunk", [1, 2, 3, 4, 5])
def test_the_step_is_found_wherever_a_chunk_of_rows_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, chunk: int
) -> None:
    file = tmp_path / "cap.cls"
    file.write_text(CAP, encoding="utf-8")
    whole = plan(file, machine="dmu65").motions[0]
    monkeypatch.setattr("trunnion.planning.linearization.default_points._CHUNK", chunk)
    motion = plan(file, machine="dmu65").motions[0]
    assert len(motion.operation.moves) == len(whole.operation.moves) > 8
    assert np.array_equal(motion.rotary, whole.rotary)


def test_a_turn_joined_with_a_step_of_the_cut_is_found(tmp_path: Path) -> None:
    file, program = tmp_path / "cap.cls", tmp_path / "cap.h"
    file.write_text(CAP, encoding="utf-8")
    assert main(["post", str(file), "--machine", "mikron_600u", "--output", str(program)]) == 0
    lines = program.read_text(encoding="utf-8").splitlines()
    k = next(k for k, line in enumerate(lines) if line.endswith("L C+180"))
    program.write_text("\n".join([*lines[:k], lines[k + 1] + " C+180", *lines[k + 2 :]]) + "\n", encoding="utf-8")
    for cl in ([file], []):
        span = check(verify(program, machine="mikron_600u", cl=cl), "span")
        assert not span.passed
        assert span.worst is not None
        assert span.worst > 15.0
        assert [place.nc_line for place in span.places] == [k + 1]


@pytest.mark.parametrize(
    ("name", "tolerance", "finishes"), [("CAP", 0.03, False), ("CAP_FINISH", 0.01, True), ("CAP", 0.005, True)]
)
def test_finishing_is_held_to_less(tmp_path: Path, name: str, tolerance: float, finishes: bool) -> None:
    """Half-way to a tilt of one degree the turn in the same step leads the tool axis off by 0.7 degrees."""
    file = tmp_path / "cap.cls"
    file.write_text(sphere([-1.0, 0.0, 1.0, 2.0], name, tolerance), encoding="utf-8")
    motion = plan(file, machine="dmu65").motions[0]
    rests = (np.diff(motion.operation.moves.tip, axis=0) == 0.0).all(axis=1)
    assert int(rests.sum()) == int(finishes)


@pytest.mark.parametrize("step", [0.4, 3.0, 25.0])
def test_a_step_across_the_pole_is_led_through_it(tmp_path: Path, step: float) -> None:
    file, program = tmp_path / "cap.cls", tmp_path / "cap.nc"
    file.write_text(sphere([-step - 2.0, -step, step, step + 2.0], "CAP_FINISH", 0.01), encoding="utf-8")
    motion = plan(file, machine="dmu65").motions[0]
    at_pole = (np.abs(motion.operation.moves.axis - [0.0, 0.0, 1.0]) < 1e-12).all(axis=1)
    assert int(at_pole.sum()) == 2, "before and behind the turn"
    assert main(["post", str(file), "--machine", "dmu65", "--output", str(program)]) == 0
    assert verify(program, machine="dmu65", cl=file).passed


def test_a_definition_sets_the_tolerance(tmp_path: Path) -> None:
    machine = tmp_path / "tight.toml"
    machine.write_text(
        'schema = 1\nextends = "dmu65"\nname = "Tight"\n[control.between_points]\naxis_tolerance_deg = 0.3\n',
        encoding="utf-8",
    )
    file, program = tmp_path / "cap.cls", tmp_path / "cap.nc"
    file.write_text(sphere([-1.0, 0.0, 1.0, 2.0]), encoding="utf-8")
    assert main(["post", str(file), "--machine", "dmu65", "--output", str(program)]) == 0
    assert check(verify(program, machine="dmu65", cl=file), "span").passed
    assert not check(verify(program, machine=str(machine), cl=file), "span").passed
    assert main(["post", str(file), "--machine", str(machine), "--output", str(program)]) == 0
    assert check(verify(program, machine=load_machine(str(machine)), cl=file), "span").passed
