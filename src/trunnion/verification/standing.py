"""What the word "passed" stands on: one record, from which every front says it.

In:     how many checks have which state, the warnings, and what the answers stand on.
Out:    ``Standing``, as data and in words.
"""

from collections.abc import Iterator
from enum import StrEnum
from typing import Annotated

from trunnion.messages import LIBRARY, Wording, Words, joined, phrase
from trunnion.records import dataclass
from trunnion.results import NOT_DATA, Figure
from trunnion.verification.grounds import NO_GROUNDS, Grounded, Grounds


class Verdict(StrEnum):
    """The word that every front says of what was judged: the name of its phrase."""

    PASSED = "passed"
    IN_PART = "passed_in_part"
    FAILED = "failed"
    NOTHING = "nothing_checked"

    @property
    def word(self) -> str:
        """As it is read."""
        return str(phrase(self.value))


@dataclass(frozen=True, slots=True)
class Standing(Grounded):
    """How a program stands.

    passed        no check failed, and nothing was overruled
    ok            how many checks were made, and found nothing
    failed        how many found something
    not_checked   how many were not made, or only in part
    warnings      that were given
    grounds       what the answers of the checks stand on besides the program
    assumed_unit  length unit that a CL file is taken to have: nothing says it
    moves         whether there is a motion: without one nothing of a path was checked
    no_cl_file    nothing says what is right: path, feeds, speeds and tools were compared with nothing
    """

    passed: bool
    ok: int
    failed: int
    not_checked: int
    warnings: int = 0
    grounds: Annotated[Grounds, Figure(is_flat=True)] = NO_GROUNDS
    assumed_unit: Annotated[str, Figure(is_optional=True, none="")] = ""
    moves: Annotated[bool, NOT_DATA] = True
    no_cl_file: Annotated[bool, Figure(is_optional=True, none=False)] = False

    @property
    @Figure(after="passed")
    def checks(self) -> int:
        """How many checks there are."""
        return self.ok + self.failed + self.not_checked

    @property
    def verdict(self) -> Verdict:
        """``PASSED`` only where every check was made, and wholly."""
        if not self.passed:
            return Verdict.FAILED
        if not (self.checks and self.moves):
            return Verdict.NOTHING
        return Verdict.IN_PART if self.not_checked else Verdict.PASSED

    def wordings(self) -> Iterator[Wording]:
        """Yield the parts of what is said behind the verdict."""
        if self.failed:
            yield phrase("standing_failed", failed=self.failed, count=self.checks)
        elif not self.passed:
            yield phrase("standing_forced", ok=self.ok, count=self.checks)
        elif not self.moves:
            yield phrase("standing_no_motion")
        elif self.checks:
            yield phrase("standing_passed", ok=self.ok, count=self.checks)
        if self.not_checked:
            yield phrase("standing_not_checked", count=self.not_checked)
        if self.no_cl_file and self.moves:
            yield phrase("standing_no_cl")
        if self.warnings:
            yield phrase("standing_warnings", count=self.warnings)
        yield from self.grounds.wordings()
        if self.assumed_unit:
            yield phrase("assumed_unit", unit=self.assumed_unit)

    def said(self, words: Words = LIBRARY) -> str:
        """Return what is said behind the verdict."""
        return joined(self.wordings(), words)

    def line(self, words: Words = LIBRARY) -> str:
        """Return the line that is said of the program."""
        verdict = phrase(self.verdict.value).text("what", words)
        return f"{verdict}: {said}" if (said := self.said(words)) else verdict

    @property
    @Figure("text")
    def told(self) -> str:
        """The line that is said of the program."""
        return self.line()
