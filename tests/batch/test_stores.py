"""Places of results: folders, and those of fsspec."""

import errno
import os
import shutil
import uuid
from pathlib import Path

import pytest

from tests.support.batches import run_simply, simple_batch, tree, write_files
from tests.support.dask_clusters import needs_dask
from trunnion.batch.result_keys import digest
from trunnion.batch.stores import FolderStore, Store, open_store
from trunnion.errors import InputError


@pytest.fixture(params=["folder", pytest.param("file", marks=needs_dask), pytest.param("memory", marks=needs_dask)])
def store(request: pytest.FixtureRequest, tmp_path: Path) -> Store:
    if request.param == "folder":
        return open_store(tmp_path / "out")
    return open_store((tmp_path / "out").as_uri() if request.param == "file" else f"memory://{uuid.uuid4()}")


def test_a_store_gives_back_what_it_was_given(store: Store) -> None:
    assert (store.read("a/x"), store.digest("a/x")) == (None, None)
    assert not store.holds("a/x", 3, digest(b"one"))
    assert store.names("a") == []
    for content, lasting in ((b"other", True), (b"third", False), (b"one", True)):
        store.write("a/x", content, lasting=lasting)
        assert store.read("a/x") == content
    store.write("b", b"")
    assert (store.read("a/x"), store.digest("a/x")) == (b"one", digest(b"one"))
    assert list(store.read_many(["b", "no", "a/x"])) == [b"", None, b"one"]
    assert store.holds("a/x", 3, digest(b"one"))
    assert not store.holds("a/x", 4, digest(b"more"))
    assert not store.holds("a/x", 3, digest(b"two"))
    assert store.is_exact
    assert store.names("a") == ["a/x"]
    store.remove("a/x")
    store.remove("a/x")
    assert store.read("a/x") is None


def test_a_batch_comes_out_the_same_in_any_store(store: Store, tmp_path: Path) -> None:
    write_files(tmp_path / "in", {"a/x.cls": "one", "b/x.cls": "several", "c.cls": "fail"})
    batch = simple_batch(tmp_path / "in")
    result = run_simply(batch, store)
    run_simply(batch, FolderStore(tmp_path / "loop"))
    expected = [name for name in tree(tmp_path / "loop") if not name.startswith(".")]
    assert [store.read(name) for name in expected] == [tree(tmp_path / "loop")[name] for name in expected]
    assert len(expected) == 4
    assert [record.place for record in result.records()] == ["a/x.mpf", "b/x.mpf", "c.mpf"]
    assert run_simply(batch, store).done == 3


@needs_dask
@pytest.mark.parametrize("place", ["nosuch://x", "s3x://bucket"])
def test_an_address_that_nobody_knows_is_told(place: str) -> None:
    with pytest.raises(InputError, match="BAT130"):
        open_store(place)


def test_a_file_is_no_place_for_results(tmp_path: Path) -> None:
    write_files(tmp_path, {"x": ""})
    with pytest.raises(InputError, match="FIL230"):
        open_store(tmp_path / "x")


def test_results_do_not_leave_the_folder_by_a_link(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "out/a").symlink_to(tmp_path / "elsewhere", target_is_directory=True)
    with pytest.raises(InputError, match="leads out"):
        open_store(tmp_path / "out").write("a/x", b"")
    assert not list((tmp_path / "elsewhere").iterdir())


@pytest.mark.parametrize("is_lasting", [True, False])
def test_a_full_disk_is_told_with_its_cure(
    store: Store, tmp_path: Path, is_lasting: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not store.address:
        pytest.skip("it is no disk")
    store.write("a/before", b"")

    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    for owner, name in ((os, "replace"), (os, "rename"), (shutil, "move"), (Path, "replace")):
        monkeypatch.setattr(owner, name, full)
    with pytest.raises(InputError, match="make space there"):
        store.write("a/x", b"content", lasting=is_lasting)
    assert [path.name for path in (tmp_path / "out/a").iterdir() if not path.is_dir()] == ["before"]


def test_a_folder_that_nothing_is_in_any_more_goes_with_its_file(store: Store, tmp_path: Path) -> None:
    for name in ("a/b/x", "a/y"):
        store.write(name, b"")
    for name, left in (("a/b/x", ["a", "a/y"]), ("a/y", [])):
        store.remove(name)
        store.remove_empty(name)
        if store.address:
            out = tmp_path / "out"
            assert sorted(path.relative_to(out).as_posix() for path in out.rglob("*")) == left
            assert out.is_dir()


@pytest.mark.parametrize("is_dangling", [True, False])
def test_a_link_that_leads_out_is_neither_read_nor_written(tmp_path: Path, is_dangling: bool) -> None:
    write_files(tmp_path, {"out/x": "", **({} if is_dangling else {"mine": "one"})})
    (tmp_path / "out/link").symlink_to(tmp_path / "mine")
    store = open_store(tmp_path / "out")
    with pytest.raises(InputError, match=r"leads out.*BAT320"):
        store.read("link")
    with pytest.raises(InputError, match=r"leads out.*BAT320"):
        store.write("link", b"two")
    assert is_dangling is not (tmp_path / "mine").exists()
