"""Limits of what a program may do, so that every program ends."""

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.errors import InputError
from trunnion.messages import Wording
from trunnion.model.run import RunEvent
from trunnion.readers.program.source_text import SourceText

#: Diagnostics that are listed; further ones are counted.
MAX_DIAGNOSTICS: Final = 10_000

#: A program with so many errors is none for the control: the rest of it is not read.
MAX_ERRORS: Final = 10_000

#: Longer blocks and texts count once more for every so many characters; real ones are shorter.
CHARACTERS_PER_STEP: Final = 128

#: So many blocks of plain motion, which a kernel reads, take less time than one that is interpreted.
SCANNED_BLOCKS_PER_STEP: Final = 16

#: Working out the axes for a plane, a frame or a position takes as long as so many blocks; and how often a line may ask
#: for it.
BLOCKS_PER_RESOLUTION: Final = 16
RESOLUTIONS_PER_LINE: Final = 4

#: Motions of cycles, curves and ways home that a program may make for each line of its files, besides as many as it may
#: execute blocks, and how many that may be: they take memory.
MOTIONS_PER_LINE: Final = 250
MOST_MOTIONS: Final = 10_000_000

#: Blocks that a program may execute for each line of its files, besides its limit, and how many that may be: a call in
#: each line, of a macro of so many blocks, is sound. One that goes nowhere new is ended sooner.
BLOCKS_PER_LINE: Final = 50
MOST_BLOCKS: Final = 2_000_000

#: Whole turns of helices that a program may make for each line of its files, besides as many as it may execute blocks,
#: and how many that may be: the checks look at every turn.
TURNS_PER_LINE: Final = 50
MOST_TURNS: Final = 2_000_000

#: A program that goes in circles: so many blocks, after its files have been gone through once, without a position at
#: which it has not been before with this tool and work offset. It is looked at after so many blocks each time.
MOST_BLOCKS_IN_CIRCLES: Final = 15_000
_LOOKED_AT_AFTER: Final = 1_000

#: Positions are the same within this, mm and degrees.
_SAME_POSITION: Final = 1e-6

#: A program that jumps back so often without any condition between, in which a variable stands, never ends: in a loop
#: that ends, a condition is looked at each time.
MOST_JUMPS_WITHOUT_CHOICE: Final = 100

#: Subprograms that one program may call.
MAX_SUBPROGRAMS: Final = 1000

#: How deep subprograms may nest.
MAX_CALL_DEPTH: Final = 16


class StepCounter:
    """Counts the blocks that a program executes, and the comments and events that it makes.

    Going once through each file is free, and so is everything that a file contains once.

    sources    returns the files that are in use, the program first
    fail       returns the error of a program that does too much
    positions  returns where the tool goes in the rows from one on, (n, k) mm, degrees and whole numbers
    """

    def __init__(
        self,
        limit: int,
        sources: Callable[[], Sequence[SourceText]],
        fail: Callable[[Wording], InputError],
        positions: Callable[[int], Floats],
    ) -> None:
        self._limit = limit
        self._sources = sources
        self._fail = fail
        self._positions = positions
        self._visited: set[bytes] = set()
        self._row = 0
        self._look_at = _LOOKED_AT_AFTER
        self._in_circles = 0
        self._blocks = 0
        self._motions = 0
        self._records = 0
        self._events = 0

    def count_blocks(self, blocks: int, characters: int = 0) -> None:
        """Count executed blocks with so many characters."""
        self._blocks += blocks + max(characters, 0) // CHARACTERS_PER_STEP
        if self._blocks >= self._look_at:
            self._check_circles()
        if self._blocks <= self._limit:
            return
        most = self._limit + min(BLOCKS_PER_LINE * self._lines(), MOST_BLOCKS)
        if self._blocks > most + self._blocks_of_files():
            raise self._fail(Wording("NC140", "too_many_blocks", most=most))

    def count_motions(self, motions: int) -> None:
        """Count motions that have no block of their own: a program of many holes has a line for each, and ends."""
        self._motions += motions
        if self._motions <= self._limit:
            return
        most = self._limit + min(MOTIONS_PER_LINE * self._lines(), MOST_MOTIONS)
        if self._motions > most:
            raise self._fail(Wording("NC140", "too_many_motions", most=most))

    def check_turns(self, turns: int) -> None:
        """Check how many whole turns the helices have."""
        if turns <= self._limit:
            return
        most = self._limit + min(TURNS_PER_LINE * self._lines(), MOST_TURNS)
        if turns > most:
            raise self._fail(Wording("NC140", "too_many_turns", most=most))

    def _lines(self) -> int:
        """Return the lines of all files, as far as they are known."""
        return sum(source.known_lines for source in self._sources())

    def _blocks_of_files(self) -> int:
        """Return the blocks of going once through each file."""
        return self._lines() + sum(source.size // CHARACTERS_PER_STEP for source in self._sources())

    def _check_circles(self) -> None:
        """Check whether the program has been anywhere new lately, once it repeats blocks of its files."""
        passed, self._look_at = self._blocks - self._look_at + _LOOKED_AT_AFTER, self._blocks + _LOOKED_AT_AFTER
        new = self._positions(self._row)
        self._row += len(new)
        if self._blocks <= self._blocks_of_files():
            return
        counts = np.rint(new / _SAME_POSITION)
        before = len(self._visited)
        self._visited.update(counts[k].tobytes() for k in range(len(counts)))
        self._in_circles = self._in_circles + passed if len(self._visited) == before else 0
        if self._in_circles > MOST_BLOCKS_IN_CIRCLES:
            raise self._fail(Wording("NC140", "goes_in_circles", blocks=MOST_BLOCKS_IN_CIRCLES))

    def check_resolutions(self, resolutions: int) -> None:
        """Check how often the control has worked out its axes, which takes as long as many blocks."""
        least = self._limit // BLOCKS_PER_RESOLUTION
        if resolutions <= least:
            return
        most = least + RESOLUTIONS_PER_LINE * self._lines()
        if resolutions > most:
            raise self._fail(Wording("NC140", "too_many_resolutions", most=most))

    def count_records(self, records: int, characters: int) -> None:
        """Count comments or events with so many characters."""
        self._records += records + characters // CHARACTERS_PER_STEP
        if self._records <= self._limit:
            return
        most = self._limit + sum(source.size for source in self._sources())
        if self._records > most:
            raise self._fail(Wording("NC140", "too_many_records", most=most))

    def count_events(self, events: Sequence[RunEvent]) -> None:
        """Count the events that are new since the last call."""
        new = events[self._events :]
        if new:
            self._events += len(new)
            self.count_records(len(new), sum(len(event.value) for event in new if isinstance(event.value, str | tuple)))
