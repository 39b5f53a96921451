"""The tests that may run a line: those that mention the function that it is in, or one that mentions it, and so on."""

import ast
import re
from collections import defaultdict
from collections.abc import Collection, Iterator
from functools import cached_property
from heapq import heappop, heappush
from math import inf, log2
from pathlib import Path
from typing import NamedTuple

#: Tests of the first round: most mutants die in it. Each has three times as many as the one before.
FIRST_ROUND = 8

_COMPILED = re.compile(rb"^@(?:kernel|inner)", re.MULTILINE)


class Part(NamedTuple):
    """A function, or another statement of a module or class, with the names by which others know it."""

    last: int
    names: frozenset[str]
    mentions: frozenset[str]
    test: str


class Sources:
    """All parts of sources and tests, and which mentions which name."""

    def __init__(self, root: Path, slow: Collection[str] = ()) -> None:
        self.slow = tuple(f"tests/{name}" for name in slow)
        self.parts, self.compiled = dict[str, list[Part]](), set[str]()
        for path in (path for folder in ("src", "tests") for path in sorted((root / folder).rglob("*.py"))):
            file, source = path.relative_to(root).as_posix(), path.read_bytes()
            self.parts[file] = [*_parts_of(file, ast.parse(source), frozenset(), "")]
            if _COMPILED.search(source):
                self.compiled.add(file)

    @cached_property
    def users(self) -> dict[str, list[Part]]:
        """Name -> the parts that mention it."""
        users = defaultdict[str, list[Part]](list)
        for part in (part for parts in self.parts.values() for part in parts):
            for name in part.mentions:
                users[name].append(part)
        return users

    def tests_of(self, file: str, line: int) -> list[str]:
        """The tests that may run a line: those first that few and rare names lead to, quick, and of its name."""
        *folders, stem = file.removesuffix(".py").split("/")[2:]
        near = ["/".join(("tests", *folders[: k + 1], "")) for k in range(len(folders))]
        found, known = dict[str, float](), set[str]()
        names = [(0.0, name) for name in next(part for part in self.parts[file] if line <= part.last).names]
        while names:
            way, name = heappop(names)
            if name in known:
                continue
            known.add(name)
            users = self.users.get(name, ())
            way += log2(1.0 + len(users))
            for part in users:
                if part.test:
                    found[part.test] = min(way, found.get(part.test, inf))
                else:
                    for each in part.names - known:
                        heappush(names, (way, each))

        def rank(test: str) -> tuple[float, str]:
            alike = sum(map(test.startswith, near)) + sum(word.rstrip("s") in test for word in stem.split("_"))
            return found[test] + 8.0 * test.startswith(self.slow) - 3.0 * alike, test

        return sorted(found, key=rank)


def _parts_of(file: str, tree: ast.Module | ast.ClassDef, known_as: frozenset[str], prefix: str) -> Iterator[Part]:
    """The parts of a module, or of a class; one without a name that others mention is known by that of its class."""
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            yield from _parts_of(file, node, frozenset({node.name}), f"{prefix}{node.name}::")
            continue
        names = frozenset(_defined(node))
        hidden = all(name.startswith("__") for name in names)
        # Arguments of tests are names of fixtures.
        found = (getattr(each, key, None) for each in ast.walk(node) for key in ("id", "attr", "arg"))
        is_test = file.startswith("tests/") and any(name.startswith("test_") for name in names)
        test = f"{file}::{prefix}{min(names)}" if is_test else ""
        mentions = frozenset(name for name in found if isinstance(name, str))
        yield Part(node.end_lineno or node.lineno, names | known_as if hidden else names, mentions, test)


def _defined(node: ast.stmt) -> set[str]:
    """Names that a statement defines."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        return {node.name}
    return {each.id for each in ast.walk(node) if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)}


def rounds(tests: list[str]) -> Iterator[list[str]]:
    """Tests in rounds, few first."""
    count = FIRST_ROUND
    while tests:
        yield tests[:count]
        tests, count = tests[count:], 3 * count
