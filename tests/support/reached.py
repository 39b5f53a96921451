"""The tests for a change: ``python -m tests.support.reached`` prints their files, and ``make.py quick`` runs them.

A change is what differs from the point where this branch left ``main``, committed or not; it reaches tests through
imports. Where nothing can be said (without git, without a change, or if what all tests share has changed) it reaches
all. Of those the nearest are printed, as many as there is processor time for; how many are left out is said on the
side. ``docs`` is printed besides where the change can be seen on the site.
"""

import subprocess
import sys
from collections.abc import Collection, Iterable, Mapping
from pathlib import PurePosixPath
from typing import Final

import grimp

from tests.support.durations import SLOW, UNLISTED, kept
from tests.support.locations import ROOT, TESTS
from trunnion import _MODULES
from trunnion.families import FAMILIES

#: Processor time of tests, s, and what of it the site needs. Two processors have 180 s in a minute and a half. Types,
#: style and contracts take 30 of them where everything imports what has changed; to start, to collect, and to wait for
#: the last test takes the rest.
BUDGET: Final = 100.0
SITE_BUDGET: Final = 45.0

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


def reached_tests(changed: Iterable[str], graph: grimp.ImportGraph) -> dict[str, int] | None:
    """How many imports lead from a change to the tests that it reaches; None: who knows.

    Those are the modules of tests that changed, or import what did and belong to a package that does.
    """
    modules = dict[str, set[str]]()
    for file in changed:
        modules[file] = modules_of(file, graph)
        if not modules[file] and PurePosixPath(file).suffix != ".md":
            return None
    found = {module for each in modules.values() for module in each}
    near = imports_from({module for module in found if module.startswith("tests.")}, graph)
    reached = imports_from(found, graph)
    packages = {parent for module in reached for parent in with_parents(module)} | {None}
    tests = {each: count for each, count in reached.items() if is_test(each)}
    return {each: tests[each] for each in tests if each in near or package_of(each, graph) in packages}


def imports_from(modules: Collection[str], graph: grimp.ImportGraph) -> dict[str, int]:
    """Modules, and all that import them -> how many imports lead there at least."""
    counts, last, count = dict.fromkeys(modules, 0), set(modules), 0
    while last:
        count += 1
        last = {each for module in last for each in graph.find_modules_that_directly_import(module)} - counts.keys()
        counts |= dict.fromkeys(last, count)
    return counts


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


def all_tests() -> dict[str, int]:
    """All tests, each as near as the others."""
    return {f"tests.{module}": 0 for module in TEXTS if is_test(f"tests.{module}")}


def chosen(
    tests: Mapping[str, int], changed: Collection[str], budget: float, seconds: Mapping[str, float]
) -> tuple[list[str], list[str]]:
    """Files to run, and those left out, both from the nearest on and the quickest first of the equally near.

    What changed, and its namesakes, run whatever they take. Tests of the same folder are one import nearer; those of
    the whole count as importing what changed, unless they are slow: then they are farther than all.

    tests    modules of tests that are reached -> how many imports lead there
    budget   processor time, s
    seconds  files of tests, from their folder -> processor time, s
    """
    whole = [path.relative_to(ROOT).as_posix() for path in TESTS.glob("test_*.py")]
    near = {file: 1 if taken(file, seconds) <= SLOW else len(TEXTS) for file in whole}
    near |= {f"{module.replace('.', '/')}.py": count for module, count in tests.items()}
    must = near.keys() & {*changed, *map(namesake, changed)}
    folders = tuple(f"{PurePosixPath(namesake(file)).parent}/" for file in changed if file.startswith("src/trunnion/"))
    near = {file: count - file.startswith(folders) for file, count in near.items()}
    takes = {file: taken(file, seconds) for file in near}
    run, out = list[str](), list[str]()
    for file in sorted(near, key=lambda file: (file not in must, near[file], takes[file], file)):
        fits = file in must or takes[file] <= budget
        budget -= takes[file] if fits else 0.0
        (run if fits else out).append(file)
    return run, out


def taken(file: str, seconds: Mapping[str, float]) -> float:
    """Processor time of a file of tests, s."""
    return seconds.get(file.removeprefix("tests/"), UNLISTED)


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
    said = bool(changed) and not changed.intersection(SHARED_BY_ALL)
    tests = reached_tests(changed, import_graph()) if said else None
    site = reaches_site(changed) or tests is None
    seconds = kept()
    files, out = chosen(
        all_tests() if tests is None else tests, changed, BUDGET - (SITE_BUDGET if site else 0.0), seconds
    )
    sys.stdout.write("".join(f"{file}\n" for file in (*files, *(["docs"] if site else []))))
    if out:
        late = round(sum(taken(file, seconds) for file in out))
        sys.stderr.write(f"quick leaves out {len(out)} files of tests, {late} s; make.py test has them\n")


if __name__ == "__main__":
    main()
