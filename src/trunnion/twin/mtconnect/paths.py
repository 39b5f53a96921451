"""The argument ``path`` of a request: which elements of a device model it selects.

Of XPath this is what clients of MTConnect write: steps with ``/`` and ``//``, names or ``*``, and comparisons of
attributes with texts, joined by ``and`` and ``or``: ``//Axes//Linear[@name="X"]/DataItems/DataItem[@type="POSITION"]``.
"""

import re
import xml.etree.ElementTree as ET
from typing import Final

from trunnion.twin.mtconnect.request_errors import RequestError

#: Letters of the longest path that is followed.
_LONGEST: Final = 1024

_QUOTED: Final = r"\"[^\"]*\"|'[^']*'"
_STEP: Final = re.compile(rf"(//?)(?:[A-Za-z]\w*:)?(\*|[A-Za-z]\w*)((?:\[(?:[^\]\"']|{_QUOTED})*\])*)")
_PREDICATE: Final = re.compile(rf"\[((?:[^\]\"']|{_QUOTED})*)\]")
_COMPARISON: Final = re.compile(rf"\s*@([A-Za-z]\w*)\s*=\s*({_QUOTED})\s*(?:(and|or)\b|$)")

#: Alternatives, each a list of comparisons that must all hold.
_Tests = list[list[tuple[str, str]]]


def selected(root: ET.Element, path: str) -> list[ET.Element]:
    """Return the data items of the elements that a path selects, in the order of the document.

    Raises ``RequestError`` if the path selects none, or is written in a way that is not read here.
    """
    found: dict[int, ET.Element] = {}
    place, top = 0, ET.Element("document")
    top.append(root)
    if len(path) > _LONGEST:
        raise _refused(path)
    while True:
        elements, place = _followed(top, path, place)
        for element in elements:
            found |= {id(item): item for item in element.iter("DataItem")}
        if place == len(path):
            break
        if path[place] != "|":
            raise _refused(path)
        place += 1
    if not found:
        raise RequestError("INVALID_PATH", f"path {path} selects no data item of /probe")
    return [item for item in root.iter("DataItem") if id(item) in found]


def _followed(top: ET.Element, path: str, place: int) -> tuple[list[ET.Element], int]:
    """Return what the steps of a path from a place on lead to, and the place behind them."""
    elements, begun = [top], place
    while step := _STEP.match(path, place):
        deep, name, predicates = step.groups()
        tests = [_tests(path, each) for each in _PREDICATE.findall(predicates)]
        reached: dict[int, ET.Element] = {}
        for element in elements:
            below = (each for child in element for each in child.iter()) if deep == "//" else element
            reached |= {
                id(each): each
                for each in below
                if name in ("*", each.tag) and all(_holds(test, each) for test in tests)
            }
        elements, place = list(reached.values()), step.end()
    if place == begun:
        raise _refused(path)
    return elements, place


def _tests(path: str, predicate: str) -> _Tests:
    tests: _Tests = [[]]
    place, joined = 0, "and"
    while joined:
        comparison = _COMPARISON.match(predicate, place)
        if comparison is None:
            raise _refused(path)
        tests[-1].append((comparison[1], comparison[2][1:-1]))
        place, joined = comparison.end(), comparison[3]
        if joined == "or":
            tests.append([])
    return tests


def _holds(tests: _Tests, element: ET.Element) -> bool:
    return any(all(element.get(name) == value for name, value in each) for each in tests)


def _refused(path: str) -> RequestError:
    read = """//Axes, //Linear[@name="X"], //DataItem[@type="POSITION" or @id="x"], and several with | between"""
    return RequestError("INVALID_PATH", f"path {path[:_LONGEST]} is none that is read here: {read}")
