"""Modules import each other one way: there is no circle, not even one that an import within a function hides."""

from collections.abc import Collection, Mapping

import grimp


def circles(ways: Mapping[str, Collection[str]]) -> list[list[str]]:
    """Return the groups of nodes that lead to each other; ``ways`` has for each node those that it leads to."""
    leads_to = {node: reached_from(node, ways) for node in ways}
    groups = {frozenset(each for each in leads_to[node] if node in leads_to[each]) for node in ways}
    return sorted(sorted(group) for group in groups if group)


def reached_from(node: str, ways: Mapping[str, Collection[str]]) -> set[str]:
    found, new = set[str](), [node]
    while new:
        further = set(ways[new.pop()]) - found
        found |= further
        new += further
    return found


def test_modules_import_each_other_one_way() -> None:
    graph = grimp.build_graph("trunnion")
    assert circles({each: graph.find_modules_directly_imported_by(each) for each in graph.modules}) == []


def test_circles_are_found() -> None:
    assert circles({"a": {"b"}, "b": {"c", "d"}, "c": {"a"}, "d": set()}) == [["a", "b", "c"]]
