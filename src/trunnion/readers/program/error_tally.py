"""How many errors of which kind a program has: with too many it is none for the control, and is not read to its end.

In:     each error with its place.
Out:    nothing, or an ``InputError`` that names the kinds, the most frequent ones first, with the first line of each.
"""

from collections import Counter
from typing import Final

from trunnion.errors import InputError, Problem, mistake_of
from trunnion.messages import Wording, phrase
from trunnion.readers.program.limits import MAX_ERRORS

#: Kinds that the message names.
_MOST_KINDS: Final = 5


class ErrorTally:
    """Counts errors by their kind."""

    def __init__(self) -> None:
        self._counts = Counter[tuple[str, ...]]()
        self._first: dict[tuple[str, ...], tuple[int, Wording]] = {}
        self._total = 0

    def add(self, file: str, line: int, wording: Wording) -> None:
        """Count an error; raises ``InputError`` if there are too many."""
        kind = mistake_of(wording)
        self._counts[kind] += 1
        self._first.setdefault(kind, (line, wording))
        self._total += 1
        if self._total >= MAX_ERRORS:
            raise InputError(Problem(file, line, self._too_many()))

    def _too_many(self) -> Wording:
        kinds = tuple(
            phrase("errors_of_kind", count=count, line=self._first[kind][0], first=self._first[kind][1])
            for kind, count in self._counts.most_common(_MOST_KINDS)
        )
        return Wording("NC150", "too_many_errors", most=MAX_ERRORS, kinds=kinds)
