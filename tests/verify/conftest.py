"""Tiny programs and their verification."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from trunnion.cl import read_cl
from trunnion.machines import Machine, load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.verification import Check, Verification, verify

Verifier = Callable[..., Verification]

#: Blocks before the first motion at the part, and after the last one.
HEAD = "G17 G710 G90 G94\nSUPA G0 Z0 D0\nSUPA G0 X0 Y0 B0 C0 D1\nT1\nM6\nG54\nS1000 M3\n"
FOOT = "SUPA G0 Z0 D0\nSUPA G0 X0 Y0 B0 C0 D1\nM5\nM30\n"

CL_HEAD = """TOOL PATH/OP1,TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,1000.0000,CLW
RAPID
GOTO/0.0,0.0,50.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
"""
CL_FOOT = "END-OF-PATH\n"


@pytest.fixture(scope="session")
def yl569() -> Machine:
    return load_machine("yl569")


@pytest.fixture
def ran(tmp_path: Path, yl569: Machine) -> Callable[..., Run]:
    """Run a text as a program."""

    def runner(text: str, machine: Machine = yl569, name: str = "MAIN.MPF") -> Run:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return run_program(path, machine)

    return runner


@pytest.fixture
def verified(tmp_path: Path, ran: Callable[..., Run], yl569: Machine) -> Verifier:
    """Verify a text as a program, against the text of a CL file if there is one."""

    def verifier(text: str, cl: str = "", machine: Machine = yl569, **settings: Any) -> Verification:
        run = ran(text, machine)
        if not cl:
            return verify(run, **settings)
        path = tmp_path / "part.cls"
        path.write_text(cl, encoding="utf-8")
        return verify(run, [read_cl(path)], **settings)

    return verifier


def check(found: Verification, key: str) -> Check:
    """The check with a key."""
    return next(check for check in found.checks if check.key == key)
