"""Definitions as files: lines of keys, and what may be read."""

import time
import tomllib
from pathlib import Path

import pytest

from tests.support.definition_files import loaded
from trunnion.definitions import (
    MAX_FILE_BYTES,
    layout,
    load_table,
)
from trunnion.errors import InputError

TRICKY = '''\
# a comment with = and [brackets]
top = 1
text = """
[not.a.table]
not_a_key = 1
a "quoted" \\""" word"""
raw = \'\'\'
also = "not a key"
\'\'\'
array = [
  1, # one ]
  "two ] # not a comment",
  [3, 4],
]
[plain]
a.b.c = 1
"quoted key" = 2
'single.dot' = 3
"esc\\u0041ped" = 3
inline = { x = 1, y = { z = [1,
  2], w = "}" } }
after = 1

[[item]]
name = "one"
[item.below]
deep = 1
[[item.part]]
k = 1
[[item.part]]
k = 2
[[item]]
name = "two"   # trailing
[item.below]
deep = 2
[ spaced . "out" ]
key = 1979-05-27 07:32:00
last = "end"'''


def test_keys_are_found_on_their_lines_among_strings_arrays_and_comments() -> None:
    lines = layout(TRICKY).lines
    assert {path: line for path, line in lines.items() if not any(isinstance(key, int) for key in path)} == {
        ("top",): 2,
        ("text",): 3,
        ("raw",): 7,
        ("array",): 10,
        ("plain",): 15,
        ("plain", "a"): 16,
        ("plain", "a", "b"): 16,
        ("plain", "a", "b", "c"): 16,
        ("plain", "quoted key"): 17,
        ("plain", "single.dot"): 18,
        ("plain", "escAped"): 19,
        ("plain", "inline"): 20,
        ("plain", "inline", "x"): 20,
        ("plain", "inline", "y"): 20,
        ("plain", "inline", "y", "z"): 20,
        ("plain", "inline", "y", "w"): 21,
        ("plain", "after"): 22,
        ("item",): 24,
        ("spaced",): 36,
        ("spaced", "out"): 36,
        ("spaced", "out", "key"): 37,
        ("spaced", "out", "last"): 38,
    }
    assert lines["item", 0] == 24
    assert lines["item", 0, "below", "deep"] == 27
    assert lines["item", 0, "part", 1, "k"] == 31
    assert lines["item", 1] == 32
    assert lines["item", 1, "name"] == 33
    assert lines["item", 1, "below", "deep"] == 35


def test_lines_are_the_same_with_windows_line_ends() -> None:
    assert layout(TRICKY.replace("\n", "\r\n")).lines == layout(TRICKY).lines


@pytest.mark.parametrize("text", ["", "\n", "=", "[", "[[", "[[a", "a", "a=", 'a="', "a={", "a=[{", '"', "a.", "]]"])
def test_a_text_that_is_no_toml_does_not_trip_the_index(text: str) -> None:
    layout(text)


@pytest.mark.parametrize(
    ("value", "lines"),
    [
        ('"""a""" # """', 1),
        ('"""""', 0),
        ('"""""\n"""""', 2),
        ('"""a\n""\\""""', 2),
        ("'''a\n''b'''''", 2),
        ("'''\\'''", 1),
        ('"\\\\"', 1),
        ("'\\'", 1),
        ('"# \\" ]"', 1),
    ],
)
def test_a_string_ends_where_the_toml_parser_ends_it(value: str, lines: int) -> None:
    """0: it does not end, and nothing follows it."""
    text = f"a = {value}\nb = 2\n"
    assert layout(text).lines.get(("b",), 0) == (lines + 1 if lines else 0)
    if lines:
        assert tomllib.loads(text)["b"] == 2


def test_a_definition_that_changes_is_read_anew(tmp_path: Path) -> None:
    file, base = tmp_path / "own.toml", tmp_path / "base.toml"
    file.write_text('extends = "base.toml"\nb = 1\n', encoding="utf-8")
    for value in (1, 1, 2, 1):
        base.write_text(f"a = {value}\n", encoding="utf-8")
        assert load_table(str(file), tmp_path).to_dict() == {"a": value, "b": 1}


def test_a_key_remembers_its_place(tmp_path: Path) -> None:
    table = loaded(tmp_path, "a = 1\n\n[b]\nc = 2\n")
    assert table.location("a") == (str(tmp_path / "mine.toml"), 1)
    assert table.table("b").location("c") == (str(tmp_path / "mine.toml"), 4)
    assert table.table("b").location("missing") == (str(tmp_path / "mine.toml"), 3)


# Files


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ("a = 1\nb = \n", 2, "is not TOML: the line has no value behind b ="),
        ("a = 1\na = 2\n", 2, "is not TOML: a is there already"),
        ('a = 1\n\nb = "open', 3, 'is not TOML: the text that begins with " does not end in its line'),
        ("a = [1,\n2", 1, "is not TOML: the list that begins with [ does not end"),
    ],
)
def test_a_syntax_error_is_told_at_its_line(tmp_path: Path, text: str, line: int, what: str) -> None:
    with pytest.raises(InputError) as caught:
        loaded(tmp_path, text)
    (problem,) = caught.value.problems
    assert (problem.file, problem.line, problem.what) == (str(tmp_path / "mine.toml"), line, what)


def test_a_file_that_is_not_utf_8_is_told_at_its_line(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_bytes(b'a = 1\nb = "Fr\xe4se"\n')
    with pytest.raises(InputError) as caught:
        load_table(path, tmp_path)
    assert (caught.value.problems[0].line, caught.value.problems[0].cure) == (2, "save the file as UTF-8")


def test_a_byte_order_mark_is_no_mistake(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xef\xbb\xbfa = 1\n")
    assert load_table(path, tmp_path).integer("a") == 1


def test_a_file_of_more_than_a_megabyte_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="has more than 1000000 bytes"):
        loaded(tmp_path, "#" * (MAX_FILE_BYTES + 1))


@pytest.mark.parametrize(
    "text",
    [
        ".".join("a" * 400_000) + " = 1",
        "a = " + "[" * 400_000,
        "a = " + "{a=" * 200_000,
        "[" + ".".join("b" * 9000) + "]",
    ],
    ids=["keys", "arrays", "tables", "header"],
)
def test_a_file_that_nests_without_end_is_refused_at_once(tmp_path: Path, text: str) -> None:
    begun = time.process_time()
    with pytest.raises(InputError, match="nests too deeply"):
        loaded(tmp_path, text)
    assert time.process_time() - begun < 5.0


def test_a_number_of_many_thousand_digits_is_a_mistake_and_no_crash(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is not TOML"):
        loaded(tmp_path, "a = " + "9" * 5000)
    for text in (f"a = 1\nb = 0x{'f' * 5000}", f"[a]\nb = [1, {{c = 0b{'1' * 20000}}}]"):
        with pytest.raises(InputError, match=r":2: error: has a whole number of more than 10000 bits"):
            loaded(tmp_path, text)


def test_a_missing_file_and_a_folder_are_no_definitions(tmp_path: Path) -> None:
    (tmp_path / "folder.toml").mkdir()
    for name in ("missing.toml", "folder.toml"):
        with pytest.raises(InputError, match=r"file not found|is a folder"):
            load_table(tmp_path / name, tmp_path)


# Extending
