"""The tests are laid out as the sources are, and what several of them use is in ``tests.support``."""

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from tests.support.locations import ROOT, TESTS

SOURCES = ROOT / "src" / "trunnion"

#: Lines of a module, and modules of a folder, at most: what is longer has more than one subject.
MOST_LINES, MOST_MODULES = 400, 40

#: Folders that test more than one part, hold files of the tests, or serve them.
OTHERS = {"data", "examples", "fuzz", "golden", "linuxcnc", "matrix", "support"}

MODULES = sorted(path.relative_to(ROOT) for path in TESTS.rglob("*.py"))


def imports(module: Path) -> Iterator[str]:
    """Yield the modules of the tests that a module imports."""
    for node in ast.walk(ast.parse((ROOT / module).read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names if name.name.split(".")[0] == "tests")
        elif isinstance(node, ast.ImportFrom) and (node.level or (node.module or "").split(".")[0] == "tests"):
            yield "." * node.level + (node.module or "")


def test_tests_share_nothing_but_the_support() -> None:
    found = [(str(module), name) for module in MODULES for name in imports(module)]
    assert [each for each in found if not each[1].startswith("tests.support")] == []


def test_each_folder_tests_a_part_of_the_sources_of_its_name() -> None:
    folders = {path.name for path in TESTS.iterdir() if path.is_dir() and path.name != "__pycache__"} - OTHERS
    sources = {path.stem for path in SOURCES.iterdir()}
    assert sorted(folders - sources) == []


def test_support_has_no_tests() -> None:
    assert not list((TESTS / "support").rglob("test_*.py"))


def test_modules_and_folders_have_one_subject() -> None:
    lines = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in SOURCES.rglob("*.py")}
    long = [str(path.relative_to(SOURCES)) for path, count in lines.items() if count > MOST_LINES]
    modules = Counter(str(path.parent.relative_to(SOURCES)) for path in lines)
    assert (sorted(long), [folder for folder, count in modules.items() if count > MOST_MODULES]) == ([], [])
