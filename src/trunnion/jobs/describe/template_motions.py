"""Motions in a branch of a template: a program that does not take the branch proves nothing of them."""

import re
from collections.abc import Iterator
from typing import Final

from trunnion.controls import Control
from trunnion.controls.inches import without_comments
from trunnion.controls.template import Template
from trunnion.errors import Problem, warning
from trunnion.messages import Wording

#: What changes whether a line is one of the program: statements of the template language.
_STATEMENT: Final = re.compile(r"\{%-?\s*(\w+).*?%\}")
_OPENS: Final = ("if", "for")
_CLOSES: Final = ("endif", "endfor")

#: An expression that chooses, and the texts among which it does.
_CHOICE: Final = re.compile(r"\{\{[^}]*\bif\b[^}]*\}\}")
_TEXT: Final = re.compile(r"\"([^\"]*)\"|'([^']*)'")

#: What stands for a value: a field, or another expression.
_VALUE: Final = re.compile(r"\{\{.*?\}\}|\{#.*?#\}|\{[^{}%#]*\}")

#: Words that move an axis: positions, G0 to G3 and ways home, machine positions, straight lines of Klartext.
_MOTION: Final = re.compile(
    r"(?<![A-Z0-9_])(?:I?[XYZABCUVW]\d?\s*=?\s*[-+]?(?:[\d.\0\[#(]|_[A-Z])|G0*(?:[0-3]|28|30|53|290)(?![\d.])|SUPA|M(?:91|140|242)(?!\d)"
    r"|\0\s*=|LN? )"
)


def motions_in_branches(control: Control) -> list[Problem]:
    """Return a warning for each line of a shop's template that moves an axis, and is not in every program."""
    return [
        warning(*template.place_of(line), Wording("DEF595", "motion_in_branch", template=name))
        for name, template in control.templates.items()
        if template.is_text
        for line, text in _branches(template)
        if _MOTION.search(without_comments(control, text).upper())
    ]


def _branches(template: Template) -> Iterator[tuple[int, str]]:
    """Yield the lines of a template that some programs do not have, each with its number from 0."""
    depth = 0
    for number, line in enumerate(template.lines):
        words = _STATEMENT.findall(line)
        opened = sum(word in _OPENS for word in words)
        text = _VALUE.sub("\0", _STATEMENT.sub(" ", line))
        if depth or opened:
            yield number, text
        chosen = (first or second for choice in _CHOICE.findall(line) for first, second in _TEXT.findall(choice))
        for part in () if depth or opened else chosen:
            yield number, part
        depth += opened - sum(word in _CLOSES for word in words)
