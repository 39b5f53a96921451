"""What a dialect of CL files means by what its statements leave unsaid: what the handlers of statements ask of it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from trunnion.cl.builder import NoAxis


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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Conventions:
    """What is understood in a dialect.

    name         for settings and messages in short
    title        for messages: what writes it
    cycles       how it writes CYCLE
    end          the statement behind the last motion, for messages
    in_sections  operations stand between TOOL PATH and END-OF-PATH; else they begin with a tool, a name, a system
    no_axis      the tool axis of a point that gives none, before any statement about it
    multax_off   the same after MULTAX/OFF
    vectors      points may give tool axes before any MULTAX, and after MULTAX/OFF
    upright      points with a tilted tool axis are in coordinates that the file does not give: what to do instead
    """

    name: str
    title: str
    cycles: CycleWords
    end: str = "FINI"
    in_sections: bool = False
    no_axis: NoAxis = NoAxis.MODAL
    multax_off: NoAxis = NoAxis.DOUBTFUL
    vectors: bool = True
    upright: str = ""
