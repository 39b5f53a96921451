"""Files of recordings: what was added is read again, whatever happens, and nothing is written over."""

from pathlib import Path

import numpy as np
import pytest

from trunnion.errors import InputError
from trunnion.files import resolve_output
from trunnion.model.recording import NO_TIME, Mark, Recording
from trunnion.twin.recording.files import RecordingWriter, check_is_new
from trunnion.twin.recording.nodes import load_nodes, node_list_names
from trunnion.twin.recording.reading import read_recording
from trunnion.twin.recording.rows import Row

NAMES = ("X", "C", "block")
BEGIN = 1_780_000_000_123_456

ROWS = [
    Row([0.1 + 0.2, -0.0, "N10 X1,5"], BEGIN, BEGIN + 1, BEGIN + 2),
    Row([None, None, None], None, None, BEGIN + 50, [Mark.GAP]),
    Row([1e-12, 359.9999999999, 'N20 MSG("轮毂")\nx'], BEGIN + 7, None, BEGIN + 60, [Mark.LOST, Mark.BACK]),
]


def write(file: Path) -> RecordingWriter:
    writer = RecordingWriter(resolve_output(file), NAMES, frozenset({"block"}))
    writer.add(ROWS)
    return writer


def check_rows(found: Recording) -> None:
    assert found.source.tolist() == [BEGIN, NO_TIME, BEGIN + 7]
    assert found.received.tolist() == [BEGIN + 2, BEGIN + 50, BEGIN + 60]
    assert found.marks == {1: (Mark.GAP,), 2: (Mark.LOST, Mark.BACK)}
    for k, name in enumerate(("X", "C")):
        wanted = np.array([np.nan if row.values[k] is None else row.values[k] for row in ROWS], np.float64)
        assert found.values[name].tobytes() == wanted.tobytes()
    assert [found.texts["block"][k] for k in range(3)] == ["N10 X1,5", "", 'N20 MSG("轮毂") x']


@pytest.mark.parametrize("name", ["a.csv", "a.parquet"])
def test_what_was_recorded_is_read_again(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    write(file).close()
    check_rows(read_recording(file))
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_process_that_is_killed_leaves_what_was_added(tmp_path: Path) -> None:
    write(tmp_path / "a.parquet")  # and never closes it
    journal = tmp_path / "a.parquet.csv"
    check_rows(read_recording(journal))
    whole = journal.read_bytes()
    for cut in range(1, len(whole.splitlines(keepends=True)[-1])):
        journal.write_bytes(whole[:-cut])
        assert len(read_recording(journal)) == 2
    with pytest.raises(InputError, match="was not ended"):
        check_is_new(resolve_output(tmp_path / "a.parquet"))


def test_an_empty_recording_is_read(tmp_path: Path) -> None:
    for name in ("a.csv", "a.parquet"):
        RecordingWriter(resolve_output(tmp_path / name), NAMES, frozenset({"block"})).close()
        assert len(read_recording(tmp_path / name)) == 0


def test_nothing_is_written_over(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="never written over"):
        check_is_new(resolve_output(file))
    with pytest.raises(InputError, match="cannot be written"):
        RecordingWriter(resolve_output(file), NAMES, frozenset())
    assert file.read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("X,Y\n1,2\n", "has no column source"),
        ("source,X,X\n", "columns of the same name"),
        ("source,X\n2026-05-04T08:30:00Z,1\nyesterday,2\n", ":3: error: source is no time: 'yesterday'"),
        ("source,X\n2026-05-04T08:30:00Z,1\n,one\n", ":3: error: X is no number: 'one'"),
        ("source,mark,X\n,oops,1\n", ":2: error: mark is no mark: 'oops'; known are gap, lost, back, jump"),
        ("source,X\n,1\n,1,2\n", "has 3 cells, not 2"),
    ],
)
def test_mistakes_are_told_with_their_lines(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "a.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_recording(file)
    assert message in str(caught.value)


def test_what_is_no_recording_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "a.parquet"
    file.write_bytes(b"PAR1 and nothing")
    for path in (file, tmp_path / "none.csv", tmp_path):
        with pytest.raises(InputError):
            read_recording(path)


def test_the_shipped_lists_of_nodes_are_sound() -> None:
    assert node_list_names() == ["cnc", "heidenhain", "sinumerik"]
    for name in node_list_names():
        names = [column.name for column in load_nodes(name).columns]
        assert names[:3] == ["X", "Y", "Z"]
        assert "spindle" in names


def test_mistakes_in_a_list_of_nodes_are_told_at_once(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(
        '[columns]\nX = { id = "a" }\nmark = { path = "A" }\nY = { namespace = "u" }\nZ = { path = "A", colour = 1 }\n',
        encoding="utf-8",
    )
    with pytest.raises(InputError) as caught:
        load_nodes(file)
    text = str(caught.value)
    for message in ("has no namespace", "cannot be the name of a column", "does not say which variable", "colour"):
        assert message in text
