"""The settings that the messages of a post ask for, and a project to fill them in.

In:     messages, whose cures name settings: ``spindle=OP1:RPM`` wants a number in place of RPM, ``holes=planes`` wants
        a decision.
Out:    ``AskedSetting``; the text of a project that states them.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from typing import Final

from trunnion.definitions.toml_text import written, written_key
from trunnion.errors import Problem, Severity
from trunnion.jobs.post.settings_to_fill import GATHERED, entries_to_fill
from trunnion.jobs.project.project import Division
from trunnion.jobs.project.settings import OWN_KEYS
from trunnion.messages import LIBRARY, Wording, Words, phrase
from trunnion.records import dataclass

#: A value, or the end of one, in whose place something is to be written.
_TO_FILL: Final = re.compile(r"(?:^|[:,])(?:[A-Z][A-Z_]*|…)$")

#: The name of a value among several.
_NAMED: Final = re.compile(r"(?:^|,)([^,=]*)=")

#: What the setting ``programs`` says by other words than the key ``divide``.
_OF_DIVIDE: Final = {"operations": Division.SUBPROGRAMS.value}

#: The first word of a value that lets through what is refused otherwise.
WAIVES: Final = "allowed"


@dataclass(slots=True)
class AskedSetting:
    """A setting that messages ask for.

    values    one, or one for each operation
    to_fill   words in capitals stand for numbers; else the value is a decision that the message offers
    problems  messages that name it
    """

    name: str
    values: list[str]
    to_fill: bool
    problems: list[Problem] = field(default_factory=list)

    @property
    def value(self) -> str:
        """The whole value."""
        return ",".join(self.values)

    @property
    def is_needed(self) -> bool:
        """Whether an error asks for it."""
        return any(each.severity is Severity.ERROR for each in self.problems)


def asked_settings(problems: Iterable[Problem]) -> list[AskedSetting]:
    """Return the settings that messages ask for, in the order in which they do, each once."""
    found: dict[tuple[str, bool], AskedSetting] = {}
    for problem in problems:
        for name, stated in entries_to_fill(problem, str(problem.wording.parameter("operation") or "")):
            to_fill = _TO_FILL.search(stated) is not None
            asked = found.setdefault((name, to_fill), AskedSetting(name, [], to_fill))
            values = stated.split(",") if ":" in stated else [stated]
            several = ":" in stated and all(":" in value for value in asked.values)
            asked.values += [value for value in values if value not in asked.values and (several or not asked.values)]
            asked.problems += [] if problem.code == GATHERED else [problem]
    return list(found.values())


def project_text(
    keys: Mapping[str, object],
    settings: Mapping[str, str],
    asked: Sequence[AskedSetting],
    head: Sequence[Wording],
    words: Words = LIBRARY,
) -> str:
    """Return a project that posts what was posted, with the settings that its messages ask for.

    keys      of the project, as they were given
    settings  that were given
    head      lines that stand above it as comments
    words     the language of the comments
    """
    own, table = list[str](), list[str]()
    given = dict(settings)
    for each in asked:
        before = given.pop(each.name, "") if each.to_fill and each.is_needed else ""
        value = f"{before},{each.value}" if before else each.value
        key, lines = OWN_KEYS.get(each.name), own
        if key is None:
            key, lines = written_key(each.name), table
        lines += ["", *_reasons(each.problems, words)]
        mark = "" if each.to_fill and each.is_needed else "# "
        lines.append(f"{mark}{key} = {written(_of_key(each.name, value) if lines is own else value)}")
    stated = [f"{OWN_KEYS[key]} = {written(_of_key(key, value))}" for key, value in given.items() if key in OWN_KEYS]
    stated += [f"{key} = {written(value)}" for key, value in keys.items()]
    others = [f"{written_key(key)} = {written(value)}" for key, value in given.items() if key not in OWN_KEYS]
    head = [*head, *([phrase("first_fill_in")] if asked else [])]
    comments = [_printable(f"# {each.text('what', words)}") for each in head]
    return "\n".join([*comments, *stated, *own, "", "[settings]", *others, *table, ""])


def _of_key(setting: str, text: str) -> object:
    """Return the value of a setting as its own key in a project has it."""
    return _OF_DIVIDE.get(text, text) if setting == "programs" else _value(text)


def _value(text: str) -> object:
    """Return the number or the numbers of a setting, or a table of them, as its own key has them; a text that is none
    as it is.
    """
    if "=" in text:
        _, *parts = _NAMED.split(text)
        return {name.strip(): _value(value) for name, value in zip(parts[::2], parts[1::2], strict=True)}
    try:
        found = [float(part) for part in text.split(",")]
    except ValueError:
        return text
    return found if len(found) > 1 else found[0]


def _reasons(problems: Sequence[Problem], words: Words) -> list[str]:
    """Return comments that say why: the first message of each kind, with the number of the others."""
    kinds: dict[str, list[Problem]] = {}
    for each in problems:
        kinds.setdefault(each.code, []).append(each)
    return [_reason(same[0], len(same) - 1, words) for same in kinds.values()]


def _reason(problem: Problem, others: int, words: Words) -> str:
    """Return why: with the cure, which has the conditions of what it offers."""
    what, cure = (problem.wording.text(part, words) for part in ("what", "cure"))
    if others:
        what = phrase("and_like_it", what=what, count=others).text("what", words)
    if problem.line:
        what = phrase("in_line_said", line=problem.line, severity=problem.severity.said(words), what=what).text(
            "what", words
        )
    else:
        what = f"{problem.severity.said(words)}: {what}"
    said = Wording("terminal", "joined", texts=tuple(filter(None, (what, cure)))).text("what", words)
    return _printable(f"# {said} [{problem.code}]")


def _printable(text: str) -> str:
    return "".join(letter if letter.isprintable() else "?" for letter in text)
