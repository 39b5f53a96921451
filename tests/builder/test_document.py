"""Definitions changed at one place: what is meant changes, and everything else stays as it was."""

import tomllib
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from trunnion.builder.document import FieldPath, UnclearPlaceError, with_table_moved, with_value, without_value
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
