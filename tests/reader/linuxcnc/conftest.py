"""RS274/NGC programs as texts, run on a machine."""

from pathlib import Path

import pytest

from tests.machines import at_zero
from tests.reader.conftest import Runner
from trunnion.machines import Machine
from trunnion.model.run import Run
from trunnion.readers import run_program


@pytest.fixture
def run(tmp_path: Path) -> Runner:
    """Run a text as a program."""

    def runner(text: str, machine: Machine | None = None, **settings: object) -> Run:
        program = tmp_path / "main.ngc"
        program.write_text(text, encoding="utf-8")
        return run_program(program, machine or at_zero("dmu65"), family="linuxcnc", **settings)  # type: ignore[arg-type]

    return runner
