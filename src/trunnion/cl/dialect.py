"""What a dialect of CL files is: words and a few small functions. One reader reads them all."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from trunnion.cl.builder import NoAxis

if TYPE_CHECKING:
    from trunnion.cl.state import ReaderState
    from trunnion.cl.statement import Statement

#: Raises ``StatementError`` if the statement cannot be used.
Handler = Callable[["ReaderState", "Statement"], None]


@dataclass(slots=True, eq=False)
class CycleParts:
    """The fields of a ``CycleOn`` while they are collected: modes, couplets with numbers, words without."""

    mode: list[str] = field(default_factory=list)
    couplets: list[tuple[str, tuple[float, ...]]] = field(default_factory=list)
    words: list[tuple[str, str]] = field(default_factory=list)

    def take(self, word: str) -> tuple[float, ...] | None:
        """Remove the couplet of a word; return its numbers, None if there is none.

        One that is given twice stays, and is refused as that.
        """
        found = [couplet for couplet in self.couplets if couplet[0] == word]
        if len(found) == 1:
            self.couplets.remove(found[0])
        return found[0][1] if found else None


@dataclass(frozen=True, slots=True, eq=False)
class CycleWords:
    """How a dialect writes CYCLE; all becomes the words of NX's CLSF, which the toolpath has.

    modes      words of a kind of cycle, and the modes that they are
    words      words before numbers, and the words that they are
    positions  what the numbers directly behind a mode are, in their order; they need no word of their own
    numbers    words with numbers that ``settle`` takes
    refused    words that cannot be followed, and why
    settle     turns what the words say together into what the toolpath says; raises ``StatementError``
    """

    modes: Mapping[str, tuple[str, ...]]
    words: Mapping[str, str] = field(default_factory=dict)
    positions: tuple[str, ...] = ()
    numbers: frozenset[str] = frozenset()
    refused: Mapping[str, str] = field(default_factory=dict)
    settle: Callable[[CycleParts], None] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Dialect:
    """One way of writing CL files.

    name         for settings and messages in short
    title        for messages: what writes it
    marks        beginnings of lines that only this dialect has, in capitals
    handlers     what its statements mean, by their major words
    cycles       how it writes CYCLE
    comment      takes the text of a ``$$`` line that carries a statement
    after_comment  judges lines of comment that belong together, where other lines follow
    in_sections  operations stand between TOOL PATH and END-OF-PATH; else they begin with a tool, a name, a system
    no_axis      the tool axis of a point that gives none, before any statement about it
    multax_off   the same after MULTAX/OFF
    vectors      points may give tool axes before any MULTAX, and after MULTAX/OFF
    alias        takes twelve numbers behind a word that nobody knows: the coordinate system under another name
    upright      points with a tilted tool axis are in coordinates that the file does not give: what to do instead
    """

    name: str
    title: str
    marks: tuple[re.Pattern[bytes], ...]
    handlers: Mapping[str, Handler]
    cycles: CycleWords
    comment: Callable[[ReaderState, str], None] | None = None
    after_comment: Callable[[ReaderState], None] | None = None
    alias: Handler | None = None
    in_sections: bool = False
    no_axis: NoAxis = NoAxis.MODAL
    multax_off: NoAxis = NoAxis.DOUBTFUL
    vectors: bool = True
    upright: str = ""


def marks(*patterns: bytes) -> tuple[re.Pattern[bytes], ...]:
    """Beginnings of lines as patterns, blanks before them allowed."""
    return tuple(re.compile(rb"[ \t]*" + pattern, re.IGNORECASE) for pattern in patterns)
