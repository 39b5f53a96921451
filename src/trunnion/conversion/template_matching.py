"""The lines of templates backwards: which line of a program is which line of a template, and what it says."""

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from typing import NamedTuple

from trunnion.controls.definition import Control
from trunnion.controls.template import Template

#: A setting that is words of a program, such as G54 or G55 O1: what stands in its place has the same letters.
_WORD_SETTING = re.compile(r"[A-Z]+\d+(?: [A-Z]+\d+)*")

#: Work offsets by G words of their own.
_OFFSET_WORD = r"G5(?:[4-9](?:\.\d)?|\d\d)"

#: Stands for any number where spellings are worked out.
_ANY_NUMBER = "98765.25"

_FIELD = re.compile(r"\{([A-Za-z_]\w*)(?::(\w+))?\}")


class LinePattern(NamedTuple):
    """One line of a template; ``value_only`` if it has nothing but a value, so that it fits nearly everything."""

    expression: re.Pattern[str]
    value_only: bool


def family_value_expressions(control: Control) -> dict[str, str]:
    """What the values can be that a family makes of its settings: name -> an expression of all of them.

    Only those that are words, such as ``M128`` or ``FUNCTION TCPM …``; where a setting is a number, any number may
    stand there.
    """
    family = control.family
    numbers = {name: _ANY_NUMBER for name in control.settings if name not in family.SETTING_CHOICES}
    found: dict[str, set[str]] = {}
    for chosen in product(*family.SETTING_CHOICES.values()):
        choice = dict(zip(family.SETTING_CHOICES, chosen, strict=True))
        for others in ({}, numbers):
            for name, value in family.template_values({**control.settings, **others, **choice}, None).items():
                if isinstance(value, str):
                    found.setdefault(name, set()).add(value)
    number = re.escape(_ANY_NUMBER)
    return {
        name: "|".join(sorted(re.escape(value).replace(number, r"[\d.]+") for value in values))
        for name, values in found.items()
    }


def line_patterns(
    templates: Iterable[Template],
    known: Mapping[str, str],
    settings: Mapping[str, str],
    family_values: Mapping[str, str],
) -> list[LinePattern]:
    """The lines of templates as patterns; some values are ``known``, the usual form of ``settings``, and how some are
    ``family_values`` (``family_value_expressions``)."""
    return [_line_pattern(line, known, settings, family_values) for template in templates for line in template.lines]


def _line_pattern(
    line: str, known: Mapping[str, str], settings: Mapping[str, str], family_values: Mapping[str, str]
) -> LinePattern:
    for name, value in known.items():
        line = line.replace(f"{{{name}}}", value)
    parts: list[str] = []
    at = 0
    seen: set[str] = set()
    for match in _FIELD.finditer(line):
        parts.append(re.escape(line[at : match.start()]))
        name, form = match[1], match[2]
        usual = settings.get(name, "")
        shape = re.sub(r"\d+", r"\\d+", usual) if _WORD_SETTING.fullmatch(usual) else ".*?"
        shape = _OFFSET_WORD if re.fullmatch(r"G5\d", usual) else shape
        value = r"[-+.\d]+" if form else family_values.get(name, shape)
        parts.append(f"(?P={name})" if name in seen else f"(?P<{name}>{value})")
        seen.add(name)
        at = match.end()
    parts.append(re.escape(line[at:]))
    value_only = bool(seen - family_values.keys()) and not re.sub(r"[\s;()]", "", _FIELD.sub("", line))
    return LinePattern(re.compile("".join(parts)), value_only)


def match_lines(lines: Sequence[tuple[int, str]], patterns: Sequence[LinePattern], values: dict[str, str]) -> set[int]:
    """Find the templates' lines among the program's: in their order, where some may lack on either side.

    Returns the lines that were found; ``values`` takes what they say, what it has already stays.
    """
    at = 0
    known: set[int] = set()
    for number, line in lines:
        fits = [(k, found) for k in range(at, len(patterns)) if (found := patterns[k].expression.fullmatch(line))]
        if not fits:
            continue
        at, found = min(fits, key=lambda fit: (patterns[fit[0]].value_only, fit[0]))
        at += 1
        known.add(number)
        for name, value in found.groupdict().items():
            values.setdefault(name, value)
    return known
