"""The summary: a row for each file, the same table for the same results, and whole or not there."""

import json
import os
import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.support.batches import InOrder, run_simply, simple_batch, write_files
from trunnion.batch.stores import FolderStore
from trunnion.batch.summary import COLUMNS, COSTS, check_summary, write_summary
from trunnion.errors import InputError

TEXTS = {"b/x.cls": "one", "a/x.cls": "several", "c.cls": "fail", "ü'.cls": "refuse"}


def rows(file: Path, table: str = "files") -> list[dict[str, Any]]:
    with closing(sqlite3.connect(file)) as database:
        database.row_factory = sqlite3.Row
        return [dict(row) for row in database.execute(f"SELECT * FROM {table}")]


def test_each_file_has_a_row_in_order_of_names(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    result = run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "out"), InOrder(reverse=True))
    write_summary(result, tmp_path / "s.sqlite")
    found = rows(tmp_path / "s.sqlite")
    assert [row["file"] for row in found] == ["a/x.cls", "b/x.cls", "c.cls", "ü'.cls"]
    several, one, wrong, refused = found
    assert (one["status"], one["points"], one["tools"], one["seconds"], one["bytes"]) == ("passed", 3, '["1"]', 1.5, 6)
    assert (
        one["sha256"] == "61aa9ea0e6bcc2ce16fccd8c9c60087a17cc3c2ae8b5d8b3ab4d8dc9cc8bb7e4" or len(one["sha256"]) == 64
    )
    assert json.loads(several["outputs"]) == ["a/x.programs/SUB1", "a/x.programs/SUB2", "a/x.programs/x.mpf"]
    assert several["bytes"] == 6 + len("of several")
    assert (wrong["status"], wrong["code"], wrong["line"]) == ("unusable", "CL310", 3)
    assert (refused["status"], refused["code"], refused["points"], refused["bytes"]) == ("failed", "tip", 2, None)
    assert list(one) == list(COLUMNS)
    assert [list(row) for row in rows(tmp_path / "s.sqlite", "costs")] == [list(COSTS)] * 4


def test_the_table_does_not_depend_on_the_order_of_the_work(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    for name in ("one", "two"):
        order = InOrder(reverse=name == "two")
        write_summary(
            run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / name), order), tmp_path / f"{name}.sqlite"
        )
    assert rows(tmp_path / "one.sqlite") == rows(tmp_path / "two.sqlite")
    assert (tmp_path / "one.sqlite").read_bytes() == (
        tmp_path / "two.sqlite"
    ).read_bytes()  # nothing here costs anything


def test_a_table_of_parquet_says_the_same(tmp_path: Path) -> None:
    parquet = (
        pytest.importorskip("pyarrow.parquet") if not os.environ.get("CI") else __import__("pyarrow.parquet").parquet
    )
    write_files(tmp_path / "in", TEXTS)
    result = run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "out"))
    write_summary(result, tmp_path / "s.sqlite")
    write_summary(result, tmp_path / "s.parquet")
    assert parquet.read_table(tmp_path / "s.parquet").to_pylist() == rows(tmp_path / "s.sqlite")
    assert parquet.read_table(tmp_path / "s.costs.parquet").to_pylist() == rows(tmp_path / "s.sqlite", "costs")


@pytest.mark.parametrize("ending", ["sqlite", "parquet"])
def test_a_file_that_is_no_summary_is_never_replaced(tmp_path: Path, ending: str) -> None:
    if ending == "parquet":
        pytest.importorskip("pyarrow.parquet")
    write_files(tmp_path / "in", TEXTS)
    result = run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "out"))
    file = tmp_path / f"s.{ending}"
    write_summary(result, file)
    ours, added = file.read_bytes(), tmp_path / "added.sqlite"
    with closing(sqlite3.connect(tmp_path / "mine")) as database:
        database.execute("CREATE TABLE files (x)")
        database.execute("CREATE TABLE costs (x)")
    if ending == "sqlite":
        added.write_bytes(ours)
        with closing(sqlite3.connect(added)) as database:
            database.execute("CREATE VIEW mine AS SELECT * FROM files")
    others = [(tmp_path / "mine").read_bytes(), b"text", ours[:200], *([added.read_bytes()] if added.exists() else [])]
    for other in others:
        file.write_bytes(other)
        with pytest.raises(InputError, match="FIL250"):
            check_summary(file)
        with pytest.raises(InputError, match="FIL250"):
            write_summary(result, file)
        assert file.read_bytes() == other
    file.write_bytes(b"")
    write_summary(result, file)
    assert file.read_bytes() == ours


def test_a_table_of_costs_that_is_somebody_elses_is_never_replaced(tmp_path: Path) -> None:
    pytest.importorskip("pyarrow.parquet")
    write_files(tmp_path, {"s.costs.parquet": "mine"})
    with pytest.raises(InputError, match="FIL250"):
        check_summary(tmp_path / "s.parquet")


def test_names_that_are_no_utf_8_and_odd_texts_stand_in_the_table(tmp_path: Path) -> None:
    odd = os.fsdecode(b"in\xff.cls") if os.name != "nt" else "in.cls"
    write_files(tmp_path / "in", {odd: "one"})
    (job,) = simple_batch(tmp_path / "in").jobs
    batch = replace(simple_batch(tmp_path / "in"), jobs=[replace(job, name="job\udcff")])
    result = run_simply(batch, FolderStore(tmp_path / "out"))
    write_summary(result, tmp_path / "s.sqlite")
    (row,) = rows(tmp_path / "s.sqlite")
    assert (row["job"], row["status"]) == ("job\\udcff", "passed")
    if os.name != "nt":
        assert row["file"] == "in\\udcff.cls"
    assert len(rows(tmp_path / "s.sqlite", "costs")) == 1


def test_a_summary_replaces_the_one_before_as_a_whole(tmp_path: Path) -> None:
    write_files(tmp_path / "in", TEXTS)
    result = run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "out"))
    for _ in range(2):
        write_summary(result, tmp_path / "s.sqlite")
    assert len(rows(tmp_path / "s.sqlite")) == 4
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in", "out", "s.sqlite"]


@pytest.mark.parametrize("name", ["s.csv", "s", "no/s.sqlite"])
def test_a_name_that_cannot_be_is_refused(tmp_path: Path, name: str) -> None:
    write_files(tmp_path / "in", TEXTS)
    result = run_simply(simple_batch(tmp_path / "in"), FolderStore(tmp_path / "out"))
    with pytest.raises(InputError):
        write_summary(result, tmp_path / name)
