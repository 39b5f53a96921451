"""``make.py``: a Python that is too old gets one sentence; and the tests that a change reaches."""

import ast
import subprocess
import sys
from pathlib import Path

import make
import pytest

from tests.support import durations
from tests.support.locations import ROOT, TESTS
from tests.support.reached import all_tests, chosen, import_graph, reached_tests, reaches_site

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

    def reached(*files: str) -> dict[str, int] | None:
        return reached_tests(files, graph)

    of_page, of_words = reached("src/trunnion/viewer/live.py"), reached("src/trunnion/readers/families/fidia/words.py")
    assert of_page is not None
    assert of_words is not None
    assert "tests.viewer.test_live" in of_page
    assert not {name for name in of_page if name.startswith(("tests.output", "tests.readers"))}
    assert {"tests.readers.families.fidia.test_programs", "tests.conversion.test_pairs"} <= of_words.keys()
    assert (reached("tests/support/batch_work.py") or {}).keys() == {
        name for name in graph.find_downstream_modules("tests.support.batch_work") if ".test_" in name
    }
    assert "tests.readers.test_documentation" in (reached("docs/reader.md") or ())
    assert reached("src/trunnion/machines/library/yl569.toml")
    verifier = reached("src/trunnion/verification/verifier.py") or {}
    assert verifier["tests.verification.test_checks"] < verifier["tests.cli.test_verify"]
    unnamed = "x" * 20  # a file that a test names reaches that test
    assert reached(f"{unnamed}.bin") is None
    assert reached(f"docs/{unnamed}.md") == {}


def test_the_nearest_run_and_of_them_the_quickest_while_there_is_time() -> None:
    tests = {"tests.cl.test_far": 5, "tests.cli.test_near": 2, "tests.cli.test_long": 2, "tests.cl.test_own": 3}
    seconds = {"cli/test_near.py": 4.0, "cli/test_long.py": 20.0, "cl/test_far.py": 3.0, "cl/test_own.py": 5.0}

    def of_folders(files: list[str]) -> list[str]:
        return [file.removeprefix("tests/") for file in files if file.count("/") > 1]

    def run_with(budget: float, *changed: str) -> tuple[list[str], list[str]]:
        of_whole = durations.UNLISTED * len(list(TESTS.glob("test_*.py")))
        run, out = chosen(tests, changed, of_whole + budget, seconds)
        return of_folders(run), of_folders(out)

    near, long, own, far = "cli/test_near.py", "cli/test_long.py", "cl/test_own.py", "cl/test_far.py"
    assert run_with(40.0) == ([near, long, own, far], [])
    assert run_with(12.5) == ([near, own, far], [long])
    assert run_with(1.0) == ([], [near, long, own, far])
    assert run_with(1.0, "src/trunnion/cl/reader.py") == ([], [near, own, long, far])  # those of cl are nearer


def test_what_changed_and_its_namesake_run_whatever_they_take() -> None:
    tests = {"tests.cli.machine.test_place": 1, "tests.matrix.test_matrix": 4}
    seconds = {"cli/machine/test_place.py": 99.0}
    for changed in ("src/trunnion/cli/machine/place.py", "tests/cli/machine/test_place.py"):
        assert "tests/cli/machine/test_place.py" in chosen(tests, [changed], 0.0, seconds)[0]
    assert "tests/cli/machine/test_place.py" not in chosen(tests, ["src/trunnion/cli/post.py"], 98.0, seconds)[0]


def test_where_nothing_can_be_said_all_tests_are_reached() -> None:
    files = {path.relative_to(ROOT).as_posix() for path in TESTS.rglob("test_*.py")}
    assert set(chosen(all_tests(), [], 1e6, {})[0]) == files


def test_durations_are_of_files_that_exist_and_come_from_reports(tmp_path: Path) -> None:
    assert [file for file in durations.kept() if not (TESTS / file).exists()] == []
    report = tmp_path / "report.xml"
    report.write_text(
        '<testsuites><testsuite><testcase classname="tests.cl.test_scan"><properties>'
        '<property name="processor_seconds" value="1.25"/></properties></testcase>'
        '<testcase classname="tests.cl.test_scan"><properties><property name="processor_seconds" value="1.5"/>'
        "</properties></testcase><testcase classname='tests.test_docs'/></testsuite></testsuites>",
        encoding="utf-8",
    )
    found = durations.measured([report])
    assert found == {"cl/test_scan.py": 2.75, "test_docs.py": 0.0}
    assert durations.listing(found).splitlines()[1:] == ['"cl/test_scan.py" = 3']


def test_the_site_is_built_for_pages_and_for_docstrings_that_it_shows() -> None:
    assert all(reaches_site([file]) for file in ("docs/cl.md", "CHANGELOG.md", "src/trunnion/jobs/post/posting.py"))
    assert not reaches_site(["src/trunnion/verification/verify.py", "src/trunnion/output/families/fidia/writer.py"])
