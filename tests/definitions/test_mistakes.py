"""What a definition is told when it is wrong: the file, the line, the key, and what puts it right."""

from pathlib import Path

import pytest

from trunnion.definitions import load_table
from trunnion.errors import InputError, Problem
from trunnion.jobs.describe.definition_checks import machine_problems
from trunnion.machines import load_machine
from trunnion.machines.loading import machine_library

SOUND = """\
schema = 1
name = "Test"

[[axis]]
name = "C"
kind = "rotary"
carries = "part"
direction = [0, 0, 1]
point_mm = [0, 0, 0]
endless = true

[[axis]]
name = "B"
kind = "rotary"
carries = "part"
direction = [0, 1, 0]
point_mm = [0, 0, -50]
limits_deg = [-11, 100]

[[axis]]
name = "X"
kind = "linear"
carries = "tool"
direction = [1, 0, 0]
limits_mm = [-250, 250]

[[axis]]
name = "Y"
kind = "linear"
carries = "tool"
direction = [0, 1, 0]

[[axis]]
name = "Z"
kind = "linear"
carries = "tool"
direction = [0, 0, 1]
"""


def line_of(text: str, part: str) -> int:
    """Line of the first place where the part stands."""
    return text[: text.index(part)].count("\n") + 1


def told(tmp_path: Path, text: str, name: str = "shop.toml") -> list[Problem]:
    """Everything that a definition is told, by file and line."""
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_machine(path)
    return list(caught.value.problems)


def told_once(tmp_path: Path, old: str, new: str) -> tuple[int, str, str]:
    """Line, fact and cure of the one mistake that a change to the sound definition makes."""
    assert SOUND.count(old) >= 1
    text = SOUND.replace(old, new, 1)
    problems = told(tmp_path, text)
    assert len(problems) == 1, problems
    assert problems[0].file == str(tmp_path / "shop.toml")
    return problems[0].line, problems[0].what, problems[0].cure


def test_the_definition_that_the_mistakes_are_made_in_is_sound(tmp_path: Path) -> None:
    path = tmp_path / "shop.toml"
    path.write_text(SOUND, encoding="utf-8")
    assert load_machine(path).names == ("C", "B", "X", "Y", "Z")


def test_an_unknown_key_is_named_with_the_one_that_was_meant(tmp_path: Path) -> None:
    assert told_once(tmp_path, "carries = ", 'positiv = "reversed"\ncarries = ') == (
        7,
        "axis C positiv is not a key that is known here",
        'did you mean "positive"?',
    )


def test_an_unknown_table_is_named_too(tmp_path: Path) -> None:
    line, what, cure = told_once(tmp_path, "\n[[axis]]", "\n[spindel]\nmax_rpm = 9000\n\n[[axis]]")
    assert (line, what, cure) == (4, "spindel is not a key that is known here", 'did you mean "spindle"?')


def test_a_key_with_the_unit_of_another_kind_of_axis_is_told_the_right_unit(tmp_path: Path) -> None:
    problems = told(tmp_path, SOUND.replace("limits_deg", "limits_mm", 1))
    assert [(p.line, p.what, p.cure) for p in problems] == [
        (
            12,
            "axis B limits_deg is missing",
            "write [low, high] with low < high, in degrees, or endless = true",
        ),
        (18, "axis B limits_mm has a unit that does not fit here", "write limits_deg, in degrees"),
    ]


def test_a_number_with_its_unit_in_quotes_is_told_to_take_both_off(tmp_path: Path) -> None:
    assert told_once(tmp_path, "endless = true", 'endless = true\nrapid_deg_min = "5760 deg/min"') == (
        11,
        'axis C rapid_deg_min is "5760 deg/min"',
        "write a number in degrees per minute above 0, without quotes and unit: rapid_deg_min = 5760",
    )


def test_a_negative_speed_is_refused(tmp_path: Path) -> None:
    line, what, cure = told_once(tmp_path, "endless = true", "endless = true\nrapid_deg_min = -5")
    assert (line, what) == (11, "axis C rapid_deg_min is -5")
    assert cure == "write a number in degrees per minute above 0"


def test_parallel_rotary_axes_cannot_orient_a_tool(tmp_path: Path) -> None:
    line, what, cure = told_once(tmp_path, "direction = [0, 1, 0]", "direction = [0, 0, -1]")
    assert (line, what) == (
        16,
        "axis B direction is parallel to that of C: the machine could not orient a tool",
    )
    assert cure == "write the directions of the two rotary axes as they are built"


def test_a_second_rotary_axis_along_the_spindle_cannot_tilt_it(tmp_path: Path) -> None:
    swapped = SOUND.replace('name = "C"', 'name = "?"').replace("[0, 0, 1]", "[0, 1, 0]", 1)
    text = swapped.replace("[0, 1, 0]\npoint_mm = [0, 0, -50]", "[0, 0, 1]\npoint_mm = [0, 0, -50]")
    problems = told(tmp_path, text.replace('"?"', '"A"'))
    assert [(p.line, p.what) for p in problems] == [
        (
            16,
            "axis B direction is parallel to the spindle: B turns the tool about itself, and A alone tilts it",
        )
    ]
    assert (
        problems[0].cure == "the rotary axis further from the workpiece must tilt the tool: check the order of the axes"
    )


def test_slides_in_one_plane_do_not_reach_every_point(tmp_path: Path) -> None:
    text = SOUND.replace('carries = "tool"\ndirection = [0, 0, 1]', 'carries = "tool"\ndirection = [1, 1, 0]')
    (problem,) = told(tmp_path, text)
    assert problem.line == line_of(text, "[1, 1, 0]")
    assert problem.what.startswith("axis Z direction and those of the other linear axes (X, Y, Z) do not reach")


def test_limits_the_wrong_way_round_are_shown_the_right_way(tmp_path: Path) -> None:
    assert told_once(tmp_path, "[-11, 100]", "[100, -11]") == (
        18,
        "axis B limits_deg is [100, -11]",
        "write [low, high] with low < high, in degrees: [-11, 100]?",
    )


def test_two_axes_of_the_same_name_are_shown_to_each_other(tmp_path: Path) -> None:
    line, what, cure = told_once(tmp_path, 'name = "B"', 'name = "c"')
    assert line == 13
    assert what == f'axis[1].name is "c", the name of axis[0] too ({tmp_path / "shop.toml"}:5)'
    assert cure == "give every axis its own name"


def test_four_axes_are_counted_by_kind(tmp_path: Path) -> None:
    text = SOUND[: SOUND.rindex("[[axis]]")]
    (problem,) = told(tmp_path, text)
    assert (problem.line, problem.what) == (4, "axis has 2 linear and 2 rotary axes")
    assert problem.cure == "write three linear axes and the rotary ones, two at most, from the workpiece to the tool"


def test_a_file_without_axes_is_told_what_is_missing(tmp_path: Path) -> None:
    problems = told(tmp_path, 'schema = 1\nname = "Nothing"\n')
    assert [(p.line, p.what, p.cure) for p in problems] == [(1, "axis is missing", "write tables [[axis]]")]


def test_a_misspelt_kind_is_told_the_kinds_and_nothing_is_guessed_from_it(tmp_path: Path) -> None:
    assert told_once(tmp_path, 'kind = "rotary"', 'kind = "rotry"') == (
        6,
        'axis C kind is "rotry"',
        'did you mean "rotary"? write one of "linear", "rotary"',
    )


def test_a_part_axis_after_a_tool_axis_is_out_of_order(tmp_path: Path) -> None:
    text = SOUND[: SOUND.rindex("carries")] + SOUND[SOUND.rindex("carries") :].replace('"tool"', '"part"')
    (problem,) = told(tmp_path, text)
    assert problem.line == text[: text.rindex("carries")].count("\n") + 1
    assert problem.what == 'axis Z carries is "part", but Y before it carries the tool'
    assert problem.cure == "order the axes from the workpiece to the tool: all that carry the part come first"


def test_limits_of_an_endless_axis_contradict_it(tmp_path: Path) -> None:
    line, what, cure = told_once(tmp_path, "endless = true", "endless = true\nlimits_deg = [0, 360]")
    assert (line, what) == (11, "axis C limits_deg is given for an endless axis")
    assert cure == "remove limits_deg, or write endless = false"


def test_an_axis_with_limits_is_not_folded_into_one_turn(tmp_path: Path) -> None:
    line, what, _ = told_once(tmp_path, "[-11, 100]", '[-11, 100]\noutput = "0..360"')
    assert (line, what) == (19, 'axis B output is "0..360" for an axis with limits')


def test_a_home_outside_of_the_limits_is_refused(tmp_path: Path) -> None:
    line, what, _ = told_once(tmp_path, "[-250, 250]", "[-250, 250]\nhome_mm = 300")
    assert (line, what) == (26, "axis X home_mm is 300, outside of the limits -250 to 250")


def test_a_zero_direction_is_none(tmp_path: Path) -> None:
    line, what, cure = told_once(tmp_path, "direction = [0, 0, 1]", "direction = [0, 0, 0]")
    assert (line, what, cure) == (8, "axis C direction is [0, 0, 0]", "write a vector that has a direction")


def test_a_vector_with_two_numbers_is_told_that_it_needs_three(tmp_path: Path) -> None:
    assert told_once(tmp_path, "point_mm = [0, 0, 0]", "point_mm = [0, 0]") == (
        9,
        "axis C point_mm is [0, 0]",
        "write [a, b, c] with 3 numbers in millimetres",
    )


def test_missing_keys_are_told_at_the_line_of_their_table(tmp_path: Path) -> None:
    assert told_once(tmp_path, 'carries = "part"\n', "") == (
        4,
        "axis C carries is missing",
        'write one of "part", "tool"',
    )


def test_a_schema_of_the_future_is_not_guessed_at(tmp_path: Path) -> None:
    line, what, cure = told_once(tmp_path, "schema = 1", "schema = 2")
    assert (line, what) == (1, "schema is 2")
    assert cure == "write 1"


def test_several_mistakes_are_reported_at_once_in_the_order_of_lines(tmp_path: Path) -> None:
    text = SOUND.replace('name = "Test"', 'nam = "Test"').replace("[-11, 100]", "[100, -11]")
    text = text.replace("limits_mm = [-250, 250]", 'limits_mm = "wide"').replace("[[axis]]", "[[axis]]\ncolour = 1", 1)
    assert [(p.line, p.what) for p in told(tmp_path, text)] == [
        (1, "name is missing"),
        (2, "nam is not a key that is known here"),
        (5, "axis C colour is not a key that is known here"),
        (19, "axis B limits_deg is [100, -11]"),
        (26, 'axis X limits_mm is "wide"'),
    ]


def test_a_mistake_in_an_extended_file_is_told_at_that_file(tmp_path: Path) -> None:
    base = SOUND.replace("[-11, 100]", "[100, -11]")
    (tmp_path / "base.toml").write_text(base, encoding="utf-8")
    (problem,) = told(tmp_path, 'extends = "base.toml"\nname = "Mine"\n')
    assert (problem.file, problem.line) == (str(tmp_path / "base.toml"), 18)


def test_extends_in_a_circle_is_told_the_circle(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text('extends = "b.toml"\n', encoding="utf-8")
    (tmp_path / "b.toml").write_text('name = "b"\nextends = "shop.toml"\n', encoding="utf-8")
    (problem,) = told(tmp_path, 'name = "s"\n\nextends = "a.toml"\n')
    assert (problem.file, problem.line) == (str(tmp_path / "b.toml"), 2)
    assert problem.what == "extends goes in a circle: shop.toml extends a.toml extends b.toml extends shop.toml"
    assert problem.cure == "remove one extends"


def test_a_file_that_extends_itself_is_a_circle_too(tmp_path: Path) -> None:
    (problem,) = told(tmp_path, 'extends = "./shop.toml"\n')
    assert problem.what == "extends goes in a circle: shop.toml extends shop.toml"


def test_a_shipped_machine_that_does_not_exist_is_told_the_near_one(tmp_path: Path) -> None:
    (problem,) = told(tmp_path, 'name = "x"\nextends = "yl596"\n')
    assert (problem.line, problem.what) == (2, 'extends: nothing shipped is called "yl596"')
    assert problem.cure == 'did you mean "yl569"?'


def test_an_unknown_machine_is_told_what_is_shipped() -> None:
    with pytest.raises(
        InputError, match=r"write the path of a \.toml file, or one of desk_mill_a, dmu65, generic_head_head_ca"
    ):
        load_machine("no such machine")


def test_what_does_not_fit_a_shipped_file_is_told_of_the_own_one(tmp_path: Path) -> None:
    """Nobody is sent into the folder of the installation: a line of one's own is the cause."""
    own = tmp_path / "ours.toml"
    for text in ('[[axis]]\nname = "X"\ndirection = [0, 1, 0]\n', "[control.format]\nlinear = 0\n"):
        own.write_text(f'extends = "yl569"\nname = "Ours"\n{text}', encoding="utf-8")
        problems = machine_problems(load_table(own, machine_library(), kind="machine"), "ours")
        assert problems
        assert {problem.file for problem in problems} == {str(own)}
        assert not any(str(machine_library()) in problem.what for problem in problems)
    assert any("(inherited from sinumerik_840d.toml:" in problem.what for problem in problems)
