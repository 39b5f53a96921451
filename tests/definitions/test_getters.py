"""Getters of a definition keep account of what is read."""

import math
from pathlib import Path

import pytest

from tests.support.definition_files import loaded
from trunnion.definitions import (
    definition_names,
    unit_of,
)
from trunnion.errors import InputError
from trunnion.machines.loading import machine_library

GETTERS = """\
text = "t"
number = 1.5
whole = 3
flag = true
vector = [1, 2.5, 3]
interval = [1, 2]
texts = ["a", "b"]
[table]
x = 1
[[tables]]
x = 1
[[tables]]
x = 2
"""


def test_getters_return_what_is_written(tmp_path: Path) -> None:
    table = loaded(tmp_path, GETTERS)
    assert table.text("text") == "t"
    assert table.number("number") == 1.5
    assert table.number("whole") == 3.0
    assert table.integer("whole") == 3
    assert table.flag("flag") is True
    assert table.vector("vector", 3) == (1.0, 2.5, 3.0)
    assert table.interval("interval") == (1.0, 2.0)
    assert table.texts("texts") == ("a", "b")
    assert table.table("table").integer("x") == 1
    assert [entry.integer("x") for entry in table.tables("tables")] == [1, 2]
    table.report_unread_keys()
    table.raise_problems()


def test_getters_return_the_default_for_what_is_not_written(tmp_path: Path) -> None:
    table = loaded(tmp_path, "")
    assert table.text("a", "spare") == "spare"
    assert table.text("a", None) is None
    assert table.number("a", 2.5) == 2.5
    assert table.integer("a", None) is None
    assert table.flag("a", True) is True
    assert table.vector("a", 2, (1.0, 2.0)) == (1.0, 2.0)
    assert table.interval("a", None) is None
    assert table.texts("a", ("x",)) == ("x",)
    assert table.table("a").keys() == []
    assert table.tables("a") == []
    table.raise_problems()


def test_every_getter_notes_what_is_missing_and_reading_goes_on(tmp_path: Path) -> None:
    table = loaded(tmp_path, "")
    assert table.text("a") == ""
    assert table.number("b") == 0.0
    assert table.integer("c") == 0
    assert table.flag("d") is False
    assert table.vector("e", 2) == (0.0, 0.0)
    assert table.interval("f") == (-math.inf, math.inf)
    assert table.texts("g") == ()
    table.table("h", required=True)
    table.tables("i", required=True)
    with pytest.raises(InputError) as caught:
        table.raise_problems()
    assert [problem.what for problem in caught.value.problems] == [f"{key} is missing" for key in "abcdefghi"]


@pytest.mark.parametrize(
    ("value", "read", "cure"),
    [
        ("5", "text", 'write a text in quotes: k_mm = "5"'),
        ("true", "number", "write a number in millimetres"),
        ("nan", "number", "write a number in millimetres"),
        ("inf", "number", "write a number in millimetres"),
        ('"12.5mm"', "number", "write a number in millimetres, without quotes and unit: k_mm = 12.5"),
        ('"12,5 mm"', "number", "write a number in millimetres, without quotes and unit: k_mm = 12.5"),
        ("1.0", "integer", "write a whole number"),
        ("true", "integer", "write a whole number"),
        ("1", "flag", "write true or false, without quotes"),
        ('"true"', "flag", "write true or false, without quotes"),
        ("[1, 2, inf]", "vector", "write [a, b, c] with 3 numbers in millimetres"),
        ("[1, 2, true]", "vector", "write [a, b, c] with 3 numbers in millimetres"),
        ("7", "vector", "write [a, b, c] with 3 numbers in millimetres"),
        ("[3, 3]", "interval", "write [low, high] with low < high, in millimetres"),
        ("[1]", "interval", "write [low, high] with low < high, in millimetres"),
        ('"ab"', "texts", 'write ["ab"]'),
        ('["a", 1]', "texts", 'write ["one", "two"]'),
        ("1", "table", "write a table [k_mm]"),
        ("[1]", "tables", "write tables [[k_mm]]"),
        ("{}", "tables", "write tables [[k_mm]]"),
    ],
)
def test_a_value_of_the_wrong_type_is_told_what_to_write(tmp_path: Path, value: str, read: str, cure: str) -> None:
    table = loaded(tmp_path, f"k_mm = {value}\n")
    getter = getattr(table, read)
    getter("k_mm", 3) if read == "vector" else getter("k_mm")
    with pytest.raises(InputError) as caught:
        table.raise_problems()
    assert [(p.line, p.cure) for p in caught.value.problems] == [(1, cure)]


def test_bounds_are_kept_and_told(tmp_path: Path) -> None:
    table = loaded(tmp_path, "a = 0\nb = 5\nc = -1\n")
    table.number("a", above=0)
    table.number("b", at_most=4)
    table.integer("c", at_least=0, at_most=9)
    with pytest.raises(InputError) as caught:
        table.raise_problems()
    assert [problem.cure for problem in caught.value.problems] == [
        "write a number above 0",
        "write a number of at most 4",
        "write a whole number of at least 0 and of at most 9",
    ]


def test_a_fresh_table_starts_its_account_anew(tmp_path: Path) -> None:
    table = loaded(tmp_path, "a = 1\n")
    table.text("a")
    again = table.unread_copy()
    again.raise_problems()
    again.report_unread_keys()
    assert len(again.problems) == 1


@pytest.mark.parametrize(
    ("key", "unit"), [("rapid_mm_min", "millimetres per minute"), ("limits_deg", "degrees"), ("name", "")]
)
def test_the_end_of_a_key_says_its_unit(key: str, unit: str) -> None:
    assert unit_of(key) == unit


def test_a_library_lists_its_definitions() -> None:
    assert "yl569" in definition_names(machine_library())
