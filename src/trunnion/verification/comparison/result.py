"""The result of a comparison."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import ClassVar, Final

from trunnion.arrays import Ints
from trunnion.results import FIRST, Figure
from trunnion.wording import counted

#: Words that are not understood which a result names one by one.
_MOST_NAMED: Final = 10


@dataclass(frozen=True, slots=True)
class Difference:
    """One difference between two programs.

    one, two  the blocks of both programs
    value     its size, by which the worst one is found: millimetres between tips plus degrees between tool axes; 0
              where only words differ
    text      what it is
    """

    one: str
    two: str
    value: float
    text: str


@dataclass(frozen=True, slots=True)
class DifferentRows:
    """A difference, at a row of each program."""

    one: int
    two: int
    text: str


@dataclass(frozen=True, slots=True, eq=False)
class Alignment:
    """Where two programs go together, and where they differ.

    pairs        (k, 2) int64, rows of both that go the same way to the same point, in their order
    differences  the first ones, up to a limit, in the order in which they were found
    count        how many there are, as ``Comparison`` counts them
    """

    pairs: Ints
    differences: tuple[DifferentRows, ...]
    count: int


@dataclass(frozen=True, slots=True)
class Comparison:
    """How two programs compare.

    points         how many points are on the same path
    tip, axis      the largest distances at these points, mm and degrees
    count          how many differences there are, those between the paths up to a limit; a feed, tool, offset or the
                   like that differs from one motion on to another is one
    unknown_words  words of either program that are not understood: then they cannot be called the same
    """

    SCHEMA: ClassVar[int] = 1

    programs: tuple[str, str]
    points: int
    tip: float
    axis: float
    count: int
    first: Difference | None
    worst: Difference | None
    unknown_words: tuple[str, ...] = ()

    @property
    @Figure(after=FIRST)
    def same(self) -> bool:
        """Whether both programs make the tool do the same; those that move nothing, or are not understood, do not."""
        return self.count == 0 and self.points > 0 and not self.unknown_words

    def with_words(self, words: str) -> "Comparison":
        """Return it with words behind those of its differences."""
        differences = [each and replace(each, text=each.text + words) for each in (self.first, self.worst)]
        return replace(self, first=differences[0], worst=differences[1])

    def lines(self) -> Iterator[str]:
        """Yield the result for a terminal."""
        points = counted(self.points, "point")
        within = f"tips within {self.tip:.6f} mm, tool axes within {self.axis:.6f} degrees"
        if self.same:
            yield f"same: {points}, {within}"
            return
        yield from self.unknown_words[:_MOST_NAMED]
        if len(self.unknown_words) > _MOST_NAMED:
            yield f"and {counted(len(self.unknown_words) - _MOST_NAMED, 'word')} more that are not understood"
        if self.count:
            reached = f"{points}, {within}" if self.points else points
            yield f"different: {counted(self.count, 'place')}; on the same path: {reached}"
        elif self.unknown_words:
            words = counted(len(self.unknown_words), "word")
            yield f"not compared: {words} not understood; otherwise the same: {points}"
        else:
            yield "not compared: neither program moves the tool"
        for name, what in (("first", self.first), ("worst", self.worst)):
            if what is not None and (name == "first" or what != self.first):
                yield f"{name}: {self.programs[0]}:{what.one} against {self.programs[1]}:{what.two}: {what.text}"
