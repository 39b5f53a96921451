"""Klartext programs as texts, run on a machine."""

from dataclasses import replace
from pathlib import Path

import pytest

from tests.support.machines import at_zero
from tests.support.reading import Runner
from trunnion.machines import Machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions


@pytest.fixture(scope="session")
def dmu65() -> Machine:
    """A table-table mill whose programs are Klartext: A from -90 to 0 carries the endless C."""
    return at_zero("dmu65")


def of_blocks(run: Run) -> Run:
    """The run of a few blocks, of which nobody asks whether a program stands around them."""
    told = tuple(each for each in run.diagnostics if "BEGIN PGM" not in each.text)
    return replace(run, diagnostics=told)


@pytest.fixture
def run(tmp_path: Path, dmu65: Machine) -> Runner:
    """Return a function that runs a text as a program, with the ``files`` it may call."""

    def runner(text: str, machine: Machine = dmu65, files: dict[str, str] | None = None, **settings: object) -> Run:
        for name, content in (files or {}).items():
            (tmp_path / name).write_text(content, encoding="utf-8")
        program = tmp_path / "MAIN.H"
        program.write_text(text, encoding="utf-8")
        family = None if machine is dmu65 else "heidenhain_itnc530"
        named = [tmp_path / name for name in files or {}]
        found = run_program(program, machine, RunOptions(subprograms=named, **settings), family=family)  # type: ignore[arg-type]
        return found if "BEGIN PGM" in text else of_blocks(found)

    return runner
