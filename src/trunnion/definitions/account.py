"""What is kept of a table of a definition while it is read: its values with their places, the keys that somebody asked
for, and the problems.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import field
from importlib.resources import files
from pathlib import PurePath
from typing import Final, Self

from trunnion.definitions.expected import Expected, Form, Question
from trunnion.definitions.messages import meant_word
from trunnion.definitions.source_lines import LocatedValue
from trunnion.definitions.units import unit_of, without_unit
from trunnion.errors import InputError, Problem, key_subject
from trunnion.messages import Wording
from trunnion.records import dataclass

#: Keys that are not known and are told one by one: for each a similar one is looked for.
_MOST_UNREAD: Final = 100

#: Keys that stand above all tables, and tables of the control that people write without its name.
_OF_WHOLE_FILE: Final = frozenset({"schema", "extends", "description"})
_OF_CONTROL: Final = frozenset({"templates", "settings", "known", "reading", "between_points"})

#: Tables that are called by their names.
_NAMED: Final = re.compile(r"(axis|body)\[\d+\]")

#: How the names of shipped files begin.
_SHIPPED: Final = str(files("trunnion"))


@dataclass(eq=False)
class TableAccount:
    """A table of a definition, the keys of it that have been read, and what is wrong with it; the getters are those of
    ``Table``.

    content    the table with the origin of each value
    path       its path from the root of the definition, such as ``axis[1]``
    problems   shared with all tables of the definition
    read_keys  keys that a getter has been called for
    children   tables that getters have returned
    questions  takes what getters ask for, if it is there; shared with all tables that are made of this one
    sources    files that were read for the definition, also those of which no value counts; its own first
    """

    content: LocatedValue
    path: str = ""
    problems: list[Problem] = field(default_factory=list)
    read_keys: dict[str, None] = field(default_factory=dict)
    children: list["TableAccount"] = field(default_factory=list)
    questions: list[Question] | None = None
    sources: tuple[str, ...] = ()

    # Locations

    @property
    def file(self) -> str:
        """File of the table, or of its last change."""
        return self.content.file

    @property
    def line(self) -> int:
        """Line of the table's header in ``file``."""
        return self.content.line

    def location(self, key: str) -> tuple[str, int]:
        """File and line of a key; those of the table if the key is missing."""
        content = self._values.get(key, self.content)
        return content.file, content.line

    def replaced(self, key: str) -> object:
        """Return the value of the definition that a call has replaced by another; None: it has replaced none."""
        return self._values[key].instead if key in self._values else None

    def text_location(self, key: str) -> tuple[str, int]:
        """File and line of the first line of a text, or of a list of lines; the line is 0 if it has none."""
        content = self._values.get(key, self.content)
        return content.file, content.line + content.begins_below if content.line else 0

    def is_in_one_line(self, key: str) -> bool:
        """Whether a list of lines begins in the line of its key: then that is the line of all of them."""
        content = self._values.get(key, self.content)
        return isinstance(content.value, list) and not content.begins_below

    def key_path(self, key: str) -> str:
        """Path of a key from the root of the definition, such as ``axis[1].limits_deg``."""
        return f"{self.path}.{key}" if self.path else key

    # Contents as a whole

    def keys(self) -> list[str]:
        """Every key of the table, in order, read or not."""
        return list(self._values)

    def __contains__(self, key: object) -> bool:
        return key in self._values

    def is_table(self, key: str) -> bool:
        """Whether a key has a table. Does not count as reading."""
        return key in self._values and isinstance(self._values[key].value, dict)

    def to_dict(self) -> dict[str, object]:
        """Return the whole table as plain dicts, lists and scalars. Does not count as reading."""
        plain = _plain(self.content)
        assert isinstance(plain, dict)
        return plain

    def unread_copy(self) -> Self:
        """Return the same table with no key read and no problem noted."""
        return self.other(self.content, [])

    def other(self, content: LocatedValue, problems: list[Problem], path: str | None = None) -> Self:
        """Return an unread table that notes what is asked where this one does; its path is this one's unless it is
        given.
        """
        return type(self)(
            content, self.path if path is None else path, problems, questions=self.questions, sources=self.sources
        )

    def names(self) -> list[str]:
        """Every key of a table whose keys the definition chooses itself, in order: none of them is unknown."""
        self._note("", Expected(Form.ANY_KEY))
        return list(self._values)

    def files(self) -> list[str]:
        """Every file that was read for this table, also where others overrule all of its values; sorted."""
        found = set(self.sources)
        _add_files(self.content, found)
        return sorted(found)

    @property
    def _values(self) -> dict[str, LocatedValue]:
        return self.content.value if isinstance(self.content.value, dict) else {}

    # Problems

    def add_problem(self, key: str, wording: Wording) -> None:
        """Note a mistake in the value of a key; an empty key means the table itself.

        Where the value comes from a shipped file, what another file says of this table is what does not fit it: that is
        the place.
        """
        file, line = self.location(key)
        path = self.key_path(key) if key else self.path
        if file != self.file and file.startswith(_SHIPPED):
            wording = wording.within("inherited", file=PurePath(file).name, line=line)
            file, line = self.file, self._own_line()
        self.problems.append(Problem(file, line, wording.of_key(self._said_path(key)), subject=key_subject(path)))

    def _said_path(self, key: str) -> str:
        """Return the path of a key as people call it: an axis by its letter, ``axis B limits_deg``."""
        name = self._values.get("name")
        kind = _NAMED.fullmatch(self.path)
        if kind is None or name is None or not isinstance(name.value, str) or not name.value.strip() or key == "name":
            return self.key_path(key) if key else self.path
        return f"{kind[1]} {name.value} {key}".rstrip()

    def _own_line(self) -> int:
        """Return the line of the one key that the last file to change the table states besides its name, or of its
        header.
        """
        lines = [each.line for key, each in self._values.items() if each.file == self.file and key != "name"]
        return lines[0] if len(lines) == 1 else self.line

    def raise_problems(self) -> None:
        """Raise every problem noted so far.

        Raises ``InputError`` if there is one, with all of them in the order of files and lines.
        """
        if self.problems:
            raise InputError(in_order(self.problems, self.sources))

    def report_unread_keys(self) -> None:
        """Note each key that has not been read; call it when the table has been read."""
        unread = [key for key in self._values if key not in self.read_keys]
        if len(unread) > _MOST_UNREAD:
            self.add_problem("", Wording("DEF330", "keys_not_known", count=len(unread)))
        for key in unread[:_MOST_UNREAD]:
            if self.path and key in _OF_WHOLE_FILE:
                self.add_problem(key, Wording("DEF320", "belongs_whole_file", key=key))
                continue
            if not self.path and key in _OF_CONTROL and "control" in self.read_keys:
                self.add_problem(key, Wording("DEF320", "belongs_control", key=key))
                continue
            same_stem = (known for known in self.read_keys if without_unit(known) == without_unit(key))
            similar = next((known for known in same_stem if unit_of(known)), "")
            if similar and unit_of(key) != unit_of(similar):
                self.add_problem(key, Wording("DEF325", "unit_does_not", similar=similar, unit_of=unit_of(similar)))
            else:
                near = meant_word(key, self.read_keys)
                if near:
                    self.add_problem(key, Wording("DEF320", "unknown_but_near", near=near))
                else:
                    self.add_problem(key, Wording("DEF320", "unknown", known=tuple(sorted(self.read_keys))))

    def mark_read(self, *keys: str) -> None:
        """Count keys as read without looking at them."""
        self.read_keys.update(dict.fromkeys(keys))

    def all_read_keys(self) -> set[str]:
        """Every key that was read here and below, without indices: ``axis.limits_deg``."""
        found = {re.sub(r"\[\d+\]", "", self.key_path(key)) for key in self.read_keys}
        return found.union(*(table.all_read_keys() for table in self.children))

    def _note(self, key: str, expected: Expected) -> None:
        if self.questions is not None:
            self.questions.append(Question(self.path, key, expected))


def in_order(problems: Iterable[Problem], sources: Sequence[str] = ()) -> list[Problem]:
    """Return problems, each once, by files and lines.

    sources  of the definition, its own file first. What does not fit it in a shipped file, which nobody is to change,
             is told of that own file, and comes last
    """
    found = dict.fromkeys(problems)
    own = next((file for file in sources if not file.startswith(_SHIPPED)), "")
    ordered = sorted(found, key=lambda each: (each.file.startswith(_SHIPPED), each.file, each.line))
    return [_told_of(each, own) if own and each.file.startswith(_SHIPPED) else each for each in ordered]


def _told_of(problem: Problem, own: str) -> Problem:
    """Return a problem in a shipped file as one of the file that extends it."""
    wording = problem.wording.within("inherited", file=PurePath(problem.file).name, line=problem.line)
    return Problem(own, 0, wording, severity=problem.severity, subject=problem.subject)


def _plain(content: LocatedValue) -> object:
    if isinstance(content.value, dict):
        return {key: _plain(item) for key, item in content.value.items()}
    if isinstance(content.value, list):
        return [_plain(item) if isinstance(item, LocatedValue) else item for item in content.value]
    return content.value


def _add_files(content: LocatedValue, files: set[str]) -> None:
    """Add the file of a value and those of the values in it."""
    files.add(content.file)
    value = content.value
    if isinstance(value, dict | list):
        for item in value.values() if isinstance(value, dict) else value:
            if isinstance(item, LocatedValue):
                _add_files(item, files)
