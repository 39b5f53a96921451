"""Programs as texts, run on a machine."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from trunnion.arrays import Floats
from trunnion.machines import Machine, load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions

Runner = Callable[..., Run]


def close(got: Any, wanted: Any, atol: float = 0.0, rtol: float = 1e-7) -> None:
    """Two arrays, or lists, are equal except for rounding."""
    np.testing.assert_allclose(np.asarray(got), np.asarray(wanted), rtol=rtol, atol=atol)


def slides(run: Run) -> Floats:
    """Values of X, Y and Z."""
    return run.joints[:, [run.machine.column(axis) for axis in "XYZ"]]


def rotary(run: Run) -> Floats:
    """Values of B and C."""
    return run.joints[:, [run.machine.column(axis) for axis in "BC"]]


@pytest.fixture(scope="session")
def yl569() -> Machine:
    """A table-table mill: B carries the endless C, which displays 0 to 360."""
    return load_machine("yl569")


@pytest.fixture
def run(tmp_path: Path, yl569: Machine) -> Runner:
    """Return a function that runs a text as a program, with the ``files`` it may call."""

    def runner(
        text: str | bytes,
        machine: Machine = yl569,
        files: dict[str, str] | None = None,
        family: str | None = None,
        **settings: object,
    ) -> Run:
        for name, content in (files or {}).items():
            (tmp_path / name).write_text(content, encoding="utf-8")
        program = tmp_path / "MAIN.MPF"
        program.write_bytes(text.encode() if isinstance(text, str) else text)
        named = [tmp_path / name for name in files or {}]
        options = RunOptions(subprograms=named, **settings)  # type: ignore[arg-type]
        return run_program(program, machine, options, family=family)

    return runner
