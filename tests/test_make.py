"""``make.py``: a Python that is too old gets one sentence; and the tests that a change reaches."""

import ast
import subprocess
import sys
from pathlib import Path

import make
import pytest

from tests.support.locations import ROOT
from tests.support.reached import files_of, import_graph, reached_tests, reaches_site

SOURCE = (ROOT / "make.py").read_text(encoding="utf-8")


def test_an_old_python_can_parse_it() -> None:
    ast.parse(SOURCE, feature_version=(3, 6))


@pytest.mark.parametrize("version", [(3, 6, 0), (3, 10, 14)])
def test_an_old_python_gets_one_sentence_and_runs_nothing_else(version: tuple[int, ...]) -> None:
    """Nothing but ``sys`` is imported, and nothing defined, before the version is looked at."""
    script = (
        "import sys\nsource = sys.stdin.read()\nsys.version_info, sys.version = "
        f"{version}, 'an old one'\nsys.modules |= dict.fromkeys(('hashlib', 'os', 'collections.abc', 'pathlib'))\n"
        "exec(compile(source, 'make.py', 'exec'), {'__name__': '__main__'})"
    )
    done = subprocess.run(
        [sys.executable, "-S", "-c", script], input=SOURCE, capture_output=True, encoding="utf-8", check=False
    )
    assert (done.returncode, done.stderr) == (1, "Trunnion needs Python 3.11 or later; this is an\n")


def test_its_head_knows_nothing_that_is_new() -> None:
    documentation, load, check, *_ = ast.parse(SOURCE).body
    assert isinstance(documentation, ast.Expr)
    assert [ast.unparse(each).partition(":")[0] for each in (load, check)] == [
        "import sys",
        "if sys.version_info < (3, 11)",
    ]
    assert not [node for node in ast.walk(check) if isinstance(node, ast.JoinedStr | ast.NamedExpr | ast.Lambda)]


def test_what_its_programs_import_is_compiled_once_whatever_the_shell_says(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    make.run("python", "-S", "-c", "import sys; sys.exit(sys.dont_write_bytecode)", environment=Path(sys.prefix))


def test_a_change_reaches_the_tests_that_import_it_and_belong_to_a_package_that_does() -> None:
    graph = import_graph()

    def reached(*files: str) -> set[str] | None:
        return reached_tests(files, graph)

    of_page, of_words = reached("src/trunnion/viewer/live.py"), reached("src/trunnion/readers/families/fidia/words.py")
    assert of_page is not None
    assert of_words is not None
    assert "tests.viewer.test_live" in of_page
    assert not {name for name in of_page if name.startswith(("tests.output", "tests.readers"))}
    assert {"tests.readers.families.fidia.test_programs", "tests.conversion.test_pairs"} <= of_words
    assert reached("tests/support/batch_work.py") == {
        name for name in graph.find_downstream_modules("tests.support.batch_work") if ".test_" in name
    }
    assert "tests.readers.test_documentation" in (reached("docs/reader.md") or ())
    assert reached("src/trunnion/machines/library/yl569.toml")
    unnamed = "x" * 20  # a file that a test names reaches that test
    assert reached(f"{unnamed}.bin") is None
    assert reached(f"docs/{unnamed}.md") == set()


def test_slow_tests_run_with_a_change_of_themselves_or_their_namesake_only() -> None:
    slow, quick = "tests.matrix.test_matrix", "tests.cl.test_errors"
    assert set(files_of([slow, quick], [])) - set(files_of([], [])) == {"tests/cl/test_errors.py"}
    assert "tests/matrix/test_matrix.py" in files_of([slow], ["tests/matrix/test_matrix.py"])
    assert "tests/cli/test_place.py" in files_of(["tests.cli.test_place"], ["src/trunnion/cli/place.py"])
    assert "tests/cli/test_place.py" not in files_of(["tests.cli.test_place"], ["src/trunnion/cli/post.py"])


def test_the_site_is_built_for_pages_and_for_docstrings_that_it_shows() -> None:
    assert all(reaches_site([file]) for file in ("docs/cl.md", "CHANGELOG.md", "src/trunnion/jobs/post/posting.py"))
    assert not reaches_site(["src/trunnion/verification/verify.py", "src/trunnion/output/families/fidia/writer.py"])
