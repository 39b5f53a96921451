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
    assert node_list_names() == ["cnc", "heidenhain", "sinumerik", "twin"]
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


def parquet(file: Path, **columns: object) -> Path:
    arrow = pytest.importorskip("pyarrow")
    stamps = arrow.array(
        [1_780_000_000_123_456_000 + k * 50_000_000 for k in range(3)], arrow.timestamp("ns", tz="UTC")
    )
    given = {"source": stamps, "X": arrow.array([1.0, 2.0, 3.0]), **columns}
    pytest.importorskip("pyarrow.parquet").write_table(arrow.table(given), file)
    return file


def test_times_of_any_unit_are_read(tmp_path: Path) -> None:
    arrow = pytest.importorskip("pyarrow")
    found = read_recording(parquet(tmp_path / "ns.parquet"))
    assert found.source.tolist() == [BEGIN, BEGIN + 50_000, BEGIN + 100_000]
    for unit, factor in (("s", 1), ("ms", 1000), ("us", 1_000_000)):
        stamps = arrow.array([1_780_000_000 * factor] * 3, arrow.timestamp(unit))
        found = read_recording(parquet(tmp_path / f"{unit}.parquet", source=stamps))
        assert found.source.tolist() == [1_780_000_000_000_000] * 3


@pytest.mark.parametrize(
    ("name", "values", "kind", "problem"),
    [
        ("source", [1, 2, 3], "int64", "column source holds no times but int64"),
        ("source", [1.0, 2.0, 3.0], "float64", "column source holds no times but double"),
        ("source", [1, 2, 3], "date32", "column source holds no times but date32"),
        ("X", [True, False, True], "bool_", "column X holds no numbers but bool"),
        ("block", [1, 2, 3], "int64", "column block holds no texts but int64"),
        ("x", [1.0, 2.0, 3.0], "float64", "columns of the same name"),
    ],
)
def test_columns_of_another_kind_are_refused(
    tmp_path: Path, name: str, values: list[object], kind: str, problem: str
) -> None:
    arrow = pytest.importorskip("pyarrow")
    column = arrow.array(values, getattr(arrow, kind)())
    with pytest.raises(InputError, match=problem):
        read_recording(parquet(tmp_path / "a.parquet", **{name: column}))


def test_a_long_text_that_comes_again_and_again_is_refused_at_once(tmp_path: Path) -> None:
    arrow = pytest.importorskip("pyarrow")
    block = arrow.DictionaryArray.from_arrays(arrow.array([0, 0, 0], arrow.int32()), arrow.array(["x" * 100_000]))
    table = arrow.table({"source": arrow.array([None] * 3, arrow.timestamp("us")), "block": block})
    pytest.importorskip("pyarrow.parquet").write_table(table, tmp_path / "a.parquet", store_schema=False)
    with pytest.raises(InputError, match="more than 32000 characters in block"):
        read_recording(tmp_path / "a.parquet")


@pytest.mark.parametrize("text", ["nan", "inf", "-inf", "1e400", "1e308", "NaN"])
def test_what_is_no_number_of_a_machine_is_a_mistake(tmp_path: Path, text: str) -> None:
    file = tmp_path / "a.csv"
    file.write_text(f"source,X\n2026-05-04T08:30:00Z,{text}\n", encoding="utf-8")
    with pytest.raises(InputError, match="X is no number"):
        read_recording(file)


@pytest.mark.parametrize("name", ["a.csv", "a.parquet"])
def test_texts_are_guarded_from_spreadsheets_and_numbers_that_are_none_are_empty(tmp_path: Path, name: str) -> None:
    texts = ["=cmd|'/C calc'!A0", "@SUM(A1)", "+1", "-2", "'quoted", "N10", "y" * 200_000]
    file = tmp_path / name
    writer = RecordingWriter(resolve_output(file), NAMES, frozenset({"block"}))
    writer.add([Row([np.nan, np.inf, text], BEGIN, BEGIN, BEGIN) for text in texts])
    if name.endswith(".csv"):
        cells = [line.split(",", 6)[6] for line in file.read_text(encoding="utf-8").splitlines()[1:5]]
        assert all(cell.lstrip('"').startswith("'") for cell in cells)
    writer.close()
    found = read_recording(file)
    assert [found.texts["block"][k] for k in range(6)] == texts[:6]
    assert len(found.texts["block"][6]) == 32_000
    assert np.isnan(found.values["X"]).all()


def test_empty_lines_are_no_rows(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text("source,X\n2026-05-04T08:30:00Z,1\n\n2026-05-04T08:30:01Z,2\n\n", encoding="utf-8")
    assert read_recording(file).values["X"].tolist() == [1.0, 2.0]
