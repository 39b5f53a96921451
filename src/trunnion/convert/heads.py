"""The lines of templates backwards: which line of a program is which line of a template, and what it says."""

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from trunnion.control.template import Template

_FIELD = re.compile(r"\{([A-Za-z_]\w*)(?::(\w+))?\}")


class Pattern(NamedTuple):
    """One line of a template; ``bare`` if it has nothing but a value, so that it fits nearly everything."""

    expression: re.Pattern[str]
    bare: bool


def patterns(templates: Iterable[Template], primary: str, secondary: str) -> list[Pattern]:
    """The lines of templates as patterns; the letters of the rotary axes are known."""
    return [_pattern(line, primary, secondary) for template in templates for line in template.lines]


def _pattern(line: str, primary: str, secondary: str) -> Pattern:
    line = line.replace("{primary}", primary).replace("{secondary}", secondary)
    parts: list[str] = []
    at = 0
    named: set[str] = set()
    for match in _FIELD.finditer(line):
        parts.append(re.escape(line[at : match.start()]))
        name, form = match[1], match[2]
        value = r"[-+.\d]+" if form else r"G5(?:[4-7]|\d\d)" if name == "work_offset" else ".*?"
        parts.append(f"(?P={name})" if name in named else f"(?P<{name}>{value})")
        named.add(name)
        at = match.end()
    parts.append(re.escape(line[at:]))
    bare = bool(named) and not re.sub(r"[\s;]", "", _FIELD.sub("", line))
    return Pattern(re.compile("".join(parts)), bare)


def marker(template: Template) -> str:
    """The first line of a template if it is a comment without values, bare of its semicolon; else nothing."""
    line = template.lines[0] if template.lines else ""
    return line[1:].strip() if line.startswith(";") and not _FIELD.search(line) else ""


def match(lines: Sequence[tuple[int, str]], patterns: Sequence[Pattern], values: dict[str, str]) -> set[int]:
    """Find the templates' lines among the program's: in their order, where some may lack on either side.

    Returns the lines that were found; ``values`` takes what they say, what it has already stays.
    """
    at = 0
    known: set[int] = set()
    for number, line in lines:
        fits = [(k, found) for k in range(at, len(patterns)) if (found := patterns[k].expression.fullmatch(line))]
        if not fits:
            continue
        at, found = min(fits, key=lambda fit: (patterns[fit[0]].bare, fit[0]))
        at += 1
        known.add(number)
        for name, value in found.groupdict().items():
            values.setdefault(name, value)
    return known
