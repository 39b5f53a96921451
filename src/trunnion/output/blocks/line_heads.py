"""What lines of text begin with: block numbers of their own, and signs of block skip."""

import re
from typing import Final

from trunnion.controls.words import BlockNumbers
from trunnion.errors import InputError, argument_problem
from trunnion.messages import Wording

#: The sign of block skip with its level, which is one figure.
_SKIP: Final = re.compile(r"[ \t]*(/(?:[1-9](?![0-9.]))?)[ \t]*")

#: The sign alone, where a figure behind it may be a block number.
_PLAIN_SKIP: Final = re.compile(r"[ \t]*(/)[ \t]*")


class LineHeads:
    """Reads the heads of lines of text as a control with these numbers does."""

    def __init__(self, numbers: BlockNumbers) -> None:
        counts = numbers.letter and numbers.numbered
        number = rf"[ \t]*{re.escape(numbers.letter)}[ \t]*([0-9]+)"
        self._number = re.compile(number, re.IGNORECASE | re.ASCII) if counts else None
        self._skip = _SKIP if numbers.letter else _PLAIN_SKIP

    def split_skip(self, text: str) -> tuple[str, str]:
        """Return the skip sign of a line as it stands before a block number, empty for none, and the rest."""
        match = self._skip.match(text)
        if match is None:
            return "", text
        sign = match[1]
        return (sign if len(sign) == 1 else f"{sign} "), text[match.end() :]

    def own_number(self, text: str) -> int | None:
        """Return the number that a line without its skip sign brings; None for none, or if blocks have no numbers."""
        match = None if self._number is None else self._number.match(text)
        return None if match is None else int(match[1][:20])


class GivenNumbers:
    """The block numbers of one file: those that lines bring, held against those that automatic numbering gives."""

    def __init__(self, numbers: BlockNumbers) -> None:
        self._numbers = numbers
        self._own: set[int] = set()
        self._next, self._wrapped = numbers.start, False

    def add(self, own: set[int], following: int, blocks: int) -> None:
        """Take up what has been written.

        own        the numbers that its lines bring
        following  the next automatic number behind it
        blocks     how many blocks it has at most

        Raises ``InputError`` if automatic numbering gives the number of a line to another block, before or behind it.
        """
        numbers = self._numbers
        given = (numbers.highest - numbers.start) // numbers.step + 1
        # As many blocks as there are numbers may use all of them, and end where they began.
        self._wrapped |= following < self._next or blocks * bool(numbers.every) >= given * max(1, numbers.every)
        self._next = following
        self._own |= own
        taken = [number for number in sorted(self._own) if self._is_given(number)]
        if taken:
            raise self._repeated(taken[0])

    def _is_given(self, number: int) -> bool:
        last = self._numbers.highest if self._wrapped else self._next - 1
        return self._is_automatic(number) and number <= last

    def _is_automatic(self, number: int) -> bool:
        numbers = self._numbers
        return numbers.start <= number <= numbers.highest and (number - numbers.start) % numbers.step == 0

    def _repeated(self, number: int) -> InputError:
        letter = self._numbers.letter
        free = next((each for each in (number + 1, self._numbers.start - 1) if not self._is_automatic(each)), 0)
        return InputError(
            argument_problem(
                "templates",
                Wording("CTL115", "line_brings_block", letter=letter, number=number, free=free)
                if free > 0
                else Wording("CTL115", "line_brings_block_number", letter=letter, number=number),
            )
        )
