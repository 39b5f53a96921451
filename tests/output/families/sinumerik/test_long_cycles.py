"""Drilling cycles in the long form of an 840D sl: written by a setting, and the same holes as in the classic form."""

import re
from pathlib import Path

import pytest

from tests.support.locations import YL569
from tests.support.proof import unproven
from trunnion import diff
from trunnion.cli import main

CL = YL569.with_name("yl569_cycles") / "long_cycles.cls"
GOLDEN = CL.with_name("long_cycles.expected.mpf")


def test_the_long_form_is_the_one_that_it_was(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    code = main(["post", str(CL), "--machine", "yl569", "--output", "-", "--set", "cycle_form=long"])
    out, err = capfdbinary.readouterr()
    assert (code, unproven(err.decode())) == (0, "")
    assert out == GOLDEN.read_bytes()


def test_the_long_form_is_the_classic_one_by_diff(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    classic = tmp_path / "classic.mpf"
    assert main(["post", str(CL), "--machine", "yl569", "--output", str(classic)]) == 0
    assert diff(classic, GOLDEN, machine="yl569").same


def calls() -> list[tuple[int, str]]:
    lines = GOLDEN.read_text(encoding="utf-8").splitlines()
    return [(k, line) for k, line in enumerate(lines) if re.search(r"CYCLE8\d", line) and "CYCLE832" not in line]


@pytest.mark.parametrize("mode", [0, 1])
def test_a_mode_for_the_shank_or_another_plane_fails(
    mode: int, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    lines = GOLDEN.read_text(encoding="utf-8").splitlines()
    for at, line in calls():
        head, _, last = line.rpartition(",0,1,")
        wrong = head + (",1,1," if mode == 0 else ",0,2,") + last
        file = tmp_path / "wrong.mpf"
        file.write_text("\n".join([*lines[:at], wrong, *lines[at + 1 :]]) + "\n", encoding="utf-8")
        assert main(["verify", str(file), "--cl", str(CL), "--machine", "yl569"]) != 0, wrong
    capfd.readouterr()
