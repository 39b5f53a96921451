"""Programs that count in inches: the control with its formats for them, and what of its definition would be in mm.

Everything inside stays in mm; a number format says what a printed unit is. So a definition must print lengths by
formats that have inches, and write no length as it stands in the program: ``{50:coordinate}`` is 50 mm in every unit.
"""

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import Final

from trunnion.controls.definition import Control
from trunnion.controls.template import Template
from trunnion.controls.vocabulary import INCH, LENGTH_WORDS, MM, PROGRAM_START_TEMPLATES
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.messages import Wording
from trunnion.model.toolpath import Message

_NUMBER: Final = r"[-+]?(?:\d+\.?\d*|\.\d+)"

# Patterns are compiled when they are first used: few programs are in inches.
#: Words whose numbers are lengths or feeds. ``Q`` of a program parameter (``Q200=``) is not such a word.
_ADDRESS: Final = (
    r"(?<![A-Za-z0-9_$#.])(?:I?[XYZUVW]\d?|[IJKREF]|Q(?!\d+\s*=)|F[UZ]|MB|DIST|D[LR]2?|CR|RP|CTOL|TOFF[LR]?)"
    rf"\s*=?\s*(?:[AI]C\(\s*)?({_NUMBER})"
)

#: The tolerance of ``G64``, and of cycle 32; cycles of old controls, whose heights have no letters.
_TOLERANCE: Final = rf"(?<![A-Za-z0-9.])(?:G64\b.*?P|CYCL DEF 32\.1\s+T)\s*({_NUMBER})"
_OLD_CYCLE: Final = rf"CYCL DEF (?:[1-6]|1[4-8]|2\d)\.\d+\b.*?({_NUMBER})\s*$"

#: A value that is given to a variable, whatever it means there; words of tools, speeds and angles are none.
_ASSIGNMENT: Final = (
    rf"(?<![A-Za-z0-9_])(?!(?:[TDSHMABC]\d?|TURN)\s*=)[A-Za-z_$#][A-Za-z0-9_$]*(?:\[[^\]]*\])?\s*=\s*({_NUMBER})"
)

#: A call with its arguments, and the places of lengths among those of calls that are known; None: all places.
_CALL: Final = r"(?<![A-Za-z0-9_])([A-Za-z_][A-Za-z0-9_]*)\s*\(([^()]*)\)"
_LENGTH_ARGUMENTS: Final[dict[str, frozenset[int]]] = {
    "CYCLE800": frozenset({4, 5, 6, 10, 11, 12, 14}),
    "CYCLE832": frozenset({0}),
    "DC": frozenset(),
    "ACP": frozenset(),
    "ACN": frozenset(),
    "AC": frozenset(),  # with its address
    "IC": frozenset(),
}


def in_units(control: Control, units: str) -> Control:
    """Return a control whose programs count in a unit: ``mm`` or ``inch``.

    Raises ``InputError`` if the definition does not say how, or has lengths that would stay in mm; with every place.
    """
    if units != INCH:
        return control
    if INCH not in control.unit_words:
        raise InputError(argument_problem("settings", Wording("ARG250", "units_inch_no", control=control.name)))
    problems = [*_format_problems(control), *_template_problems(control)]
    if problems:
        raise InputError(problems)
    formats = {name: pair.inch or pair for name, pair in control.formats.items()}
    return replace(control, formats=formats, units=INCH)


def literal_length(control: Control, text: str) -> str:
    """Return the first length or feed that is written as a number in a line of a program; empty for none.

    A number of which nobody knows whether it is a length counts as one. Comments and texts in quotation marks do not
    count, nor does zero.
    """
    bare = without_comments(control, re.sub(r'"[^"]*"', '""', text))
    for pattern in (_ADDRESS, _TOLERANCE, _OLD_CYCLE, _ASSIGNMENT):
        for match in re.finditer(pattern, bare):
            if float(match[1]):
                return match[0].strip()
    for match in re.finditer(_CALL, bare):
        places = _LENGTH_ARGUMENTS.get(match[1])
        for k, argument in enumerate(match[2].split(",")):
            is_number = re.fullmatch(rf"\s*{_NUMBER}\s*", argument)
            if is_number and float(argument) and (places is None or k in places):
                return f"{argument.strip()} in {match[1]}"
    return ""


def without_comments(control: Control, text: str) -> str:
    """Return a line without its comments, by the signs with which the family's writer begins comments and messages."""
    family = control.family
    starts = {line[:1] for line in (*family.comment("x"), *family.message(Message(0, 0, "x", True)))}
    text = re.sub(r"\([^()]*\)", "", text) if "(" in starts else text
    if text.startswith("* - "):
        return ""
    return text.partition(";")[0] if ";" in starts else text


def _format_problems(control: Control) -> Iterator[Problem]:
    """Words of motion blocks whose formats have no inches, or have them and print no lengths."""
    for word in control.words:
        pair = control.formats.get(word.format)
        if pair is None or (word.name in LENGTH_WORDS) == (pair.inch is not None):
            continue
        if pair.inch is None and word.name == "feed_per_rev":
            continue  # refused where an operation has one
        yield Problem(
            control.name,
            0,
            Wording(
                "DEF540",
                "word_no_format",
                word=word.name,
                format=word.format,
                value=min(9, pair.five_axis.decimals + 2),
                format_name=repr(word.format),
            )
            if pair.inch is None
            else Wording("DEF540", "word_no_length", word=word.name, format=repr(word.format)),
        )


def _template_problems(control: Control) -> Iterator[Problem]:
    """Lines of templates with lengths that would stay in mm."""
    mm_word, lengths = control.unit_words[MM], control.length_fields
    word = re.compile(rf"(?<![A-Za-z0-9.]){re.escape(mm_word)}(?![A-Za-z0-9.])")
    for template in control.templates.values():
        if template.name in PROGRAM_START_TEMPLATES and "unit_word" not in {name for name, _ in template.fields()}:
            yield _problem(template, 0, Wording("DEF540", "does_not_say", template=template.name, mm_word=mm_word))
        for k, (bare, fields) in enumerate(zip(template.plain_lines(), template.fields_by_line(), strict=True)):
            if word.search(without_comments(control, bare)):
                yield _problem(
                    template, k, Wording("DEF540", "says_millimetres", template=template.name, mm_word=mm_word)
                )
            literal = literal_length(control, bare)
            if literal:
                number = re.findall(_NUMBER, literal.partition(" in ")[0])[-1]
                yield _problem(
                    template,
                    k,
                    Wording("DEF540", "number_may_length", template=template.name, literal=literal, number=number),
                )
            yield from _field_problems(control, template, k, fields, lengths.__contains__)


def _field_problems(
    control: Control, template: Template, k: int, fields: Iterable[tuple[str, str]], is_length: Callable[[str], bool]
) -> Iterator[Problem]:
    for name, number_format in sorted(fields):
        if number_format and is_length(name) != (control.formats[number_format].inch is not None):
            yield _problem(
                template,
                k,
                Wording(
                    "DEF540",
                    "prints_length_format" if is_length(name) else "prints_no_length",
                    template=template.name,
                    name=name,
                    number_format=number_format,
                    format_name=repr(number_format),
                ),
            )


def _problem(template: Template, line: int, wording: Wording) -> Problem:
    return Problem(*template.place_of(line), wording)
