"""Folders with kernels, compiled or not."""

import shutil
from pathlib import Path

import pytest

from tests.support.kept_kernels import Compiled, run, write_modules


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with two modules of kernels, of which none has been compiled."""
    return write_modules(tmp_path)


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Compiled:
    """A folder with two modules of kernels that a process has compiled, and what it printed; tests only read it."""
    folder = write_modules(tmp_path_factory.mktemp("compiled"))
    return folder, run(folder)


@pytest.fixture
def kept(compiled: Compiled, tmp_path: Path) -> Path:
    """A test's own copy of the machine code; the modules stay, as it belongs to their path."""
    shutil.copytree(compiled[0] / "kept", tmp_path / "kept")
    return tmp_path
