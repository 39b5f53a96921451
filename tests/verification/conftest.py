"""Tiny programs, and what verification says of them."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.support.verifying import Verifier
from trunnion.cl import read_cl
from trunnion.machines import Machine, load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.verification import Verification, verify


@pytest.fixture(autouse=True)
def texts_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    """A text that is missing, or whose parameters are, fails here, where a user is told what is known of it."""

    def fail(variant: str, parameters: object) -> str:
        raise AssertionError(f"{variant} has no text for {parameters}")

    monkeypatch.setattr("trunnion.messages._unfilled", fail)


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
    """Verify a text as a program, maybe against the text of a CL file."""

    def verifier(text: str, cl: str = "", machine: Machine = yl569, **settings: Any) -> Verification:
        run = ran(text, machine)
        if not cl:
            return verify(run, **settings)
        path = tmp_path / "part.cls"
        path.write_text(cl, encoding="utf-8")
        return verify(run, [read_cl(path)], **settings)

    return verifier
