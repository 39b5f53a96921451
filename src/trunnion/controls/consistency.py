"""What the parts of a control's definition say of each other: templates, fields, formats and settings.

In:     tables of a definition, and the control that was read from them.
Out:    problems, added to the tables.
"""

import re
from collections.abc import Iterable, Sequence
from importlib.resources import files

from trunnion.controls.definition import Control
from trunnion.controls.places import own_values
from trunnion.controls.template import Template
from trunnion.controls.vocabulary import (
    COMMON_TEMPLATE_FIELDS,
    FIELD_SETTINGS,
    FILTERS,
    LISTS,
    PRINTED_SETTINGS,
    PROGRAM_CHOICES,
    READ_SETTINGS,
    READING_KEYS,
    RUN_ONLY_SETTINGS,
    SUBPROGRAM_TEMPLATES,
    TCP_SETTINGS,
    WRITER_FORMATS,
)
from trunnion.definitions import Table
from trunnion.definitions.messages import meant_word
from trunnion.errors import Problem, key_subject
from trunnion.messages import Wording


def check_templates(table: Table, control: Control) -> None:
    """Report fields and formats that do not exist: a mistake of the definition, not of the run that prints them."""
    known = COMMON_TEMPLATE_FIELDS | control.family.TEMPLATE_FIELDS | control.settings.keys()
    call = control.templates.get(SUBPROGRAM_TEMPLATES[0])
    if call is not None and "subprogram" not in {name for name, _ in call.fields()}:
        table.add_problem(call.name, Wording("DEF590", "does_not_say"))
    for template in control.templates.values():
        for text in template.unread_fields():
            _report_brace(table, template, text)
        here = known | own_values(template.name)
        for line, fields in enumerate(template.fields_by_line()):
            _check_names(table, template, line, fields, here)
        for name, number_format in sorted(template.fields() | template.numbers()):
            if number_format and number_format not in control.formats:
                _report_format(table, template, control, name, number_format)


def _report_brace(table: Table, template: Template, text: str) -> None:
    """Report a line with a brace that is no part of a field or statement."""
    wording = Wording("DEF510", "lone_brace", text=repr(text.strip()))
    for opening, closing in (("{%", "%}"), ("{{", "}}"), ("{#", "#}")):
        if closing in text and opening not in text:
            wording = Wording("DEF510", "not_begun", closing=closing, opening=opening, text=repr(text.strip()))
            break
    _report_line(table, template, template.lines.index(text), wording)


def _report_format(table: Table, template: Template, control: Control, name: str, number_format: str) -> None:
    """Report a format, or in a text a filter, that there is not."""
    filters = FILTERS if template.is_text else frozenset[str]()
    near = meant_word(number_format, {*control.formats, *filters})
    known = tuple(sorted({*control.formats, *filters}))
    line = next((k for k, fields in enumerate(template.fields_by_line()) if (name, number_format) in fields), 0)
    is_filter = template.is_text and not re.search(rf":{number_format}\}}", template.lines[line])
    said: dict[str, object] = {"name": name, "format": number_format, "near": near, "known": known}
    if is_filter:
        wording = Wording("DEF510", "no_filter_but_near" if near else "no_filter", **said)
    else:
        wording = Wording("DEF510", "no_format_but_near" if near else "no_format", **said)
    _report_line(table, template, line, wording)


def _report_line(table: Table, template: Template, line: int, wording: Wording) -> None:
    """Report a mistake in a line of a template, counted from 0."""
    file, at = template.place_of(line)
    key = table.key_path(template.name)
    table.problems.append(Problem(file, at, wording.of_key(key), subject=key_subject(key)))


def _check_names(
    table: Table, template: Template, line: int, fields: Iterable[tuple[str, str]], known: frozenset[str]
) -> None:
    """Report values that there are not, at the line where a template asks for them."""
    known |= LISTS if template.is_text else frozenset()
    for name in sorted({name for name, _ in fields} - known):
        near = meant_word(name, known)
        if near and template.is_text:
            wording = Wording("DEF510", "no_value_but_near", name=name, near=near)
        elif near:
            wording = Wording("DEF510", "no_field_but_near", name=name, near=near, known=tuple(sorted(known)))
        else:
            wording = Wording("DEF510", "no_field", name=name, known=tuple(sorted(known)))
        _report_line(table, template, line, wording)


def check_formats(entries: Sequence[Table], control: Control) -> None:
    """Report formats that no word, no template and no writer uses: a new one with a misspelt name changes nothing."""
    used = {word.format for word in control.words} | WRITER_FORMATS
    for template in control.templates.values():
        used |= {number_format for _, number_format in template.fields() | template.numbers()}
    for entry in entries:
        name = entry.text("name")
        if name not in used and "name" in entry:
            near = meant_word(name, control.formats.keys() - {name})
            entry.add_problem(
                "name",
                Wording("DEF515", "format_nothing_prints", name=repr(name), near=near)
                if near
                else Wording("DEF515", "format_nothing", name=repr(name)),
            )


def check_setting_names(table: Table, control: Control) -> None:
    """Report settings that would never count: those that only a run has, and fields that have another value."""
    fields = (COMMON_TEMPLATE_FIELDS | control.family.TEMPLATE_FIELDS) - FIELD_SETTINGS
    for name in list(table.keys()):
        if name in RUN_ONLY_SETTINGS:
            table.add_problem(
                name, Wording("DEF520", "setting_run_definition", name=name, to_dict=table.to_dict()[name])
            )
        elif name in fields:
            table.add_problem(name, Wording("DEF520", "template_field_whose"))
    _report_misspelt(table, control)


def _report_misspelt(table: Table, control: Control) -> None:
    """Report settings that nothing reads, and whose name resembles one that something reads.

    Functions of a user may read others.
    """
    printed = {name for template in control.templates.values() for name, _ in template.fields()}
    known = printed | control.setting_rules.keys() | PROGRAM_CHOICES.keys() | PRINTED_SETTINGS | TCP_SETTINGS
    known |= READ_SETTINGS | RUN_ONLY_SETTINGS | FIELD_SETTINGS
    known |= control.family.SETTING_CHOICES.keys() | control.family.SETTING_FIELDS.keys()
    settings = known - printed | (printed & control.settings.keys())
    for name in sorted(set(table.keys()) - known):
        if table.location(name)[0].startswith(str(files("trunnion"))):
            continue  # of a shipped machine: where another extends it with another control, that one read it
        if name in READING_KEYS:
            table.add_problem(name, Wording("DEF520", "key_of_reading"))
        elif near := meant_word(name, sorted(settings - RUN_ONLY_SETTINGS)) or meant_word(name, sorted(settings)):
            variant = "near_setting_of_run" if near in RUN_ONLY_SETTINGS else "near_setting"
            table.add_problem(name, Wording("DEF520", variant, near=near))
