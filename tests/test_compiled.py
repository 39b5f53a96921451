"""Compiled kernels belong to one state of the source files."""

import os
from pathlib import Path

import pytest

from trunnion.compiled import keep_kernels


def kept_in(package: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder that Numba is told for a package."""
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    keep_kernels(package)

    return Path(os.environ["NUMBA_CACHE_DIR"])


def test_a_change_in_any_kernel_gives_all_kernels_a_new_folder_and_drops_the_old_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    callee = tmp_path / "inverse.py"
    callee.write_text("@njit\ndef f(): return 1\n")
    first = kept_in(tmp_path, monkeypatch)
    assert kept_in(tmp_path, monkeypatch) == first
    first.mkdir(parents=True)
    callee.write_text("@njit\ndef f(): return 2\n")
    (tmp_path / "text.py").write_text("x = 1\n")
    second = kept_in(tmp_path, monkeypatch)
    assert second != first
    assert not first.exists()


def test_a_place_that_the_user_chose_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", "mine")
    keep_kernels(tmp_path)

    assert os.environ["NUMBA_CACHE_DIR"] == "mine"
