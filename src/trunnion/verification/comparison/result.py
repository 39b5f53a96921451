"""The result of a comparison."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, ClassVar

from trunnion.arrays import Ints
from trunnion.messages import LIBRARY, Wording, Words, phrase
from trunnion.records import dataclass
from trunnion.results import FIRST, NOT_DATA, Figure


@dataclass(frozen=True, slots=True)
class Difference:
    """One difference between two programs.

    one, two  the blocks of both programs
    value     its size, by which the worst one is found: millimetres between tips plus degrees between tool axes; 0
              where only words differ
    wording   what it is
    """

    one: Annotated[Wording, Figure(take=str)]
    two: Annotated[Wording, Figure(take=str)]
    value: float
    wording: Annotated[Wording, NOT_DATA]

    @property
    @Figure()
    def text(self) -> str:
        """What it is."""
        return self.wording.what


@dataclass(frozen=True, slots=True)
class DifferentRows:
    """A difference, at a row of each program."""

    one: int
    two: int
    wording: Wording


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
class UnknownWord:
    """A word of a program that is not understood, where it stands, and why."""

    file: str
    line: int
    why: Wording

    def line_of(self, words: Words = LIBRARY) -> str:
        """Return it in one line for a terminal."""
        begin = Wording("comparison", "not_understood", word="").text("what", words)  # as most reasons do
        word = self.why.with_cure().text("what", words).removeprefix(begin)
        return f"{self.file}:{self.line}: {Wording('comparison', 'not_understood', word=word).text('what', words)}"


@dataclass(frozen=True, slots=True)
class Comparison:
    """How two programs compare.

    points         how many points are on the same path
    tip, axis      the largest distances at these points, mm and degrees
    count          how many differences there are, those between the paths up to a limit; a feed, tool, offset or the
                   like that differs from one motion on to another is one
    unknown_words  words of either program that are not understood: then they cannot be called the same
    first_unknown  of each kind of them the first, and how many others there are: what a terminal shows
    stated         words and variables that both stand on, with what somebody has stated of them
    not_needed     words and variables that were stated for this comparison and that neither program needs
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
    first_unknown: Annotated[tuple[tuple[UnknownWord, ...], int], NOT_DATA] = ((), 0)
    stated: Annotated[tuple[str, ...], Figure(is_optional=True, none=())] = ()
    not_needed: Annotated[tuple[str, ...], Figure(is_optional=True, none=())] = ()

    @property
    @Figure(after=FIRST)
    def same(self) -> bool:
        """Whether both programs make the tool do the same; those that move nothing, or are not understood, do not."""
        return self.count == 0 and self.points > 0 and not self.unknown_words

    def within(self, sentence: str, /, **parameters: object) -> "Comparison":
        """Return it with its differences within another sentence of the catalogue ``around``."""
        first, worst = (
            each and replace(each, wording=each.wording.within(sentence, **parameters))
            for each in (self.first, self.worst)
        )
        return replace(self, first=first, worst=worst)

    def lines(self, words: Words = LIBRARY) -> Iterator[str]:
        """Yield the result for a terminal."""
        if not self.same:
            yield from (word.line_of(words) for word in self.first_unknown[0])
        yield from (wording.text("what", words) for wording in self._wordings())

    def _wordings(self) -> Iterator[Wording]:
        yield from self._compared()
        if self.stated:
            yield phrase("stands_on_stated", words=self.stated)
        yield from (Wording("comparison", "not_needed", word=word) for word in self.not_needed)

    def _compared(self) -> Iterator[Wording]:
        reached = {"points": self.points, "tip": self.tip, "axis": self.axis}
        if self.same:
            yield Wording("comparison", "same", **reached)
            return
        unknown = len(self.unknown_words)
        if self.first_unknown[1]:
            yield Wording("comparison", "more_words", count=self.first_unknown[1])
        if self.count and self.points:
            yield Wording("comparison", "different", count=self.count, **reached)
        elif self.count:
            yield Wording("comparison", "different_everywhere", count=self.count)
        elif unknown:
            yield Wording("comparison", "words_not_understood", count=unknown, points=self.points)
        else:
            yield Wording("comparison", "nothing_moves")
        for variant, what in (("first", self.first), ("worst", self.worst)):
            if what is not None and (variant == "first" or what != self.first):
                blocks = {"program": self.programs[0], "one": what.one, "other": self.programs[1], "two": what.two}
                yield Wording("comparison", variant, **blocks, difference=what.wording)
