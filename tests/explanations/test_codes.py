"""Every message carries a code, every code is explained, and no explanation is of something that is never said."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import trunnion
from tests.support.codes_page import PAGE, page
from trunnion.cli import main
from trunnion.explanations import SUBJECTS, explanations

SOURCES = sorted((Path(trunnion.__file__).parent).rglob("*.py"))

#: What makes a message.
MAKERS = {"Problem", "argument_problem", "Diagnostic"}

CODE = re.compile(r"^[A-Z]{2,3}\d{3}$")


def calls() -> Iterator[tuple[Path, ast.Call]]:
    """Every call that makes a message."""
    for path in SOURCES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in MAKERS:
                yield path, node


def literals() -> set[str]:
    """Every text of the sources that looks like a code."""
    return {
        node.value
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and CODE.match(node.value)
    }


def test_every_message_carries_a_code() -> None:
    without = [
        f"{path.name}:{call.lineno}"
        for path, call in calls()
        if any(isinstance(arg, ast.JoinedStr | ast.Constant) for arg in call.args[2:3])
        and not any(keyword.arg in ("code", None) for keyword in call.keywords)
    ]
    assert not without, f"{len(without)} messages without a code: {without}"


def test_every_code_that_is_said_is_explained_and_the_other_way_round() -> None:
    explained = {code for code in explanations() if CODE.match(code)}
    assert literals() == explained


def test_explanations_are_sentences() -> None:
    for found in explanations().values():
        assert not found.title.endswith("."), found.code
        for text in (found.means, found.matters, found.cure):
            assert text.endswith("."), found.code
            assert text[0].isupper() or text[0] == "`", found.code


def test_codes_stand_in_their_order_under_their_subject() -> None:
    for subject in SUBJECTS:
        codes = [found.code for found in explanations().values() if found.subject == subject and CODE.match(found.code)]
        assert codes == sorted(codes), subject
        assert len({code[:-3] for code in codes}) <= 1, subject


def test_the_page_is_complete() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "run: python -m tests.support.codes_page"


def test_a_code_is_explained_as_messages_write_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "[arg110]"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("ARG110: There is no such code\n")
    assert "At the machine: " in out
    assert "What to do: " in out


def test_settings_are_options_on_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert "setting rewind=none" in trunnion.explain("PLN220").cure
    assert main(["explain", "PLN220"]) == 0
    assert "--set rewind=none" in " ".join(capsys.readouterr().out.split())


def test_a_code_that_is_none_has_a_cure(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "ARG11O"]) == 2
    told = capsys.readouterr().err
    assert 'did you mean "ARG110"?' in told
    assert told.startswith("ARG11O: error: ")


def test_codes_that_there_are_are_explained_beside_one_that_there_is_not(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "CL110", "FOO", "tip", "BAR"]) == 2
    out, err = capsys.readouterr()
    assert [line.partition(":")[0] for line in out.splitlines() if line.startswith(("CL110", "tip"))] == [
        "CL110",
        "tip",
    ]
    assert [line.partition(":")[0] for line in err.splitlines()] == ["FOO", "BAR"]


def test_all_codes_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain"]) == 0
    out = capsys.readouterr().out
    assert all(re.search(rf"^  {code} ", out, re.MULTILINE) for code in explanations())
    assert all(title in out for title in SUBJECTS.values())
