"""Options, and what was given of them."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from enum import Enum
from typing import Any, Final

from trunnion.options.kinds import FileOut, Kind, Setting, Switch, Text
from trunnion.records import dataclass


class Many(Enum):
    """How often an option may be given, or how many words an argument takes.

    ONE     once
    REPEAT  again and again, each time with one value
    LIST    with several values, also again
    MAYBE   an argument that may be missing; an option whose value may be
    ANY     an argument of any number of words
    SOME    an argument of at least one word
    TWO     an argument of two words
    """

    ONE = ""
    REPEAT = "repeat"
    LIST = "list"
    MAYBE = "?"
    ANY = "*"
    SOME = "+"
    TWO = "2"


class Level(Enum):
    """To what a key of a project belongs.

    WHOLE  the project as a whole
    SETUP  each set-up, or all of them
    OWN    each set-up: what is given in its place is refused where there are several
    """

    WHOLE = "whole"
    SETUP = "setup"
    OWN = "own"


#: Any text.
_TEXT: Final = Text()

#: More than one value.
SEVERAL: Final = frozenset({Many.REPEAT, Many.LIST, Many.ANY, Many.SOME, Many.TWO})


@dataclass(frozen=True, slots=True)
class Option:
    """One thing that can be said to a command.

    name      the argument of the library, under which its value is known
    flag      ``--tool-length``; empty: it is an argument, known by its place
    kind      of its values
    help      one line for the terminal
    meaning   what the pages of the docs say, in Markdown; empty: what ``help`` says
    default   where it is not given
    many      how often, and with how many values
    key       in project files and batches, or what they state in place of it, in the words of their pages; empty: they
              do not state it
    level     to what the key belongs
    setting   the setting that it stands for; empty: none
    required  it must be given
    either    of the options with the same word here one is given at most; ending in ``!``, exactly one
    aliases   flags of earlier versions, which are still understood with a warning
    own       it concerns the command line alone, and is no argument of the function that is run
    heading   under which ``--help`` lists it; empty: with the others
    metavar   what stands for its value; empty: that of the kind
    """

    name: str
    flag: str = ""
    kind: Kind = _TEXT
    help: str = ""
    meaning: str = ""
    default: Any = None
    many: Many = Many.ONE
    key: str = ""
    level: Level = Level.SETUP
    setting: str = ""
    required: bool = False
    either: str = ""
    aliases: tuple[str, ...] = ()
    own: bool = False
    heading: str = ""
    metavar: str = ""

    def but(self, **changes: Any) -> "Option":
        """Return the same option with other words for a command."""
        return replace(self, **changes)

    @property
    def value_name(self) -> str:
        """What stands for a value in a line of usage."""
        return self.metavar or self.kind.metavar

    @property
    def explained(self) -> str:
        """The line of help, with what it is where it is not given."""
        if self.default in (None, ""):
            return self.help
        value = f"{self.default:g}" if isinstance(self.default, int | float) else self.default
        return f"{self.help}; by default {value}"

    @property
    def empty(self) -> Any:
        """The value where it is not given."""
        if self.many in SEVERAL or isinstance(self.kind, Setting):
            return []
        if isinstance(self.kind, Switch) and self.default is None:
            return not self.kind.value
        return self.default


@dataclass(frozen=True, slots=True)
class Group:
    """Options that several commands share.

    title  what they are about
    """

    title: str
    options: tuple[Option, ...]

    def __iter__(self) -> Iterator[Option]:
        return iter(self.options)

    def but(self, **words: Mapping[str, Any]) -> "Group":
        """Return the same group with other words of some options, by their names."""
        return replace(self, options=tuple(each.but(**words.get(each.name, {})) for each in self.options))

    def only(self, *names: str) -> "Group":
        """Return some of the options."""
        return replace(self, options=tuple(each for each in self.options if each.name in names))

    def under(self, heading: str) -> "Group":
        """Return the same group under a heading of ``--help``."""
        return replace(self, options=tuple(each.but(heading=heading) for each in self.options))


def flat(parts: Iterable[Option | Group]) -> tuple[Option, ...]:
    """Options of a job, of which some come in groups."""
    return tuple(option for part in parts for option in ([part] if isinstance(part, Option) else part))


def outputs(options: Iterable[Option]) -> list[Option]:
    """Those that name files to write."""
    return [each for each in options if isinstance(each.kind, FileOut)]
