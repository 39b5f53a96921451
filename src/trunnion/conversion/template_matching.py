"""A control's templates read backwards: which line of a program was written from which line of a template.

In:     lines of a program, and the templates of the control that it was written for.
Out:    the lines that were written from templates, and the values in them.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from typing import NamedTuple

from trunnion.controls.definition import Control
from trunnion.controls.template import Template
from trunnion.machines import Machine

#: A setting that is one or more words of a program, such as G54 or G55 O1: its place takes words of the same letters.
_WORD_SETTING = re.compile(r"[A-Z]+\d+(?: [A-Z]+\d+)*")

#: Work offsets called by a G word of their own, or by one with a number.
_OFFSET_WORD = r"(?:G5(?:[4-9](?:\.\d)?|\d\d)|G\d{3}(?= ?P))(?: ?P\d+)?"

_M_WORD = re.compile(r"M\d+")

#: Put in for number settings, and found again in what the family makes of them.
_ANY_NUMBER = "98765.25"

_FIELD = re.compile(r"\{([A-Za-z_]\w*)(?::(\w+))?\}")


class LinePattern(NamedTuple):
    """One line of a template; ``value_only`` if it is nothing but a value, so that it fits nearly every line."""

    expression: re.Pattern[str]
    value_only: bool


class TemplatePatterns:
    """The template lines of a control as patterns, for the programs of one machine."""

    def __init__(self, control: Control, machine: Machine) -> None:
        self._control = control
        axes = tuple(zip(("primary", "secondary"), machine.rotary_words, strict=False))
        letters = {key: machine.names[column] for key, column in axes}
        returning = {f"{key}_returns": machine.names[column] for key, column in axes}
        self._known = {**letters, **returning, "machine": machine.name}
        self._family_values = family_value_expressions(control)
        rules = {name: rule.one_of for name, rule in control.setting_rules.items() if rule.one_of}
        self._choices = {name: "|".join(map(re.escape, words)) for name, words in rules.items()}
        # An M word of any number would take an M0 for the one that ends TCP.
        self._choices |= {name: word for name, word in control.settings.items() if _M_WORD.fullmatch(word)}

    def of(self, *names: str) -> list[LinePattern]:
        """Return the lines of all templates whose names begin with one of ``names``, in the order of ``names``."""
        return [line for template in self._named(names) for line in self._lines(template)]

    def first_lines(self, *names: str) -> list[LinePattern]:
        """Return the first line of each of these templates, unless it is only a value."""
        firsts = [self._lines(template)[:1] for template in self._named(names)]
        return [line for lines in firsts for line in lines if not line.value_only]

    def _named(self, names: Sequence[str]) -> list[Template]:
        templates = self._control.templates
        return [templates[key] for name in names for key in templates if key.startswith(name)]

    def _lines(self, template: Template) -> list[LinePattern]:
        return line_patterns([template], self._known, self._control.settings, self._family_values, self._choices)


def family_value_expressions(control: Control) -> dict[str, str]:
    """Return the values that a family derives from its settings: name -> regular expression of all it can be.

    Only values that are words, such as ``M128`` or ``FUNCTION TCPM …``. Where a setting is a number, any number fits.
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
    choices: Mapping[str, str] | None = None,
) -> list[LinePattern]:
    """Return the lines of templates as patterns.

    known          values that are the same in every program of the machine
    settings       the defaults of the control: their form is the form of the values
    family_values  of ``family_value_expressions``
    choices        settings with a few values: name -> regular expression of them; a line that is nothing but such a
                   setting has one of these
    """
    shapes = choices or {}
    return [
        _line_pattern(line, known, settings, family_values, shapes)
        for template in templates
        for line in template.pattern_lines()
    ]


def _line_pattern(
    line: str,
    known: Mapping[str, str],
    settings: Mapping[str, str],
    family_values: Mapping[str, str],
    choices: Mapping[str, str],
) -> LinePattern:
    for name, value in known.items():
        line = line.replace(f"{{{name}}}", value)
    parts: list[str] = []
    at = 0
    seen: set[str] = set()
    for match in _FIELD.finditer(line):
        parts.append(_literal(line[at : match.start()]))
        name, form = match[1], match[2]
        default = settings.get(name, "")
        shape = re.sub(r"\d+", r"\\d+", default) if _WORD_SETTING.fullmatch(default) else ".*?"
        shape = choices.get(name, shape) if match[0] == line.strip() else shape
        shape = _OFFSET_WORD if re.fullmatch(r"G5\d", default) else shape
        value = r"[-+.\d]+" if form else family_values.get(name, shape)
        parts.append(f"(?P={name})" if name in seen else f"(?P<{name}>{value})")
        seen.add(name)
        at = match.end()
    parts.append(_literal(line[at:]))
    value_only = bool(seen - family_values.keys()) and not re.sub(r"[\s;()]", "", _FIELD.sub("", line))
    return LinePattern(re.compile("".join(parts), re.IGNORECASE), value_only)


def _literal(text: str) -> str:
    """Return what stands between the fields of a template as an expression; ``[[`` and ``]]`` enclose what may be
    absent.
    """
    return re.escape(text).replace(r"\[\[", "(?:").replace(r"\]\]", ")?")


def match_lines(lines: Sequence[tuple[int, str]], patterns: Sequence[LinePattern], values: dict[str, str]) -> set[int]:
    """Find the lines of a program that were written from template lines.

    Both are in the same order, but either may have lines that the other lacks. ``values`` takes the values found;
    values that it already has stay.

    set  the numbers of the lines found
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
            if value is not None:
                values.setdefault(name, value)
    return known
