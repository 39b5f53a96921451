"""Functions of a user at places of output: each takes the place of the template there, and is one itself.

In:     functions of hook files, and the templates of a control.
Out:    templates whose lines the functions return; what is wrong with these, at the function.
"""

import math
import sys
import types
from collections.abc import Mapping, Sequence
from contextlib import redirect_stdout
from dataclasses import field, fields, replace
from typing import Any, Final

from trunnion.controls.definition import Control
from trunnion.controls.places import OUTPUT_PLACES, OutputPlace, place_of
from trunnion.controls.template import Answer, Printing, Template, Value
from trunnion.controls.texts.values import Later
from trunnion.errors import InputError, Problem
from trunnion.hooks.files import HookFile, function_failure
from trunnion.hooks.places import PLACE_RECORDS, OperationValues, Place, ToolValues
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass
from trunnion.transliteration import lacking

_MOST_LINES: Final = 1000
_LONGEST_LINE: Final = 1000
_GREATEST: Final = 1e9


@dataclass(frozen=True, slots=True)
class RunOf:
    """Names of machine and control, the settings of a run, and what its program is written in."""

    machine: str
    control: str
    settings: Mapping[str, str]
    encoding: str = "utf-8"


@dataclass(frozen=True, slots=True, eq=False)
class FunctionTemplate(Template):
    """A template that is a function of a user.

    base    what stands at the place without it; None: nothing
    place   where it stands
    source  the file of the function
    run     what it is told of the run
    told    answers that it has given, so that it is asked once for each place; within motion it is anyway
    made    records of tools and operations that it has been given, by the ids of those of templates
    """

    base: Template | None = None
    place: OutputPlace = OUTPUT_PLACES[0]
    source: HookFile | None = None
    run: RunOf = field(default_factory=lambda: RunOf("", "", {}))
    told: dict[object, Answer] = field(default_factory=dict)
    made: dict[int, tuple[object, Any]] = field(default_factory=dict)

    @property
    def title(self) -> Wording:
        """What messages call it: a phrase."""
        return phrase("function_of_hooks", name=self.place.function)

    @property
    def of_definition(self) -> Template | None:
        """What the definition has in its place; None: nothing."""
        return self.base.of_definition if self.base else None

    @property
    def is_text(self) -> bool:
        """Whether its lines are not those of the program: they are not."""
        return True

    @property
    def record_values(self) -> frozenset[str]:
        """The values that it may ask for: times are worked out for it."""
        return frozenset({"time"})

    def fields(self) -> frozenset[tuple[str, str]]:
        """Return the fields of the template in whose place it stands."""
        return self.base.fields() if self.base else frozenset()

    def fields_beside(self, name: str) -> list[set[str]]:
        """Return the fields beside one in the template in whose place it stands."""
        return self.base.fields_beside(name) if self.base else []

    def plain_lines(self) -> list[str]:
        """Return no lines: nobody knows them before they are written."""
        return self.base.plain_lines() if self.base else []

    def expand(self, values: Mapping[str, Value], printing: Printing) -> list[str]:
        """Return the lines of the answer; errors as it raises them."""
        return list(self.answer(values, printing).lines)

    def answer(self, values: Mapping[str, Value], printing: Printing) -> Answer:
        """Return what the function says.

        Raises ``InputError`` if it fails, or says what cannot be written.
        """
        if self.place.within:
            return self._asked(values, printing)
        key = (tuple(sorted((name, repr(value)) for name, value in values.items())), repr(dict(printing.own)))
        if key not in self.told:
            self.told[key] = self._asked(values, printing)
        return self.told[key]

    def _asked(self, values: Mapping[str, Value], printing: Printing) -> Answer:
        if self.base is None:
            before = Answer(tuple(printing.own.get("lines", ())))  # type: ignore[arg-type]
        else:
            before = self.base.answer(values, printing)
        given = self._record(before, values, printing)
        returned = self._call(given)
        if returned is None or returned is given:
            return before
        lines, words = self._taken(returned, given)
        first = before.lines if before.base is None else before.base
        return Answer(lines, {**before.words, **words}, first, self)

    def _record(self, before: Answer, values: Mapping[str, Value], printing: Printing) -> Place:
        kind = PLACE_RECORDS.get(self.place.name, Place)
        known, lists = {each.name for each in fields(kind)}, printing.lists
        own = {name: value for name, value in printing.own.items() if name in known}
        if "words" in own and isinstance(own["words"], Mapping):
            words = {**own["words"], **before.words}
            own["words"] = types.MappingProxyType({key: value for key, value in words.items() if value is not None})
        said: dict[str, Any] = {
            **own,
            "name": self.place.name,
            "template": self.name,
            "lines": tuple(before.lines),
            "machine": self.run.machine,
            "control": self.run.control,
            "settings": types.MappingProxyType({**self.run.settings}),
            "fields": types.MappingProxyType({**values}),
            "formats": types.MappingProxyType({**printing.formats}),
            **{name: self._made(lists.get(name)) for name in ("operation", "tool", "next_tool", "tools", "operations")},
        }
        made: Place = kind(**said)
        return made

    def _made(self, found: object) -> Any:
        if id(found) not in self.made:
            self.made[id(found)] = found, _values(found)
        return self.made[id(found)][1]

    def _call(self, given: Place) -> object:
        assert self.source is not None
        try:
            with redirect_stdout(sys.stderr):  # the program may go to standard output
                return self.source.functions[self.place.function](given)
        except (Exception, SystemExit) as error:
            name = given.operation.name or ""
            raise InputError(function_failure(self.source.path, error, self.place.function, name)) from error

    # What it returns

    def _taken(self, returned: object, given: Place) -> tuple[tuple[str, ...], dict[str, float | None]]:
        """Return lines and words of what the function has returned."""
        lines: object = given.lines
        words: object = {}
        if isinstance(returned, Place):
            other = next((each.name for each in fields(given) if each.name not in ("lines", "words")
                          and getattr(returned, each.name, None) is not getattr(given, each.name)), "")  # fmt: skip
            if other:
                raise self._refused("other_value", value=other)
            lines, words = returned.lines, getattr(returned, "words", {})
        elif isinstance(returned, Mapping):
            words = returned
        else:
            lines = returned.split("\n") if isinstance(returned, str) else returned
        if (
            not isinstance(lines, Sequence)
            or isinstance(lines, str)
            or not all(isinstance(each, str) for each in lines)
        ):
            raise self._refused("place_type", name=type(returned).__name__)
        if not isinstance(words, Mapping):
            raise self._refused("place_type", name=type(words).__name__)
        return self._lines(lines), self._words(words, getattr(given, "words", {}))

    def _lines(self, lines: Sequence[str]) -> tuple[str, ...]:
        if len(lines) > _MOST_LINES:
            raise self._refused("many_lines", count=len(lines), most=_MOST_LINES)
        for line in lines:
            if len(line) > _LONGEST_LINE:
                raise self._refused("long_line", line=repr(line[:40]), count=len(line), most=_LONGEST_LINE)
            if not line.isprintable():
                raise self._refused("control_character", line=repr(line[:60]))
            if letter := lacking(line, self.run.encoding):
                raise self._refused(
                    "letter_lacking", line=repr(line[:60]), letter=repr(letter), encoding=self.run.encoding
                )
        return tuple(line.rstrip() for line in lines if line.strip())

    def _words(self, words: Mapping[Any, Any], given: Mapping[str, float]) -> dict[str, float | None]:
        """Return the words that are others."""
        if words and not self.place.words:
            raise self._refused("no_words_here", place=self.place.name)
        found: dict[str, float | None] = {}
        for key, value in words.items():
            if not isinstance(key, str) or not key.isprintable():
                raise self._refused("word_name", word=repr(key)[:40])
            number = isinstance(value, int | float) and not isinstance(value, bool)
            if value is not None and not (number and math.isfinite(value) and abs(value) <= _GREATEST):
                raise self._refused("word_value", word=key, value=repr(value)[:40])
            # Where a word that there is not would be left out, its name is misspelt.
            if key not in given or value != given[key]:
                found[key] = None if value is None else float(value)
        return found

    def _refused(self, variant: str, /, **parameters: object) -> InputError:
        return self.refused(Wording("HOK170", variant, **parameters))

    def refused(self, wording: Wording) -> InputError:
        """Return the error of what the function has returned."""
        return InputError(Problem(self.file, self.line, wording.within("returned", name=self.place.function)))


def with_functions(control: Control, files: Sequence[HookFile], run: RunOf) -> Control:
    """Return a control whose templates are functions where files of hooks have some, one after the other."""
    templates: dict[str, Template] = dict(control.templates)
    for file in files:
        for place in OUTPUT_PLACES:
            if not place.function or place.function not in file.functions:
                continue
            own = place.templates if place.is_own else ()
            names = [name for name in templates if place_of(name) is place]
            for name in dict.fromkeys((*names, *own)):
                line = file.line_of(place.function)
                templates[name] = FunctionTemplate(
                    name, (), str(file.path), line, templates.get(name), place, file, run
                )
    return replace(control, templates=templates)


def _values(found: object) -> Any:
    """Return the records of templates as those of functions."""
    if isinstance(found, tuple):
        return tuple(map(_values, found))
    values = getattr(found, "values", None)
    if values is None:
        return None
    made: dict[str, Any] = {
        name: value.value() if isinstance(value, Later) else value for name, value in values.items()
    }
    plain: dict[str, Any] = {name: float(value) if isinstance(value, float) else value for name, value in made.items()}
    return OperationValues(**{**plain, "tool": _values(made["tool"])}) if "tool" in made else ToolValues(**plain)
