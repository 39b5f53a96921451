"""The settings that the messages of a post ask for, and a project to fill them in.

In:     messages, whose cures name settings: ``spindle=OP1:RPM`` wants a number in place of RPM, ``holes=planes`` wants
        a decision.
Out:    ``AskedSetting``; the text of a project that states them.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from trunnion.definitions.toml_text import written, written_key
from trunnion.errors import Problem, Severity
from trunnion.jobs.post.settings_to_fill import GATHERED, entries_to_fill
from trunnion.jobs.project.keys import SETTINGS
from trunnion.wording import counted

#: A value, or the end of one, in whose place something is to be written.
_TO_FILL: Final = re.compile(r"(?:^|[:,])(?:[A-Z][A-Z_]*|…)$")

#: Settings that have a key of their own in projects.
_KEYS: Final = {each.setting: each.key for each in SETTINGS if each.key != each.setting}

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
    name: str,
    unnamed: Sequence[str] = (),
) -> str:
    """Return a project that posts what was posted, with the settings that its messages ask for.

    keys      of the project, as they were given
    settings  that were given
    name      of its file
    unnamed   operations that no setting can name
    """
    own, table = list[str](), list[str]()
    given = dict(settings)
    for each in asked:
        before = given.pop(each.name, "") if each.to_fill and each.is_needed else ""
        value = f"{before},{each.value}" if before else each.value
        key, lines = _KEYS.get(each.name), own
        if key is None:
            key, lines = written_key(each.name), table
        lines += ["", *_reasons(each.problems)]
        mark = "" if each.to_fill and each.is_needed else "# "
        lines.append(f"{mark}{key} = {written(_numbers(value) if lines is own else value)}")
    stated = [f"{_KEYS[key]} = {written(_numbers(value))}" for key, value in given.items() if key in _KEYS]
    stated += [f"{key} = {written(value)}" for key, value in keys.items()]
    others = [f"{written_key(key)} = {written(value)}" for key, value in given.items() if key not in _KEYS]
    head = [
        f"# To post it: trunnion post {name}",
        *(["# First write values for the words in capitals, and take the # from what you decide so."] if asked else []),
        *(
            _printable(f"# No setting can name {each}: name it otherwise in CAM, or state a value for all.")
            for each in unnamed
        ),
    ]
    return "\n".join([*head, *stated, *own, "", "[settings]", *others, *table, ""])


def _numbers(text: str) -> object:
    """Return the number or the numbers of a setting, as its own key has them; a text that is none as it is."""
    try:
        found = [float(part) for part in text.split(",")]
    except ValueError:
        return text
    return found if len(found) > 1 else found[0]


def _reasons(problems: Sequence[Problem]) -> list[str]:
    """Return comments that say why: the first message of each kind, with the number of the others."""
    kinds: dict[str, list[Problem]] = {}
    for each in problems:
        kinds.setdefault(each.code, []).append(each)
    return [_reason(same[0], len(same) - 1) for same in kinds.values()]


def _reason(problem: Problem, others: int) -> str:
    more = f", and {counted(others, 'message')} like it" if others else ""
    place = f"line {problem.line}: " if problem.line else ""
    text = f"# {place}{problem.severity}: {problem.what}{more} [{problem.code}]"
    return _printable(text)


def _printable(text: str) -> str:
    return "".join(letter if letter.isprintable() else "?" for letter in text)
