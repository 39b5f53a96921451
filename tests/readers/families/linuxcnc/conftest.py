"""RS274/NGC programs as texts, run on a machine."""

from pathlib import Path

import pytest

from tests.support.machines import at_zero
from tests.support.reading import Runner
from trunnion.machines import Machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions


@pytest.fixture
def run(tmp_path: Path) -> Runner:
    """Run a text as a program; the files that it may call by name."""

    def runner(
        text: str, machine: Machine | None = None, files: dict[str, str] | None = None, **settings: object
    ) -> Run:
        for name, content in (files or {}).items():
            (tmp_path / name).write_text(content, encoding="utf-8")
        program = tmp_path / "main.ngc"
        program.write_text(text, encoding="utf-8")
        named = [tmp_path / name for name in files or {}]
        model = machine or at_zero("dmu65")
        return run_program(program, model, RunOptions(subprograms=named, **settings), family="linuxcnc")  # type: ignore[arg-type]

    return runner
