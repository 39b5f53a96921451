"""The conventions of a dialect of CL files: what its files leave unsaid, and handlers of statements ask for."""

from collections.abc import Callable, Mapping
from dataclasses import field

from trunnion.cl.builder import NoAxis
from trunnion.records import dataclass


@dataclass(slots=True, eq=False)
class CycleParts:
    """The fields of a ``CycleOn`` while they are collected: modes, couplets, and words without numbers."""

    mode: list[str] = field(default_factory=list)
    couplets: list[tuple[str, tuple[float, ...]]] = field(default_factory=list)
    words: list[tuple[str, str]] = field(default_factory=list)

    def take(self, word: str) -> tuple[float, ...] | None:
        """Remove the couplet of a word; return its numbers, None if there is none.

        A couplet that is given twice stays, and is refused later.
        """
        found = [couplet for couplet in self.couplets if couplet[0] == word]
        if len(found) == 1:
            self.couplets.remove(found[0])
        return found[0][1] if found else None


@dataclass(frozen=True, slots=True, eq=False)
class CycleWords:
    """How a dialect writes CYCLE; the toolpath has the words of NX's CLSF.

    modes      words for a kind of cycle, with their modes in a CLSF
    words      words before numbers, with their words in a CLSF
    positions  the words of the numbers directly behind a mode, in order, where the dialect leaves them out
    numbers    words with numbers that ``settle`` takes
    refused    words whose meaning is not settled, with the reason
    settle     completes a cycle whose words depend on each other; raises ``StatementError``
    """

    modes: Mapping[str, tuple[str, ...]]
    words: Mapping[str, str] = field(default_factory=dict)
    positions: tuple[str, ...] = ()
    numbers: frozenset[str] = frozenset()
    refused: Mapping[str, str] = field(default_factory=dict)
    settle: Callable[[CycleParts], None] | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Conventions:
    """What the files of a dialect leave unsaid.

    name         its name in settings
    title        its name in messages
    cycles       how it writes CYCLE
    end          the statement behind the last motion, for messages
    has_end      files end with that statement, also where operations have an end of their own
    is_strict    a statement that is not known is an error
    in_sections  operations stand between TOOL PATH and END-OF-PATH; else a tool, a name or a system begins one
    no_axis      the tool axis of a point that gives none, before any statement about it
    multax_off   the same after MULTAX/OFF
    vectors      points may give tool axes before any MULTAX, and after MULTAX/OFF
    upright      the cure for points with a tilted tool axis, whose coordinates the file does not give; empty: read them
    """

    name: str
    title: str
    cycles: CycleWords
    end: str = "FINI"
    has_end: bool = True
    is_strict: bool = False
    in_sections: bool = False
    no_axis: NoAxis = NoAxis.MODAL
    multax_off: NoAxis = NoAxis.DOUBTFUL
    vectors: bool = True
    upright: str = ""
