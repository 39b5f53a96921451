"""Places of results: folders, and those of fsspec."""

import uuid
from pathlib import Path

import pytest

from tests.support.batches import run_simply, simple_batch, tree, write_files
from tests.support.dask_clusters import needs_dask
from trunnion.batch.keys import digest
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
