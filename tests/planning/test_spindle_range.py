"""Spindle speeds that a machine does not have: refused by `post`, and faults for `verify`."""

from pathlib import Path

import pytest

from tests.support.posting import FOOT, HEAD
from tests.support.verifying import check
from trunnion import verify
from trunnion.cli import main

#: A machine of each control whose definition states a speed, with one above it.
TOO_FAST = {
    "yl569": 9001,
    "mikron_600u": 20001,
    "matsuura_mx330": 15001,
    "generic_head_head_ca": 24001,
    "mikron_600u:slow": 19,
}


def machine_with(folder: Path, base: str, text: str) -> str:
    """The path of a definition that extends a shipped machine."""
    file = folder / "own.toml"
    file.write_text(f'schema = 1\nextends = "{base}"\nname = "Own"\n{text}\n', encoding="utf-8")
    return str(file)


@pytest.mark.parametrize("name", sorted(TOO_FAST))
def test_a_speed_outside_the_range_is_refused_and_found(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], name: str
) -> None:
    machine, rpm = name.partition(":")[0], TOO_FAST[name]
    right = 9000 if rpm > 100 else 20
    file, program = tmp_path / "part.cls", tmp_path / "part.nc"
    file.write_text(HEAD.replace("4000.0000", f"{rpm}.0") + FOOT, encoding="utf-8")
    assert main(["post", str(file), "--machine", machine, "--output", str(program)]) != 0
    assert not program.exists()
    assert f"part.cls:7: error: S{rpm} is {'above' if rpm > 100 else 'below'} the" in capfd.readouterr().err
    file.write_text(HEAD.replace("4000.0000", f"{right}.0") + FOOT, encoding="utf-8")
    assert main(["post", str(file), "--machine", machine, "--output", str(program)]) == 0
    text = program.read_text(encoding="utf-8")
    program.write_text(text.replace(f"S{right}", f"S{rpm}"), encoding="utf-8")
    found = check(verify(program, machine=machine), "rpm")
    assert not found.passed
    assert f"S{rpm} is" in found.summary


@pytest.mark.parametrize(("base", "rpm"), [("hs664rt", 1700), ("xyzac_trt", 1700), ("dmu65", 1700)])
def test_a_speed_between_two_gears_is_in_none(tmp_path: Path, base: str, rpm: int) -> None:
    gears = "[[spindle.gear]]\nmin_rpm = 20\nmax_rpm = 1500\n[[spindle.gear]]\nmin_rpm = 1800\nmax_rpm = 6000"
    machine = machine_with(tmp_path, base, gears)
    file, program = tmp_path / "part.cls", tmp_path / "part.nc"
    file.write_text(HEAD.replace("4000.0000", f"{rpm}.0") + FOOT, encoding="utf-8")
    assert main(["post", str(file), "--machine", machine, "--output", str(program)]) != 0
    assert main(["post", str(file), "--machine", base, "--output", str(program)]) == 0
    assert check(verify(program, machine=base), "rpm").passed
    assert "in no gear" in check(verify(program, machine=machine), "rpm").summary
