"""In what form programs are written, and how their control starts: keys of ``[control.reading]`` of all families.

The keys stand in ``forms.toml``, with their words and what they mean: readers, schemas and docs are made of it.
"""

import tomllib
from collections.abc import Hashable, Mapping
from dataclasses import field
from functools import lru_cache
from importlib.resources import files
from typing import Final

from trunnion.definitions import Table
from trunnion.families import FAMILIES
from trunnion.machines import Machine
from trunnion.messages import Wording, phrase
from trunnion.readers.program.settings import family_of, reading_of
from trunnion.records import dataclass

#: Modes of a control with which it starts, by the key that says it: the word of the mode, and its value.
START: Final[Mapping[str, Mapping[str, tuple[str, Hashable]]]] = {
    "start_distances": {"absolute": ("distances", True), "incremental": ("distances", False)},
    "start_plane": {"G17": ("plane", 2), "G18": ("plane", 1), "G19": ("plane", 0)},
    "arc_centres": {"incremental": ("centres", True), "absolute": ("centres", False)},
}


@dataclass(frozen=True, slots=True)
class FormKey:
    """A key.

    words     what it may be
    families  folders of the readers that have it
    meaning   in Markdown
    several   it is a list of words
    """

    name: str
    words: tuple[str, ...]
    families: tuple[str, ...]
    meaning: str
    several: bool = False


@dataclass(frozen=True, slots=True)
class Form:
    """What a definition states, by the keys; what it does not state is as the family documents it."""

    one: Mapping[str, str] = field(default_factory=dict)
    lists: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def is_so(self, key: str, word: str) -> bool:
        """Whether a key is stated to be a word."""
        return self.one.get(key) == word

    def has(self, key: str) -> tuple[str, ...]:
        """Return the words of a list."""
        return self.lists.get(key, ())

    @property
    def start(self) -> dict[str, Hashable]:
        """The modes with which the control is stated to start."""
        return dict(START[key][word] for key, word in self.one.items() if key in START)


@lru_cache(maxsize=1)
def form_keys() -> tuple[FormKey, ...]:
    """Return all keys, in the order of their file."""
    text = files("trunnion").joinpath("readers", "program", "forms.toml").read_text(encoding="utf-8")
    return tuple(
        FormKey(name, tuple(own["words"]), tuple(own["families"]), own["meaning"], own.get("several", False))
        for name, own in tomllib.loads(text).items()
    )


def keys_of(family: str) -> tuple[FormKey, ...]:
    """Return the keys of a family of controls, by its name in definitions."""
    module = FAMILIES[family].reader or ""
    folder = module.split(".")[-2] if module else ""
    return tuple(key for key in form_keys() if folder in key.families)


def read_form(table: Table, family: str) -> Form:
    """Read the keys of a family; mistakes are added to the table's problems.

    table   ``[control.reading]``
    """
    one: dict[str, str] = {}
    lists: dict[str, tuple[str, ...]] = {}
    for key in keys_of(family):
        if key.several:
            lists[key.name] = _words(table, key)
        elif text := table.text(key.name, "", one_of=key.words):
            one[key.name] = text
    for sign in lists.get("more_comments", ()):
        if sign in lists.get("block_ends", ()):
            table.add_problem("block_ends", Wording("DEF330", "sign_of_comments", sign=sign))
    return Form(one, lists)


@lru_cache(maxsize=8)
def form_of(machine: Machine) -> Form:
    """Return the form of the programs of a machine; its definition has been checked."""
    return read_form(reading_of(machine), family_of(machine))


def _words(table: Table, key: FormKey) -> tuple[str, ...]:
    words = tuple(f'"{each}"' for each in key.words)
    found = table.texts(key.name, (), allowed=phrase("list_of_these", words=words))
    for word in found:
        if word not in key.words:
            allowed = phrase("one_of", words=words)
            table.add_problem(key.name, Wording("DEF330", "not_allowed", value=f'"{word}"', allowed=allowed))
    return tuple(word for word in key.words if word in found)
