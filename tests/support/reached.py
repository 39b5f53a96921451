"""The tests that a change reaches through imports: ``python -m tests.support.reached`` prints their files.

``make.py quick`` runs them. A change is what differs from the point where this branch left ``main``, committed or not.
Nothing is printed where nothing can be said: without git, without a change, or if what all tests share has changed.
``docs`` is printed besides where the change can be seen on the site.
"""

import subprocess
import sys
from collections.abc import Collection, Iterable
from pathlib import PurePosixPath

import grimp

from tests.support.locations import ROOT, TESTS
from tests.support.slow import is_slow
from trunnion import _MODULES
from trunnion.families import FAMILIES

#: Files that may change the outcome of every test.
SHARED_BY_ALL = ("pyproject.toml", "make.py", "tests/conftest.py")

#: Beginnings of what the site is made from: pages, and modules whose docstrings it shows.
SITE = (
    "docs/", "CHANGELOG.md", "CONTRIBUTING.md", "src/trunnion/__init__.py", "src/trunnion/jobs/arguments.py",
    *(f"src/trunnion/{name.replace('.', '/')}{end}" for name in _MODULES.values() for end in (".py", "/__init__.py")),
)  # fmt: skip

#: Texts of the modules of tests.
TEXTS = {
    ".".join(path.relative_to(TESTS).with_suffix("").parts): path.read_text(encoding="utf-8")
    for path in TESTS.rglob("*.py")
}


def changed_files() -> list[str]:
    """Files that differ from where this branch left ``main``; none without git."""
    base = git("merge-base", "HEAD", "main") or git("rev-parse", "HEAD")
    if not base:
        return []
    return [*git("diff", "--name-only", *base), *git("ls-files", "--others", "--exclude-standard")]


def git(*arguments: str) -> list[str]:
    """The lines that git prints; none if it fails, or is not there."""
    try:
        done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, encoding="utf-8", check=False)
    except OSError:
        return []
    return done.stdout.splitlines() if done.returncode == 0 else []


def import_graph() -> grimp.ImportGraph:
    """Who imports whom in sources and tests, with the modules that are imported by their names."""
    graph = grimp.build_graph("trunnion", "tests", cache_dir=None)
    by_name = {("trunnion.families", module) for entry in FAMILIES.values() for module in entry if module}
    by_name |= {("trunnion.cli", module) for module in graph.find_children("trunnion.cli")}
    for importer, imported in by_name:
        if importer != imported:
            graph.add_import(importer=importer, imported=imported)
    return graph


def modules_of(file: str, graph: grimp.ImportGraph) -> set[str]:
    """What a changed file is: a module; of data, the package that it is in, and the modules of tests that name it."""
    path = PurePosixPath(file)
    name = ".".join(PurePosixPath(file.removeprefix("src/")).with_suffix("").parts).removesuffix(".__init__")
    if path.suffix == ".py" and name in graph.modules:
        return {name}
    named = {f"tests.{module}" for module in TEXTS if path.name in TEXTS[module]}
    while name and name not in graph.modules:
        name = name.rpartition(".")[0]
    return named if name in ("", "tests", "trunnion") else named | {name} | graph.find_descendants(name)


def reached_tests(changed: Iterable[str], graph: grimp.ImportGraph) -> set[str] | None:
    """Modules of the tests that changed, or import what did and belong to a package that does; None: who knows."""
    modules = dict[str, set[str]]()
    for file in changed:
        modules[file] = modules_of(file, graph)
        if not modules[file] and PurePosixPath(file).suffix != ".md":
            return None
    found = {module for each in modules.values() for module in each}
    of_tests = {module for module in found if module.startswith("tests.")}
    near = of_tests.union(*map(graph.find_downstream_modules, of_tests))
    reached = found.union(*map(graph.find_downstream_modules, found))
    packages = {parent for module in reached for parent in with_parents(module)} | {None}
    return {each for each in reached if is_test(each) and (each in near or package_of(each, graph) in packages)}


def is_test(module: str) -> bool:
    """Whether a module has tests."""
    return module.startswith("tests.") and module.rpartition(".")[2].startswith("test_")


def with_parents(module: str) -> list[str]:
    """A module and the packages that it is in."""
    parts = module.split(".")
    return [".".join(parts[:count]) for count in range(1, len(parts) + 1)]


def package_of(test: str, graph: grimp.ImportGraph) -> str | None:
    """The package of the sources that the folder of a test stands for; None: it stands for no single one."""
    folders = with_parents("trunnion" + test.rpartition(".")[0].removeprefix("tests"))
    return next((name for name in reversed(folders[1:]) if name in graph.modules), None)


def files_of(modules: Iterable[str], changed: Collection[str]) -> list[str]:
    """Their files but slow ones, unless they changed or are the namesake of what did; with tests of the whole."""
    whole = {path.relative_to(ROOT).as_posix() for path in TESTS.glob("test_*.py")}
    files = whole | {f"{module.replace('.', '/')}.py" for module in modules}
    kept = {*changed, *map(namesake, changed)}
    return sorted(file for file in files if file in kept or not is_slow(ROOT / file))


def namesake(file: str) -> str:
    """The file of tests that a source has for itself alone, whether it is there or not."""
    path = PurePosixPath(file)
    return str(PurePosixPath("tests", *path.parts[2:-1], f"test_{path.name}"))


def reaches_site(changed: Iterable[str]) -> bool:
    """Whether a change can be seen on the site."""
    return any(file.startswith(SITE) for file in changed)


def main() -> None:
    """Print the files of the tests, one a line."""
    changed = set(changed_files())
    if changed and not changed.intersection(SHARED_BY_ALL):
        tests = reached_tests(changed, import_graph())
        if tests is not None:
            site = ["docs"] if reaches_site(changed) else []
            sys.stdout.write("".join(f"{file}\n" for file in (*files_of(tests, changed), *site)))


if __name__ == "__main__":
    main()
