"""Types and values that the library cannot use are errors of the input that name the argument."""

import ast
import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import trunnion
from tests.support.locations import ROOT, YL569
from trunnion.cli.wording import problem_line
from trunnion.errors import argument_problem
from trunnion.messages import foreign

CL = YL569 / "2_hub_rough.cls"
PROGRAM = YL569 / "2_hub_rough.expected.mpf"

POST: dict[str, Any] = {"cl": CL, "machine": "yl569"}
VERIFY: dict[str, Any] = {"nc": PROGRAM, "machine": "yl569"}
CONVERT: dict[str, Any] = {"nc": PROGRAM, "machine": "yl569", "to_cl": True}
DIFF: dict[str, Any] = {"first": PROGRAM, "second": PROGRAM, "machine": "yl569"}

#: A function, its good arguments, and bad values of some of them.
WRONG: list[tuple[Callable[..., Any], dict[str, Any], dict[str, list[Any]]]] = [
    (trunnion.read_cl, {"path": CL}, {"path": [None, 5, b"x", ""], "units": ["foo"], "observer": [None]}),
    (trunnion.load_machine, {"machine": "yl569"}, {"machine": [None, 5, b"yl569", ""]}),
    (
        trunnion.plan,
        POST,
        {"cl": [None, 5, b"x", [None], [CL, 5]], "machine": [None, 5], "settings": ["title=A"], "observer": [None]},
    ),
    (
        trunnion.post,
        POST,
        {
            "cl": [None, 5, b"x", [None], {"a": 1}.values()],
            "machine": [None, 5],
            "settings": ["title=A", ["a"], {5: "x"}, {"title": b"x"}, {"zero": ("a", 2, 3)}, {"tolerance": True}],
            "output": [io.StringIO(), 3, object()],
            "report": [5, b"r.html"],
            "observer": [None, print],
        },
    ),
    (trunnion.read_program, VERIFY, {"nc": [None, 5], "machine": [None], "subprograms": ["abc", None, 5, [None]]}),
    (
        trunnion.verify,
        VERIFY,
        {
            "nc": [None, 5],
            "cl": [None, 5, [5]],
            "machine": [5],
            "subprograms": ["abc", PROGRAM],
            "tolerance": [None, "0.001", "a", 0.0, -1.0, float("nan"), True],
            "span": ["0.1", 0.0],
            "span_tip": ["a"],
            "tool": [[], 0, -1],
            "work_offset": [54, "G99", ""],
            "edge": ["x", 0, 1.5, True, ""],
            "units": ["foo"],
            "frame": ["foo", None],
            "zero": [("a", 2, 3), 5, (1, 2)],
            "tool_length": ["a", -1],
            "observer": [None],
        },
    ),
    (
        trunnion.convert,
        CONVERT,
        {
            "nc": [None, 5],
            "machine": [5],
            "to_dialect": ["apt", 5],
            "output": [io.StringIO(), 3],
            "subprograms": ["abc"],
            "zero": [("a", 2, 3)],
            "tool_length": ["a"],
            "settings": ["title=A"],
            "observer": [None],
        },
    ),
    (
        trunnion.diff,
        DIFF,
        {"first": [None, 5], "second": [None], "machine": [None], "to_machine": [5], "tolerance": [None, "a"],
         "subprograms": ["abc"], "to_subprograms": ["abc"]},
    ),
    (trunnion.write_report, {"result": None, "file": "r.html"}, {"result": [None, 5]}),
]  # fmt: skip

#: What the machine's setup is checked with stands in settings.
PLACES = {"zero": "settings", "tool_length": "settings"}


def what_is_wrong(call: Callable[..., Any], arguments: dict[str, Any], name: str) -> str:
    """What is wrong with the answer to a wrong argument; nothing, if it is named and has a cure."""
    try:
        call(**arguments)
    except trunnion.InputError as error:
        places = {problem.file for problem in error.problems} - {name, PLACES.get(name, name)}
        return f"names {sorted(places)}" if places else "" if all(each.cure for each in error.problems) else "no cure"
    except Exception as error:
        return repr(error)
    return "is taken"


@pytest.mark.parametrize(("function", "arguments", "wrong"), WRONG, ids=[function.__name__ for function, _, _ in WRONG])
def test_a_wrong_argument_is_named(
    function: Callable[..., Any], arguments: dict[str, Any], wrong: dict[str, list[Any]]
) -> None:
    answers = [
        (name, value, what_is_wrong(function, {**arguments, name: value}, name))
        for name, values in wrong.items()
        for value in values
    ]
    assert [answer for answer in answers if answer[-1]] == []


@pytest.mark.parametrize(
    ("arguments", "passed"),
    [
        ({"tool": 2}, True),
        ({"tool": "3"}, False),
        ({"edge": "1", "cl": CL}, True),
        ({"tolerance": 1}, True),
        ({"frame": "absolute"}, True),
    ],
)
def test_values_that_mean_the_same_are_taken(arguments: dict[str, Any], passed: bool) -> None:
    found = trunnion.verify(**{**VERIFY, "cl": CL, **arguments}, columns=False)
    assert found.passed is passed
    assert passed or any("3" in check.summary for check in found.checks if not check.passed)


def test_a_switch_may_be_true_or_false() -> None:
    planned = trunnion.plan(CL, machine="yl569", settings={"tcp": True, "numbers": False, "lower_feed": False})
    assert planned.motions
    with pytest.raises(trunnion.InputError, match="tool_length=MM"):
        trunnion.plan(CL, machine="yl569", settings={"tool_length": "x", "tcp": False})


@pytest.mark.parametrize(
    ("call", "what"),
    [
        (lambda path: trunnion.read_cl(path), "a CL file"),
        (lambda path: trunnion.post(path, machine="yl569"), "a CL file"),
        (lambda path: trunnion.read_program(path, machine="yl569"), "an NC program"),
        (lambda path: trunnion.verify(path, machine="yl569"), "an NC program"),
        (lambda path: trunnion.verify(PROGRAM, machine="yl569", cl=path), "a CL file"),
        (lambda path: trunnion.convert(path, machine="yl569", to_cl=True), "an NC program"),
        (lambda path: trunnion.diff(path, PROGRAM, machine="yl569"), "an NC program"),
        (lambda path: trunnion.diff(PROGRAM, path, machine="yl569"), "an NC program"),
        (lambda path: trunnion.read_program(PROGRAM, machine="yl569", subprograms=[path]), "an NC program"),
        (lambda path: trunnion.load_machine(path), "a machine definition"),
    ],
)
def test_a_file_that_is_not_there_and_a_folder_are_told_alike(
    call: Callable[[Path], Any], what: str, tmp_path: Path
) -> None:
    missing, folder = tmp_path / "missing.toml", tmp_path / "folder"
    folder.mkdir()
    for path, words in ((missing, "file not found"), (folder, f"is a folder, not {what}")):
        with pytest.raises(trunnion.InputError) as raised:
            call(path)
        (problem,) = raised.value.problems
        assert (problem.file, problem.what) == (str(path), words)
        assert problem.cure


#: Options of the command line. Programs and CL files name those that they were written with, and SHDR has a word
#: that ends in hyphens, too.
_OPTION = re.compile(r"--[a-z]{3,}(?!-)\b(?!--)")


def options_in(module: Path) -> list[tuple[str, str]]:
    """The texts of a module that name an option of the command line, each with the module's name."""
    source = module.read_text(encoding="utf-8")
    if "--" not in source:
        return []
    tree = ast.parse(source)
    documents = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    texts = [
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documents
    ]
    return [
        (str(module), text)
        for text in texts
        if _OPTION.search(text) and text != "--set " and "written by --force" not in text
    ]


def test_only_the_command_line_names_its_options() -> None:
    front = {"cli", "options", "declarations", "doors"}
    modules = [path for path in sorted((ROOT / "src" / "trunnion").rglob("*.py")) if front.isdisjoint(path.parts)]
    assert len(modules) > 500
    assert [found for module in modules for found in options_in(module)] == []


def test_the_command_line_puts_its_options_in_place_of_arguments() -> None:
    for problem, line in (
        (argument_problem("work_offset", foreign("is 'x'", "write G54")), "--work-offset: error: is 'x'; write G54"),
        (argument_problem("tool_length", foreign("is 'x'")), "--tool-length: error: is 'x'"),
        (
            trunnion.Problem("a.cls", 3, foreign("b", "setting mode=… sets it")),
            "a.cls:3: error: b; --set mode=… sets it",
        ),
        (trunnion.Problem("a.cls", 0, foreign("b", "force=True writes it")), "a.cls: error: b; --force writes it"),
    ):
        assert problem_line(problem) == line
