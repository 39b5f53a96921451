"""Operations and tools of a definition: what is read, and every mistake at once."""

from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.impeller.definition import read_impeller
from trunnion.impeller.paths.passes import Stepover, Way
from trunnion.impeller.steps import StepKind, file_stem
from trunnion.simulation.tools.sizes import ToolKind

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "impeller"
TEXT = (FOLDER / "impeller.toml").read_text("utf-8").partition("[[tool]]")[0]
TOOLS = """
[[tool]]
number = 1
kind = "flat"
diameter_mm = 20

[[tool]]
number = 4
kind = "ball"
diameter_mm = 4
flute_length_mm = 12
length_mm = 60
"""
FEEDS = "rpm = 8000\nfeed_mm_min = 200\n"


def read(folder: Path, text: str) -> list[tuple[int, str]]:
    """The mistakes of a definition, with their lines counted from the first table of a tool."""
    (folder / "blade_points.csv").write_bytes((FOLDER / "blade_points.csv").read_bytes())
    path = folder / "part.toml"
    path.write_text(TEXT + text, "utf-8")
    with pytest.raises(InputError) as error:
        read_impeller(path)
    return [(problem.line - TEXT.count("\n"), f"{problem.what}; {problem.cure}") for problem in error.value.problems]


def test_the_published_impeller_has_its_six_operations() -> None:
    found = read_impeller(FOLDER / "impeller.toml")
    assert [step.kind for step in found.steps] == [kind for kind in StepKind if kind is not StepKind.FLANK_MILLING]
    sizes = {tool.number: (tool.sizes.kind, tool.sizes.diameter) for tool in found.tools}
    published = [
        (ToolKind.FLAT, 20.0, 2000.0, 500.0), (ToolKind.BALL, 10.0, 3000.0, 200.0),
        (ToolKind.BALL, 6.0, 5000.0, 500.0), (ToolKind.BALL, 6.0, 5000.0, 200.0),
        (ToolKind.BALL, 4.0, 8000.0, 200.0), (ToolKind.BALL, 4.0, 8000.0, 200.0),
    ]  # fmt: skip
    assert [(*sizes[step.tool], step.rpm, step.feed) for step in found.steps] == published
    assert [step.stepover.distance for step in found.steps][1:] == [0.5, 0.8, 0.2, 0.2, 0.2]
    assert found.steps[0].step_down == 1.5


def test_what_a_step_does_not_say_has_its_default(tmp_path: Path) -> None:
    (tmp_path / "blade_points.csv").write_bytes((FOLDER / "blade_points.csv").read_bytes())
    path = tmp_path / "part.toml"
    path.write_text(
        TEXT + TOOLS + f'[[operation]]\nkind = "blade finish"\ntool = 4\nscallop_mm = 0.01\n{FEEDS}', "utf-8"
    )
    (step,) = read_impeller(path).steps
    assert (step.name, step.way, step.stepover) == ("BLADE_FINISH", Way.ONE_WAY, Stepover(scallop=0.01))
    assert (step.lead_feed, step.allowance, step.coolant, step.published_minutes) == (200.0, 0.0, "", 0.0)


def test_every_mistake_is_told_at_once_with_its_line(tmp_path: Path) -> None:
    first, second = TOOLS.count("\n"), TOOLS.count("\n") + 6
    text = TOOLS + '[[operation]]\nkind = "hub finish"\ntool = 1\nstepover_mm = 0.2\nscallop_mm = 0.1\nrpm = "fast"\n'
    text += (
        f'[[operation]]\nkind = "blade finish"\ntool = 9\nstepover_mm = 0\nstep_down_mm = 1\n{FEEDS}way = "zigzag"\n'
    )
    found = dict(read(tmp_path, text))
    assert found[first + 3] == "operation[0].tool 1 is a flat mill; hub finish wants ball or taper_ball"
    assert found[first + 1].startswith("operation[0] needs either stepover_mm or scallop_mm") or (
        found[first + 1].startswith("operation[0].feed_mm_min is missing")
    )
    assert found[first + 6].startswith('operation[0].rpm is "fast"')
    assert (
        found[second + 3]
        == "operation[1].tool 9 is not among the tools; give a [[tool]] of that number; there are 1, 4"
    )
    assert found[second + 4].startswith("operation[1].stepover_mm is 0; write")
    assert found[second + 5].startswith("operation[1].step_down_mm is not a key that is known here")
    assert found[second + 8].startswith('operation[1].way is "zigzag"')


def test_operations_are_told_apart_and_want_tools(tmp_path: Path) -> None:
    step = f'[[operation]]\nkind = "blade finish"\ntool = 4\nstepover_mm = 0.2\n{FEEDS}'
    assert read(tmp_path, TOOLS + step + step) == [
        (TOOLS.count("\n") + 7, "operation[1].name is that of operation[0] too; give each operation a name of its own")
    ]
    ((_, what), *_) = read(tmp_path, step)
    assert "tool" in what


def test_names_are_one_line_and_make_different_files(tmp_path: Path) -> None:
    step = f'[[operation]]\nkind = "blade finish"\nname = "NAME"\ntool = 4\nstepover_mm = 0.2\n{FEEDS}'
    line = TOOLS.count("\n") + 3
    for first, second in (("A B", "a_b"), ("Ä", "A")):
        found = read(tmp_path, TOOLS + step.replace("NAME", first) + step.replace("NAME", second))
        what = (
            "operation[1].name makes the same file name as that of operation[0]; give each operation a name of its own"
        )
        assert found == [(line + 7, what)]
    for name in (" ", r"A\nM3 S9999", r"\u202e", "x" * 81):
        ((at, what),) = read(tmp_path, TOOLS + step.replace("NAME", name))
        assert (at, what.endswith("; write one line of 80 letters at most")) == (line, True)
    ((at, what),) = read(tmp_path, TOOLS.replace("number = 4", 'name = "A\\nM30"\nnumber = 4') + step)
    assert what.startswith('tool[1].name is "A')


def test_names_of_files_are_none_of_a_device() -> None:
    assert [file_stem(name) for name in ("CON", "nul", "CONE", "Gehäuse 2", "A) M30 (B")] == [
        "CON_", "nul_", "CONE", "Gehause_2", "A__M30__B",
    ]  # fmt: skip


def test_a_tool_with_a_mistake_is_not_missing_too(tmp_path: Path) -> None:
    step = f'[[operation]]\nkind = "blade finish"\ntool = 4\nstepover_mm = 0.2\n{FEEDS}'
    ((_, what),) = read(tmp_path, TOOLS.replace("diameter_mm = 4\n", "") + step)
    assert what.startswith("tool[1].diameter_mm is missing")


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        (
            "stepover_mm = 20",
            "stepover_mm = 1e-9",
            "stepover_mm is 1e-09; write a number in millimetres of at least 0.01",
        ),
        (
            "step_down_mm = 5",
            "step_down_mm = 1e-7",
            "step_down_mm is 1e-07; write a number in millimetres of at least 0.01",
        ),
    ],
)
def test_passes_are_not_countless(tmp_path: Path, old: str, new: str, what: str) -> None:
    step = f'[[operation]]\nkind = "stock roughing"\ntool = 1\nstepover_mm = 20\nstep_down_mm = 5\n{FEEDS}'
    assert [what in text for _, text in read(tmp_path, TOOLS + step.replace(old, new))] == [True]
