"""Folders that former versions left are removed, and nothing else."""

import os
import sys
from pathlib import Path

import pytest

from trunnion.jit import store

TAG = sys.implementation.cache_tag
NOW = f"trunnion-{TAG}-0123456789"


def made(folder: Path, *files: str, processor: str | None = None) -> Path:
    """Make a folder with such files."""
    folder.mkdir(parents=True)
    for file in files:
        (folder / file).write_bytes(b"")
    if processor is not None:
        (folder / "processor.txt").write_text(processor, encoding="ascii")
    return folder


def test_a_former_folder_is_removed_and_what_is_not_surely_one_stays(tmp_path: Path) -> None:
    now = made(tmp_path / NOW, "scan-1.so")
    here = store._processor_name()
    former = [
        made(tmp_path / f"trunnion-{TAG}-aaaaaaaaaa", "scan-1.so", "scan-1.sum", "scan-1.lock", processor=here),
        made(tmp_path / f"trunnion-{TAG}-bbbbbbbbbb", "scan-1.o", "scan-1.sum.4711"),
        made(tmp_path / f"trunnion-{TAG}-numba-0.68.1", "scan.nbi", "scan.1.nbc"),
    ]
    staying = [
        now,
        made(tmp_path / f"trunnion-{TAG}-cccccccccc", "scan-1.so", processor="another"),
        made(tmp_path / f"trunnion-{TAG}-dddddddddd", "scan-1.so", "thesis.doc"),
        made(tmp_path / "trunnion-cpython-39-aaaaaaaaaa", "scan-1.so"),
        made(tmp_path / f"trunnion-{TAG}-mine", "scan-1.so"),
        made(tmp_path / "other", "scan-1.so"),
    ]

    assert store.remove_former(now) == len(former)
    assert sorted(tmp_path.iterdir()) == sorted(staying)
    assert store.remove_former(now) == 0


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="links need rights there")
def test_a_link_is_not_followed(tmp_path: Path) -> None:
    now, elsewhere = made(tmp_path / "kept" / NOW), made(tmp_path / "elsewhere", "scan-1.so")
    (tmp_path / "kept" / f"trunnion-{TAG}-aaaaaaaaaa").symlink_to(elsewhere)

    assert store.remove_former(now) == 0
    assert (elsewhere / "scan-1.so").exists()


@pytest.mark.parametrize("own", [True, False])
def test_a_new_folder_removes_former_ones_where_no_other_installation_keeps_any(
    own: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    former = made(tmp_path / f"trunnion-{TAG}-aaaaaaaaaa", "scan-1.so")
    monkeypatch.setattr(store, "_candidates", lambda: iter([tmp_path / NOW]))
    if own:
        monkeypatch.setattr(store, "_OWN", tmp_path)

    assert store.cache_folder.__wrapped__() == tmp_path / NOW
    assert former.exists() == (not own)
    assert store.holds_nothing(tmp_path / NOW)

    made(tmp_path / f"trunnion-{TAG}-bbbbbbbbbb", "scan-1.so")
    store.cache_folder.__wrapped__()  # it is marked: nobody looks again
    assert (tmp_path / f"trunnion-{TAG}-bbbbbbbbbb").exists()
