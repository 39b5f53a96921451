"""Definitions as files: lines of keys, extending, what may be read, and getters that keep account."""

import math
import time
import tomllib
from pathlib import Path

import pytest

from trunnion.controls import load_control
from trunnion.definitions import (
    MAX_FILE_BYTES,
    Table,
    definition_names,
    key_lines,
    load_table,
    resolve_extends,
    unit_of,
)
from trunnion.errors import InputError
from trunnion.machines import load_machine
from trunnion.machines.loading import machine_library

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


def written(folder: Path, name: str, text: str) -> Path:
    """Write a file and return its path."""
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def loaded(folder: Path, text: str, shelf: Path | None = None) -> Table:
    """Load a definition from text, with a library of its own."""
    shelf = shelf or folder / "shelf"
    shelf.mkdir(exist_ok=True)
    return load_table(written(folder, "mine.toml", text), shelf)


# Lines


def test_keys_are_found_on_their_lines_among_strings_arrays_and_comments() -> None:
    lines = key_lines(TRICKY)
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
    assert key_lines(TRICKY.replace("\n", "\r\n")) == key_lines(TRICKY)


@pytest.mark.parametrize("text", ["", "\n", "=", "[", "[[", "[[a", "a", "a=", 'a="', "a={", "a=[{", '"', "a.", "]]"])
def test_a_text_that_is_no_toml_does_not_trip_the_index(text: str) -> None:
    key_lines(text)


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
    assert key_lines(text).get(("b",), 0) == (lines + 1 if lines else 0)
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
        ("a = 1\nb = \n", 2, "is not TOML: invalid value"),
        ("a = 1\na = 2\n", 2, "is not TOML: a is there already"),
        ('a = 1\n\nb = "open', 3, "is not TOML: unterminated string"),
        ("a = [1,\n2", 2, "is not TOML: unclosed array"),
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
    begun = time.perf_counter()
    with pytest.raises(InputError, match="nests too deeply"):
        loaded(tmp_path, text)
    assert time.perf_counter() - begun < 5.0


def test_a_number_of_many_thousand_digits_is_a_mistake_and_no_crash(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is not TOML"):
        loaded(tmp_path, "a = " + "9" * 5000)


def test_a_missing_file_and_a_folder_are_no_definitions(tmp_path: Path) -> None:
    (tmp_path / "folder.toml").mkdir()
    for name in ("missing.toml", "folder.toml"):
        with pytest.raises(InputError, match=r"file not found|is a folder"):
            load_table(tmp_path / name, tmp_path)


# Extending


def test_what_a_child_says_replaces_and_the_rest_is_inherited(tmp_path: Path) -> None:
    base = written(tmp_path, "shelf/base.toml", "a = 1\nb = 2\n[t]\nc = 3\nd = [1, 2]\n")
    table = loaded(tmp_path, 'extends = "base"\nb = 20\n[t]\nd = [9]\n')
    assert table.to_dict() == {"a": 1, "b": 20, "t": {"c": 3, "d": [9]}}
    assert table.location("a") == (str(base), 1)
    assert table.location("b") == (str(tmp_path / "mine.toml"), 2)
    assert table.table("t").location("c") == (str(base), 4)
    assert table.files() == sorted([str(base), str(tmp_path / "mine.toml")])


def test_tables_with_names_are_merged_by_name_appended_and_removed(tmp_path: Path) -> None:
    written(tmp_path, "shelf/base.toml", '[[w]]\nname="X"\nn=1\n[[w]]\nname="Y"\nn=2\n[[w]]\nname="Z"\nn=3\n')
    mine = '[[w]]\nname="Z"\nn=30\n[[w]]\nname="Q"\nn=4\n[[w]]\nname="X"\nremove=true\n'
    names = [(w["name"], w["n"]) for w in loaded(tmp_path, 'extends = "base"\n' + mine).to_dict()["w"]]  # type: ignore[attr-defined]
    assert names == [("Y", 2), ("Z", 30), ("Q", 4)]


def test_removing_what_is_not_there_and_a_name_left_out_are_mistakes(tmp_path: Path) -> None:
    written(tmp_path, "shelf/base.toml", '[[w]]\nname="X"\n')
    table = loaded(tmp_path, 'extends = "base"\n[[w]]\nname="XX"\nremove=true\n[[w]]\nn=1\n')
    with pytest.raises(InputError) as caught:
        table.raise_problems()
    assert [(p.line, p.what) for p in caught.value.problems] == [
        (4, 'w[0]: there is no w called "XX" to remove'),
        (5, "w[1].name is missing"),
    ]


def test_a_chain_of_three_files_is_merged_in_order(tmp_path: Path) -> None:
    written(tmp_path, "shelf/old.toml", "a = 1\nb = 1\nc = 1\n")
    written(tmp_path, "sub/mid.toml", 'extends = "old"\nb = 2\nc = 2\n')
    assert loaded(tmp_path, 'extends = "sub/mid.toml"\nc = 3\n').to_dict() == {"a": 1, "b": 2, "c": 3}


@pytest.mark.parametrize(
    "name",
    [
        "../secret.toml",
        "/etc/passwd",
        "/etc/secret.toml",
        "sub/../../secret.toml",
        "..\\\\secret.toml",
        "C:/secret.toml",
        "~/secret.txt",
        "secret.txt",
        "sub/..",
        "",
        "file://secret.toml",
    ],
)
def test_a_definition_may_not_name_files_elsewhere(tmp_path: Path, name: str) -> None:
    written(tmp_path, "secret.toml", "a = 1\n")
    (tmp_path / "here").mkdir()
    with pytest.raises(InputError, match="not a file that a definition may read"):
        loaded(tmp_path / "here", f'extends = "{name}"\n')


def test_a_link_may_not_lead_elsewhere_either(tmp_path: Path) -> None:
    secret = written(tmp_path, "secret.toml", "a = 1\n")
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "link.toml").symlink_to(secret)
    with pytest.raises(InputError, match="leads out of the folder"):
        loaded(tmp_path / "here", 'extends = "link.toml"\n')


def test_a_definition_may_lie_in_a_folder_beside_the_one_that_extends_it(tmp_path: Path) -> None:
    written(tmp_path, "shop/base.toml", 'extends = "old/older"\na = 1\n')
    written(tmp_path, "shop/old/older.toml", "b = 2\n")
    for name in ("shop/base", "shop/base.toml", "./shop/base"):
        assert loaded(tmp_path, f'extends = "{name}"\n').to_dict() == {"a": 1, "b": 2}


def test_a_file_in_the_folder_reaches_what_is_below_itself_and_nothing_beside_the_folder(tmp_path: Path) -> None:
    written(tmp_path, "other.toml", "b = 2\n")
    for name in ("other.toml", "../other.toml", "../other"):
        written(tmp_path, "shop/base.toml", f'extends = "{name}"\n')
        with pytest.raises(InputError) as caught:
            loaded(tmp_path, 'extends = "shop/base"\n')
        (problem,) = caught.value.problems
        assert (problem.file, problem.line) == (str(tmp_path / "shop" / "base.toml"), 1)


def test_a_missing_file_of_the_folder_is_told_with_its_name(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'there is no file "shop/base\.toml" beside the definition') as caught:
        loaded(tmp_path, 'a = 1\nextends = "shop/base"\n')
    assert caught.value.problems[0].line == 2


def test_a_linked_folder_may_not_lead_elsewhere_but_may_stay_inside(tmp_path: Path) -> None:
    written(tmp_path, "secret/base.toml", "a = 1\n")
    written(tmp_path, "here/real/base.toml", "a = 2\n")
    (tmp_path / "here" / "shop").symlink_to(tmp_path / "secret", target_is_directory=True)
    (tmp_path / "here" / "ours").symlink_to(tmp_path / "here" / "real", target_is_directory=True)
    with pytest.raises(InputError, match="leads out of the folder"):
        loaded(tmp_path / "here", 'extends = "shop/base"\n')
    assert loaded(tmp_path / "here", 'extends = "ours/base"\n').to_dict() == {"a": 2}


def test_links_that_go_round_are_no_definition(tmp_path: Path) -> None:
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    with pytest.raises(InputError, match=r"leads out of the folder|there is no file"):
        loaded(tmp_path, 'extends = "a/base"\n')


def test_a_circle_through_a_folder_is_told(tmp_path: Path) -> None:
    written(tmp_path, "shop/a.toml", 'extends = "b.toml"\n')
    written(tmp_path, "shop/b.toml", 'extends = "./a.toml"\n')
    with pytest.raises(InputError, match=r"goes in a circle: mine.toml extends a.toml extends b.toml extends a.toml"):
        loaded(tmp_path, 'extends = "shop/a"\n')


def test_the_control_of_a_machine_may_lie_in_a_folder_beside_the_file_that_says_so(tmp_path: Path) -> None:
    written(tmp_path, "controls/ours.toml", 'extends = "fanuc_31i"\nname = "Ours"\n[settings]\nprogram = "7"\n')
    path = written(tmp_path, "mill.toml", 'extends = "matsuura_mx330"\n[control]\nextends = "controls/ours"\n')
    control = load_control(load_machine(path).control)
    assert (control.name, control.settings["program"]) == ("Ours", "7")
    above = written(tmp_path, "top/mill.toml", 'extends = "matsuura_mx330"\n[control]\nextends = "../controls/ours"\n')
    with pytest.raises(InputError, match="not a file that a definition may read"):
        load_control(load_machine(above).control)


@pytest.mark.parametrize(
    "name", ["/", "./", "shop/", "shop/..", "/shop/base", "shop\\\\base", "D:shop/base", "shop/base.txt"]
)
def test_a_folder_alone_or_a_path_of_another_kind_is_no_definition(tmp_path: Path, name: str) -> None:
    written(tmp_path, "shop/base.toml", "a = 1\n")
    with pytest.raises(InputError, match=r"not a file that a definition may read|there is no file"):
        loaded(tmp_path, f'extends = "{name}"\n')


def test_a_definition_extends_one_other_and_no_list(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'extends is \["a", "b"\]; write one name'):
        loaded(tmp_path, 'extends = ["a", "b"]\n')


def test_a_user_file_may_bear_the_name_of_the_shipped_one_that_it_extends(tmp_path: Path) -> None:
    path = written(tmp_path, "yl569.toml", 'extends = "yl569"\nname = "Ours"\n[spindle]\nmax_rpm = 12000\n')
    machine = load_machine(path)
    assert (machine.name, machine.spindle_max_rpm, machine.axis("B").high) == ("Ours", 12000.0, 100.0)
    assert len(machine.files) == 2


def test_a_machine_changes_one_limit_of_a_shipped_one_in_four_lines(tmp_path: Path) -> None:
    path = written(tmp_path, "ours.toml", 'extends = "yl569"\n[[axis]]\nname = "B"\nlimits_deg = [-5, 95]\n')
    ours, shipped_machines = load_machine(path), load_machine("yl569")
    assert ours.names == shipped_machines.names
    assert (ours.axis("B").low, ours.axis("B").high) == (-5.0, 95.0)
    assert ours.axes[0] == shipped_machines.axes[0]


def test_overrides_act_like_a_file_that_extends_this_one() -> None:
    machine = load_machine("yl569", {"axis": [{"name": "B", "limits_deg": [-1, 2]}]})
    assert (machine.axis("B").low, machine.axis("B").high) == (-1.0, 2.0)
    with pytest.raises(InputError) as caught:
        load_machine("yl569", {"axis": [{"name": "B", "limits_deg": [2, -1]}]})
    assert caught.value.problems[0].file == "overrides"


# A table that extends something of another library


def test_the_control_of_a_machine_extends_a_library_of_controls(tmp_path: Path) -> None:
    controls = tmp_path / "controls"
    written(controls, "stock.toml", 'title = "stock"\n[[word]]\nname = "F"\nn = 3\n[[word]]\nname = "S"\nn = 0\n')
    written(tmp_path, "shelf/base.toml", '[control]\nextends = "stock"\n[[control.word]]\nname = "F"\nn = 5\n')
    mine = 'extends = "base"\n[control]\ntitle = "mine"\n[[control.word]]\nname = "S"\nremove = true\n'
    control = loaded(tmp_path, mine).table("control")
    for _ in range(2):  # reading twice must not use anything up
        table = resolve_extends(control, controls)
        assert table.to_dict() == {"title": "mine", "word": [{"name": "F", "n": 5}]}
        table.raise_problems()
    assert table.location("title") == (str(tmp_path / "mine.toml"), 3)


def test_a_control_table_without_extends_is_read_as_it_is(tmp_path: Path) -> None:
    control = loaded(tmp_path, '[control]\nfamily = "fidia"\n').table("control")
    assert resolve_extends(control, tmp_path).to_dict() == {"family": "fidia"}


def test_a_mistake_in_a_control_table_is_told_with_its_path(tmp_path: Path) -> None:
    table = resolve_extends(loaded(tmp_path, "[control]\nfamily = 5\n").table("control"), tmp_path)
    table.text("family")
    with pytest.raises(InputError, match=r"mine.toml:2: error: control.family is 5; write a text in quotes"):
        table.raise_problems()


# Getters


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
        ("1.0", "integer", "write a whole number"),
        ("true", "integer", "write a whole number"),
        ("1", "flag", "write true or false, without quotes"),
        ('"true"', "flag", "write true or false, without quotes"),
        ("[1, 2, inf]", "vector", "write [a, b, c] with 3 numbers in millimetres"),
        ("[1, 2, true]", "vector", "write [a, b, c] with 3 numbers in millimetres"),
        ("7", "vector", "write [a, b, c] with 3 numbers in millimetres"),
        ("[3, 3]", "interval", "write [low, high] with low < high, in millimetres"),
        ("[1]", "interval", "write [low, high] with low < high, in millimetres"),
        ('"ab"', "texts", 'write ["one", "two"]'),
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
