"""A template in the template language: what it prints, what is wrong with it, and its lines for a program."""

import re
from collections.abc import Mapping
from dataclasses import field, replace
from typing import Final, NoReturn

import jinja2
from jinja2 import meta, nodes

from trunnion.controls.template import Printing, Template, Value
from trunnion.controls.texts import filters, tree
from trunnion.controls.texts.sandbox import SANDBOX
from trunnion.controls.texts.syntax_faults import syntax_fault
from trunnion.controls.texts.values import ABSENT, MOST_CHARACTERS, Fault, Length, Rendering, as_number
from trunnion.controls.words import WordRangeError
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass

#: What Python says of an expression whose values do not fit.
_FAULTS: Final = (jinja2.TemplateError, TypeError, ValueError, ArithmeticError, RecursionError, LookupError)

_OPTIONAL: Final = re.compile(f"{tree.OPENING}([^{tree.OPENING}{tree.CLOSING}]*){tree.CLOSING}")
_TAG: Final = re.compile(r"\{%.*?%\}|\{#.*?#\}|\{\{.*?\}\}", re.DOTALL)
_STATEMENT_LINE: Final = re.compile(r"\{[%#]")
_PRINTED: Final = re.compile(r"\{\{-?\s*([A-Za-z_]\w*)\s*(?:\|\s*([A-Za-z_]\w*)\s*)?-?\}\}")

#: Types of values, as people call them.
_KINDS: Final = {
    "str": "a_text",
    "int": "number",
    "float": "number",
    "Length": "number",
    "bool": "a_condition",
    "NoneType": "an_absent_value",
    "tuple": "a_list",
    "list": "a_list",
    "Record": "a_tool_or_an_operation",
}

_COMPARED: Final = re.compile(r"'([<>]=?)' not supported between instances of '(\w+)' and '(\w+)'")
_SEARCHED: Final = re.compile(r"argument of type '(\w+)' is not (?:iterable|a container)")


@dataclass(frozen=True, slots=True, eq=False)
class TextTemplate(Template):
    """A template with statements or expressions of the template language.

    found       (line, name, format) of each value that it prints or asks for; the name is empty for another expression
    attributes  values of tools and operations that it asks for
    code        what it is for Jinja
    cost        operations of one writing, without the passes of its loops
    """

    found: tuple[tuple[int, str, str], ...] = ()
    attributes: frozenset[str] = frozenset()
    code: jinja2.Template | None = field(default=None, repr=False)
    cost: int = 0

    @property
    def is_text(self) -> bool:
        """Whether its lines are not those of the program: they are not."""
        return True

    def without_secondary(self) -> Template:
        """Return the template for a machine with one rotary axis, as ``Template`` does."""
        text = "\n".join(Template.without_secondary(self).lines)
        return replace(text_template(self.name, text, self.file, self.line)[0], step=self.step)

    @property
    def record_values(self) -> frozenset[str]:
        """The values of tools and operations that it asks for."""
        return self.attributes

    def fields(self) -> frozenset[tuple[str, str]]:
        """Return the (name, format) of every value that it asks for; the format is empty where it has none."""
        return frozenset((name, number_format) for _, name, number_format in self.found if name)

    def fields_by_line(self) -> list[frozenset[tuple[str, str]]]:
        """Return the fields of each line."""
        lines = [set[tuple[str, str]]() for _ in self.lines]
        for line, name, number_format in self.found:
            if name:
                lines[min(line, len(lines)) - 1].add((name, number_format))
        return [frozenset(each) for each in lines]

    def fields_beside(self, name: str) -> list[set[str]]:
        """Return where it is printed: always, as nobody knows what a condition finds."""
        return [set()] if any(each == name for each, _ in self.fields()) else []

    def numbers(self) -> set[tuple[str, str]]:
        """Return the (text, format) of what it prints by a format and is no value by name."""
        return {("…", number_format) for _, name, number_format in self.found if not name and number_format}

    def unread_fields(self) -> list[str]:
        """Return the lines with braces that are no field, and those with half of double brackets.

        None of a template that is not understood: what is wrong with it is told already.
        """
        if self.code is None:
            return []
        return [
            line
            for line, plain in zip(self.lines, self.plain_lines(), strict=True)
            if set("{}") & set(plain) or plain.count("[[") != plain.count("]]")
        ]

    def plain_lines(self) -> list[str]:
        """Return the lines with a zero byte for each field, expression and statement."""
        plain = _TAG.sub(lambda tag: "\0" + "\n" * tag[0].count("\n"), "\n".join(self.lines))
        return tree.FIELD.sub("\0", plain).split("\n")

    def pattern_lines(self) -> tuple[str, ...]:
        """Return the lines that print nothing but fields: a program may have been written from these."""
        lines = []
        for line in self.lines:
            simple = _PRINTED.sub(lambda m: f"{{{m[1]}:{m[2]}}}" if m[2] else f"{{{m[1]}}}", line)
            if not _STATEMENT_LINE.search(simple) and "{{" not in simple and "}}" not in simple and simple.strip():
                lines.append(simple)
        return tuple(lines)

    def expand(self, values: Mapping[str, Value], printing: Printing) -> list[str]:
        """Return the lines of the program, without those whose values are absent, and without empty ones.

        Raises ``InputError`` if it does what it cannot do, or a number is beyond the limits of its format; at its line.
        """
        assert self.code is not None
        rendering = Rendering(printing)
        context: dict[str, object] = {name: _prepared(name, value, printing) for name, value in values.items()}
        context |= {**printing.lists, filters.RENDERING: rendering}
        pieces: list[str] = []
        left = min(MOST_CHARACTERS, printing.budget.characters)
        try:
            rendering.charge(self.cost)
            for piece in self.code.generate(context):
                pieces.append(piece)
                left -= len(piece)
                if left < 0:
                    raise Fault("writes_too_much", most=MOST_CHARACTERS)
        except (Fault, WordRangeError, *_FAULTS) as error:
            self._refuse(error)
        text = "".join(pieces)
        printing.budget.characters -= len(text)
        return _complete_lines(text)

    def _refuse(self, error: Exception) -> NoReturn:
        line, trace = 0, error.__traceback__
        while trace is not None:
            if trace.tb_frame.f_code.co_filename == self.name:
                line = trace.tb_lineno
            trace = trace.tb_next
        file, at = self.place_of(max(line, 1) - 1)
        fault = error if isinstance(error, Fault) else _value_fault(error)
        if isinstance(error, WordRangeError):
            fault = Fault("prints_beyond_format", fault=error.wording)
        raise InputError(
            Problem(file, at, Wording("DEF580", "template_fails", template=self.name, fault=fault.wording))
        ) from None


def text_template(name: str, text: str, file: str, line: int) -> tuple[TextTemplate, Fault | None]:
    """Read a template in the template language.

    template  without code if something is wrong
    fault     the first thing in it that cannot be, at its line within the text, from 1; None if it can be compiled.
              Whether its names and formats exist depends on the control
    """
    lines = tuple(text.rstrip("\n").split("\n"))
    try:
        found, attributes, code, cost = _compiled(name, "\n".join(lines))
    except Fault as fault:
        return TextTemplate(name, lines, file, line), fault
    except jinja2.TemplateSyntaxError as error:
        return TextTemplate(name, lines, file, line), syntax_fault("\n".join(lines), error.lineno)
    except (RecursionError, SyntaxError, ValueError, ArithmeticError, MemoryError):
        return TextTemplate(name, lines, file, line), Fault("not_compiled")
    return TextTemplate(name, lines, file, line, found, attributes, code, cost), None


def _compiled(name: str, text: str) -> tuple[tuple[tuple[int, str, str], ...], frozenset[str], jinja2.Template, int]:
    """Return what a template asks for, its code, and how many operations it is."""
    checked = tree.with_fields(tree.parsed(text))
    formats = list(tree.formats_of(checked))
    asked = [(node.lineno, node.name) for node in checked.find_all(nodes.Name) if node.ctx == "load"]
    attributes = frozenset(node.attr for node in checked.find_all(nodes.Getattr))
    cost = tree.for_compiler(checked, {each for _, _, each in formats})
    free = meta.find_undeclared_variables(checked)
    named = {(line, value) for line, value, _ in formats}
    found = [(line, value if value in free else "", each) for line, value, each in formats]
    found += [(line, value, "") for line, value in asked if value in free and (line, value) not in named]
    code = SANDBOX.compile(checked, name, name)
    return tuple(found), attributes, jinja2.Template.from_code(SANDBOX, code, {}), cost


def _prepared(name: str, value: Value, printing: Printing) -> object:
    """Return a value as expressions have it: numbers as such, and lengths as lengths."""
    if value is None or value == "":
        return None
    if name in printing.lengths and (number := as_number(value)) is not None:
        return Length(number)
    if isinstance(value, str) and name in printing.numbers:
        return as_number(value)
    return value


def _complete_lines(text: str) -> list[str]:
    lines = []
    for line in text.split("\n"):
        line = _OPTIONAL.sub(lambda part: "" if ABSENT in part[1] else part[1], line)
        line = line.replace(tree.OPENING, "").replace(tree.CLOSING, "").rstrip()
        if line and ABSENT not in line:
            lines.append(line)
    return lines


def _value_fault(error: Exception) -> Fault:
    """Return what an expression did that its values do not allow."""
    if (found := _COMPARED.match(str(error))) is not None:
        return Fault("compares_other_kinds", left=_kind(found[2]), right=_kind(found[3]), operator=found[1])
    if (found := _SEARCHED.match(str(error))) is not None:
        return Fault("looks_within_other_kind", value=_kind(found[1]))
    if isinstance(error, RecursionError):
        return Fault("too_deep")
    return Fault("not_allowed_by_values")


def _kind(name: str) -> Wording:
    return phrase(_KINDS.get(name, "another_thing"))
