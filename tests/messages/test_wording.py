"""A wording is data until somebody asks for its text, in the words of who asks."""

import pickle
import subprocess
import sys

import pytest

from trunnion.errors import Problem, Severity, argument_problem, merge_repeated, setting_problem
from trunnion.messages import LIBRARY, Wording, Words, filled_in, foreign, phrase


class Shouting(Words):
    def setting(self, name: str, value: str) -> str:
        return f"{name.upper()} := {value}"


FILE = Wording("FIL130", "folder_not", subject="an NC program")


def test_a_problem_has_the_text_of_its_wording() -> None:
    problem = Problem("a.nc", 0, FILE)
    assert (problem.what, problem.cure, problem.code) == (
        "is a folder, not an NC program", "give the path of an NC program", "FIL130",
    )  # fmt: skip
    assert str(problem) == "a.nc: error: is a folder, not an NC program; give the path of an NC program [FIL130]"


def test_problems_are_compared_kept_and_sent_as_data() -> None:
    problem = Problem("a.nc", 3, FILE, severity=Severity.WARNING)
    assert pickle.loads(pickle.dumps(problem)) == problem
    assert len({problem, Problem("a.nc", 3, Wording("FIL130", "folder_not", subject="an NC program"),
                                 Severity.WARNING)}) == 1  # fmt: skip
    assert dict(problem.wording.parameters) == {"subject": "an NC program"}


def test_what_differs_in_its_line_alone_is_said_once() -> None:
    (one,) = merge_repeated(Problem("a.nc", line, FILE) for line in (3, 5, 9))
    assert (one.line, one.what) == (3, "is a folder, not an NC program (3 times, first here)")


@pytest.mark.parametrize(
    ("template", "parameters", "text"),
    [
        ("{count:# line is|# lines are} long", {"count": 1}, "1 line is long"),
        ("{count:# line is|# lines are} long", {"count": 0}, "0 lines are long"),
        ("{length:.2f} mm of {{x}}", {"length": 0.125}, "0.12 mm of {x}"),
        ("write one of {known:, }", {"known": ("a", "b")}, "write one of a, b"),
        ("write {setting:tool={number}}; {switch:force}", {"number": 5}, "write setting tool=5; force=True"),
        ("give {argument:zero=X,Y,Z}", {}, "give argument zero=X,Y,Z"),
    ],
)
def test_templates(template: str, parameters: dict[str, object], text: str) -> None:
    assert filled_in(template, LIBRARY, parameters) == text


def test_a_front_has_words_of_its_own() -> None:
    assert filled_in("write {setting:tool={number}}", Shouting(), {"number": 5}) == "write TOOL := 5"


def test_a_part_is_said_in_the_words_of_the_whole() -> None:
    wording = Wording("PLN410", "no_lean", angle=2.0, axis="C", line=3, cure=phrase("lower_feed_lowers"))
    assert wording.cure == "setting lower_feed=yes lowers the feed there"
    assert wording.text("cure", Shouting()) == "LOWER_FEED := yes lowers the feed there"


@pytest.mark.parametrize("code", ["FIL130", "XYZ999"])
def test_a_text_that_is_missing_hides_no_problem(code: str) -> None:
    problem = Problem("a.nc", 4, Wording(code, "no_such_text", file="b.nc", count=3))
    assert str(problem) == f"a.nc:4: error: no such text count=3 file=b.nc [{code}]"


def test_a_parameter_that_is_missing_hides_no_problem() -> None:
    assert Wording("FIL130", "folder_not", other="x").what == "folder not other=x"


def test_texts_of_others_are_said_as_they_are() -> None:
    assert str(Problem("a.nc", 1, foreign("is odd", "mend it", "X"))) == "a.nc:1: error: is odd; mend it [X]"
    assert foreign("{x}").what == "{x}"


def test_texts_that_are_filled_in_can_be_changed() -> None:
    wording = Wording("FIL130", "folder_not", subject="/tmp/a").within("of", name="/tmp/b")
    assert wording.changed(lambda text: text.replace("/tmp/", "")).what == "b: is a folder, not a"


def test_a_problem_knows_what_it_is_with() -> None:
    assert argument_problem("cell", FILE).argument == "cell"
    tool = setting_problem("tool", Wording("FIL130", "folder_not", subject="x"))
    assert (tool.setting, tool.argument, tool.what) == ("tool", "settings", "tool is a folder, not x")
    assert Problem("a.nc", 0, FILE).argument == ""


def test_no_catalogue_is_read_before_a_text_is_asked_for() -> None:
    script = (
        "import sys\nfrom trunnion.errors import Problem\nfrom trunnion.messages import Wording, catalogue\n"
        "problem = Problem('a', 0, Wording('FIL130', 'folder_not', subject='x'))\n"
        "assert 'tomllib' not in sys.modules and not catalogue.cache_info().currsize\n"
        "str(problem)\nassert catalogue.cache_info().currsize == 2"  # its own, and that of the word error
    )
    subprocess.run([sys.executable, "-c", script], check=True)
