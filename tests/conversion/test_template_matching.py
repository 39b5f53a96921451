"""Template lines that are only a word of the family match that word, and no other."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.klartext import CONTROLS, SIMULTANEOUS, Post
from tests.support.machines import five_axis_machines
from tests.support.posting import FOOT, HEAD
from trunnion.cli import main
from trunnion.controls import load_control
from trunnion.controls.template import Template
from trunnion.conversion.template_matching import family_value_expressions, line_patterns, match_lines
from trunnion.machines import load_machine


@pytest.fixture
def post(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Post:
    return Post(tmp_path, capfd)


POSITION_MODES = [
    (),
    ("tcpm=function",),
    ("tcpm=function", "orientation=vector"),
    ("retract=m140", "retract_distance=12.5"),
]


@pytest.mark.parametrize("strange", ["M107", "M103 F20", "CALL LBL 99"])
@pytest.mark.parametrize("way", POSITION_MODES)
def test_a_block_that_no_template_says_is_none_of_a_template(way: tuple[str, ...], strange: str, post: Post) -> None:
    """Neither instead of a line that is only ``{tcp_on}`` nor next to it."""
    given = [word for setting in way for word in ("--set", setting)]
    lines = [(k, line) for k, line in enumerate(post(SIMULTANEOUS, *given), 1)]
    control = CONTROLS["dmu65"]
    kind = [control.templates["approach_five_axis"]]
    expected = line_patterns(
        kind, {"primary": "A", "secondary": "C"}, control.settings, family_value_expressions(control)
    )
    values: dict[str, str] = {}
    known = match_lines(lines, expected, values)
    on = next(number for number, line in lines if line.startswith(("M128", "FUNCTION TCPM")))
    assert on in known
    assert values["tcp_on"] == lines[on - 1][1]
    at = lines.index((on, values["tcp_on"]))
    for changed in ([*lines[:at], (0, strange), *lines[at:]], [*lines[:at], (0, strange), *lines[at + 1 :]]):
        assert 0 not in match_lines(changed, expected, {})


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("; tool EM, mill, diameter 10, corner 0.5", {"tool_diameter": "10", "tool_corner_radius": "0.5"}),
        ("; tool EM, mill, diameter 10", {"tool_diameter": "10"}),
        ("; tool EM, mill", {}),
    ],
)
def test_parts_that_may_be_absent_are_read(line: str, found: dict[str, str]) -> None:
    control = CONTROLS["dmu65"]
    patterns = line_patterns([control.templates["operation_start"]], {}, control.settings, {})
    values: dict[str, str] = {}
    assert match_lines([(1, line)], patterns, values) == {1}
    assert values == {"tool_name": "EM", "tool_type": "mill", **found}


def test_a_word_beside_tcp_is_remarked_upon(post: Post, capfd: pytest.CaptureFixture[str]) -> None:
    _, out, _ = post.all(SIMULTANEOUS)
    program = post.folder / "part.h"
    program.write_text(re.sub(r"\n(\d+ M128\n)", r"\nM107\n\1", out), encoding="utf-8")
    assert main(["convert", str(program), "--machine", "dmu65", "--to-cl", "--output", "-"]) == 0
    assert "M107 is not carried over" in capfd.readouterr().err


@pytest.mark.parametrize("name", sorted(five_axis_machines()))
def test_what_a_family_says_now_is_one_of_its_spellings(name: str) -> None:
    control = load_control(load_machine(name).control)
    spoken = family_value_expressions(control)
    for field, value in control.family.template_values(dict(control.settings), None).items():
        if isinstance(value, str):
            assert re.fullmatch(spoken[field], value)


def test_a_part_in_double_brackets_may_be_there_or_not() -> None:
    patterns = line_patterns(
        [Template("program_start", ("O{program}[[ ({title})]]", "(END)"))], {}, {"program": "00001", "title": ""}, {}
    )
    for lines, expected in (
        ("O07118 (FLANGE 7-1182)", {"program": "07118", "title": "FLANGE 7-1182"}),
        ("O07118", {"program": "07118"}),
    ):
        values: dict[str, str] = {}
        assert match_lines([(1, lines), (2, "(END)")], patterns, values) == {1, 2}
        assert values == expected


@pytest.mark.parametrize(
    ("base", "settings"),
    [
        ("haas_umc750", {"program": "07118", "title": "FLANGE B"}),
        ("matsuura_mx330", {"program": "7118", "title": "FLANGE B"}),
    ],
)
def test_what_stands_in_brackets_goes_over(base: str, settings: dict[str, str], tmp_path: Path) -> None:
    (tmp_path / "own.toml").write_text(f'extends = "{base}"\nname = "OWN"\n', encoding="utf-8")
    (tmp_path / "part.cls").write_text(HEAD + FOOT, encoding="utf-8")
    program = tmp_path / "part.nc"
    trunnion.post(tmp_path / "part.cls", machine=base, settings=settings, output=program)
    result = trunnion.convert(program, machine=base, to_machine=tmp_path / "own.toml")
    assert {key: result.settings[key] for key in settings} == settings


def test_a_program_that_must_not_run_is_converted_only_by_force(tmp_path: Path) -> None:
    (tmp_path / "part.cls").write_text(HEAD + FOOT, encoding="utf-8")
    program = tmp_path / "part.mpf"
    settings = {"title": "BLADE", "zero": "0,0,900"}
    trunnion.post(tmp_path / "part.cls", machine="yl569", settings=settings, force=True, output=program)
    with pytest.raises(trunnion.RefusedError, match="says that it must not run as it is"):
        trunnion.convert(program, machine="yl569", to_machine="dmu65")
    result = trunnion.convert(program, machine="yl569", to_machine="dmu65", force=True)
    assert result.settings["title"] == "BLADE"
