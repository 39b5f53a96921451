"""Definitions changed at one place: what is meant changes, and everything else stays as it was."""

import tomllib
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.builder.document import FieldPath, UnclearPlaceError, with_table_moved, with_value, without_value
from trunnion.definitions import layout
from trunnion.machines.loading import machine_library, shipped_machines

TEXT = """# our machine, hall 2
extends = "yl569"   # the nearest one
name = "Hall 2"

# measured in 2024
[[axis]]
name = "B"
limits_deg = [-5, 95] # with the probe

# below is ours

[control.settings] # not more
title = "x"
part = \"\"\"
two
# lines\"\"\"
"""

NAMES = st.sampled_from(["B", "C", "X", "a b", 'q"t', "é"])
KEYS = st.sampled_from(["one", "two", "limits_deg", "name_", "a b"])
PATHS: st.SearchStrategy[FieldPath] = st.one_of(
    st.tuples(KEYS),
    st.tuples(st.sampled_from(["spindle", "facts"]), KEYS),
    st.tuples(st.just("axis"), st.tuples(NAMES), KEYS),
    st.tuples(st.just("control"), st.sampled_from(["settings", "templates"]), KEYS),
    st.tuples(st.just("control"), st.just("format"), st.tuples(NAMES), KEYS),
)
VALUES = st.one_of(
    st.text(st.characters(exclude_categories=["Cs"])).filter(lambda text: "\r" not in text),
    st.booleans(),
    st.integers(-(10**9), 10**9),
    st.floats(-1e9, 1e9),
    st.lists(st.floats(-1e9, 1e9), min_size=1, max_size=3),
)


def test_a_value_is_replaced_and_its_comment_stays() -> None:
    changed = with_value(TEXT, ("axis", ("B",), "limits_deg"), [-7.5, 95.0])
    assert changed == TEXT.replace("[-5, 95] # with", "[-7.5, 95] # with")


def test_a_value_finds_its_table() -> None:
    changed = with_value(TEXT, ("axis", ("B",), "home_deg"), 3.0)
    assert changed == TEXT.replace("# with the probe\n", "# with the probe\nhome_deg = 3\n")


def test_a_new_table_stands_behind_its_like() -> None:
    changed = with_value(TEXT, ("axis", ("C",), "point_mm"), [0.0, 0.0, 1.25])
    entry = '[[axis]]\nname = "C"\npoint_mm = [0, 0, 1.25]\n'
    assert changed == TEXT.replace("# below is ours", entry + "\n# below is ours")


def test_a_key_of_the_file_stands_before_its_tables() -> None:
    changed = with_value(TEXT, ("description",), "two words")
    assert changed == TEXT.replace('name = "Hall 2"\n', 'name = "Hall 2"\ndescription = "two words"\n')


def test_a_template_is_written_line_by_line() -> None:
    text = '%\n{title}\n"M6" \\ """\n'
    changed = with_value("", ("control", "templates", "program_start"), text)
    assert tomllib.loads(changed)["control"]["templates"]["program_start"] == text
    assert "\n{title}\n" in changed


def test_a_value_that_goes_takes_its_line_and_an_empty_table() -> None:
    plain = TEXT.replace(" # with the probe", "")
    changed = without_value(plain, ("axis", ("B",), "limits_deg"))
    assert changed == plain.replace('[[axis]]\nname = "B"\nlimits_deg = [-5, 95]\n', "")
    assert without_value(TEXT, ("control", "settings", "part")) == TEXT.replace('part = """\ntwo\n# lines"""\n', "")


def test_nothing_is_taken_out_that_is_not_there() -> None:
    assert without_value(TEXT, ("axis", ("C",), "limits_deg")) == TEXT


MEASURED = """[[axis]]
name = "X"
limits_mm = [
  -250, # measured, switch
  250,  # hard stop at 252
]
home_mm = 10 # from MD34100
"""


def test_a_list_with_comments_is_changed_number_by_number() -> None:
    path = ("axis", ("X",), "limits_mm")
    assert with_value(MEASURED, path, [-240, 250]) == MEASURED.replace("-250", "-240")
    assert with_value(MEASURED, path, [-250.5, 251.0]) == MEASURED.replace("-250", "-250.5").replace(" 250,", " 251,")
    others: list[Any] = [[-240, 0, 250], "-240, 250", 5]
    for other in others:
        with pytest.raises(UnclearPlaceError):
            with_value(MEASURED, path, other)


def test_a_number_that_stays_is_not_written_anew() -> None:
    changed = with_value("direction = [ 0.50,1e-1 , 0x10 ]\n", ("direction",), [0.5, 0.1, 17])
    assert changed == "direction = [ 0.50,1e-1 , 17 ]\n"


def test_comments_stay_where_their_value_goes() -> None:
    changed = without_value(MEASURED, ("axis", ("X",), "home_mm"))
    assert changed == MEASURED.replace("home_mm = 10 # from", "# from")
    assert without_value(changed, ("axis", ("X",), "limits_mm")) == (
        '[[axis]]\nname = "X"\n# measured, switch\n# hard stop at 252\n# from MD34100\n'
    )


def test_a_comment_that_stays_is_not_that_of_the_next_table() -> None:
    text = '[[axis]]\nname = "X"\nhome_mm = 1 # of X\n[[axis]]\nname = "Y"\n'
    changed = without_value(text, ("axis", ("X",), "home_mm"))
    assert with_table_moved(changed, "axis", "Y", -1).endswith('name = "X"\n# of X\n')


@pytest.mark.parametrize("value", ["nan", "inf", "1979-05-27", "07:32:00", "[{ a = 1 }]"])
def test_what_no_field_holds_stands_in_nobodys_way(value: str) -> None:
    changed = with_value(f"one = {value}\ntwo = 2\n", ("two",), 3)
    assert changed == f"one = {value}\ntwo = 3\n"
    assert with_value(changed, ("one",), 1) == "one = 1\ntwo = 3\n"


@pytest.mark.parametrize(
    "text",
    [
        'axis = [{name = "X"}, {name = "Y"}]\n',
        '[[axis]]\nname = "X"\n[spindle]\n[axis.more]\na = 1\n[[axis]]\nname = "Y"\n',
    ],
)
def test_axes_that_are_not_tables_of_their_own_do_not_move(text: str) -> None:
    with pytest.raises(UnclearPlaceError):
        with_table_moved(text, "axis", "Y", -1)


@pytest.mark.parametrize(
    "text", ["axis = [1, 2]\n", 'axis = ["Y"]\n', "axis = 5\n", 'axis = "XY"\n', "axis = [{a = 1}]\n"]
)
def test_what_is_no_axis_does_not_move(text: str) -> None:
    assert with_table_moved(text, "axis", "Y", -1) == text


BLANKS = st.sampled_from(["", "", " ", "\t", "  "])
GAPS = st.lists(BLANKS, max_size=2).map(lambda blanks: "".join(f"{each}\n" for each in blanks))
ENDS = st.tuples(BLANKS, st.sampled_from(["", "# of its line", "#", "# [[axis]]"])).map("".join)


@st.composite
def axis_texts(draw: st.DrawFn) -> str:
    """A definition with axes, with blanks and comments wherever TOML allows them."""
    text = draw(st.sampled_from(["", "# head\n", 'name = "x"\n', 'name = "x" \n\n']))
    for name in draw(st.sampled_from(["XY", "XYZ", "XYZB"])):
        indent = draw(BLANKS)
        above = draw(st.sampled_from(["", f"# of {name}", f"## of {name} \n{indent}# more"]))
        lines = [*([above] if above else []), f"[[axis]]{draw(ENDS)}", f'name = "{name}"{draw(ENDS)}', "b = 1"]
        lines += draw(
            st.sampled_from([[], ["limits_mm = [\n 1, # low\n 2 ]"], [f'note = """\n# {name}\n[[axis]]\n"""']])
        )
        lines += [f"[axis.more]{draw(ENDS)}", "a = 1"] if draw(st.booleans()) else []
        text += "".join(f"{indent}{line}\n" for line in lines[:-1]) + f"{indent}{lines[-1]}{draw(ENDS)}\n" + draw(GAPS)
    text += draw(st.sampled_from(["", "# foot\n[facts]\na = 1\n", "[facts] # foot\na = 1\n"]))
    return text.removesuffix("\n") if draw(st.booleans()) else text


def comments(text: str) -> list[str]:
    return sorted(text[begin:end] for begin, end in layout(text).comments)


@given(axis_texts(), st.sampled_from("XYZB"), st.sampled_from([-1, 1]))
def test_axes_change_places_and_nothing_else(text: str, name: str, by: int) -> None:
    moved = with_table_moved(text, "axis", name, by)
    names = [item["name"] for item in tomllib.loads(text)["axis"]]
    if name not in names or not 0 <= names.index(name) + by < len(names):
        assert moved == text
        return
    k = names.index(name)
    names[k], names[k + by] = names[k + by], names[k]
    assert [item["name"] for item in tomllib.loads(moved)["axis"]] == names
    assert sorted(moved.split("\n")) == sorted(text.split("\n"))
    assert with_table_moved(moved, "axis", name, -by) == text


@given(axis_texts(), PATHS, VALUES)
def test_a_change_leaves_every_line_and_its_return_every_letter(text: str, path: FieldPath, value: Any) -> None:
    changed = with_value(text, path, value)
    assert read(changed, path) == value
    assert comments(changed) == comments(text)
    assert is_part(text.split("\n"), changed.split("\n"))
    assert without_value(changed, path).removesuffix("\n") == text.removesuffix("\n")


def is_part(few: list[str], many: list[str]) -> bool:
    """Whether lines are all there, in their order."""
    left = iter(many)
    return all(line in left for line in few)


@given(axis_texts(), st.sampled_from("XYZB"), st.sampled_from(["limits_mm", "note"]))
def test_what_goes_leaves_its_comments(text: str, name: str, key: str) -> None:
    changed = without_value(text, ("axis", (name,), key))
    assert comments(changed) == comments(text)


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ("axis = [{name = 'B', home_deg = 1}]\n", ("axis", ("C",), "home_deg")),
        ("spindle.max_rpm = 5\n", ("spindle", "min_rpm")),
        ("spindle = 5\n", ("spindle", "min_rpm")),
        ("[spindle]\nmax_rpm = { a = 1 }\n", ("spindle", "max_rpm", "a", "b")),
    ],
)
def test_what_has_no_plain_place_is_refused(text: str, path: FieldPath) -> None:
    with pytest.raises((UnclearPlaceError, KeyError, TypeError)):
        with_value(text, path, 1)


def test_an_inline_table_takes_a_value() -> None:
    changed = with_value("spindle = { max_rpm = 5 }\n", ("spindle", "min_rpm"), 1)
    assert changed == "spindle = { max_rpm = 5, min_rpm = 1 }\n"


def read(text: str, path: FieldPath) -> Any:
    found: Any = tomllib.loads(text)
    for step in path:
        found = next(item for item in found if item["name"] == step[0]) if isinstance(step, tuple) else found[step]
    return found


@given(st.lists(st.tuples(PATHS, VALUES), min_size=1, max_size=6))
def test_any_change_is_read_back_and_taken_back(changes: list[tuple[FieldPath, Any]]) -> None:
    text = TEXT
    for path, value in changes:
        text = with_value(text, path, value)
        assert read(text, path) == value
        for comment in ("# our machine, hall 2", "# the nearest one", "# measured in 2024", "# not more"):
            assert comment in text
    for path, _ in changes:
        text = without_value(text, path)
    changed = {path for path, _ in changes}
    before, after = tomllib.loads(TEXT), tomllib.loads(text)
    if not any(path[0] == "axis" for path in changed):
        assert after.get("axis") == before["axis"]
    assert after["control"]["settings"] == before["control"]["settings"]
    assert after["name"] == before["name"]


@pytest.mark.parametrize("name", shipped_machines())
def test_shipped_definitions_keep_every_other_line(name: str) -> None:
    text = machine_library().joinpath(f"{name}.toml").read_text(encoding="utf-8")
    axis = tomllib.loads(text)["axis"][0]
    changed = with_value(text, ("axis", (axis["name"],), "direction"), [0.0, 0.5, 1.0])
    differing = [(a, b) for a, b in zip(text.split("\n"), changed.split("\n"), strict=True) if a != b]
    assert len(differing) == 1
    assert differing[0][1].startswith("direction = [0, 0.5, 1]")


def test_axes_change_places_with_their_comments() -> None:
    text = '# of A\n[[axis]]\nname = "A"\n\n# of B\n[[axis]]\nname = "B"\nhome_deg = 1\n\n[facts]\n'
    moved = '# of B\n[[axis]]\nname = "B"\nhome_deg = 1\n\n# of A\n[[axis]]\nname = "A"\n\n[facts]\n'
    assert with_table_moved(text, "axis", "B", -1) == moved
    assert with_table_moved(moved, "axis", "B", 1) == text
    assert with_table_moved(text, "axis", "A", -1) == text
