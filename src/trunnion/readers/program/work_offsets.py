"""How a family of controls selects work offsets: the words of a program, and the values of a column."""

import re
from collections.abc import Callable

from trunnion.messages import Wording, declared
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class WorkOffsetWords:
    """The work offsets of a family.

    form   what they look like, for messages
    words  regular expression of one of them, with a group for each number
    value  ``Run.work_offset`` of the numbers of its groups (None where a group is absent); 0 for none
    name   the word that selects a value, as messages call it
    nth    the value of the first, the second and so on, from 1; 0 where the control has not so many
    plain  the setting ``work_offset`` is the number alone
    """

    form: str
    words: re.Pattern[str]
    value: Callable[[tuple[int | None, ...]], int]
    name: Callable[[int], str]
    nth: Callable[[int], int]
    plain: bool = False

    @property
    def form_said(self) -> Wording:
        """What they look like, in the language of who asks."""
        return declared(self.form, "forms")

    def setting(self, value: int) -> str:
        """Return the setting ``work_offset`` of a value."""
        return str(value) if self.plain else self.name(value)

    def value_of(self, text: str) -> int | None:
        """Return the value of a work offset as a program writes it; None if it is none."""
        found = self.words.fullmatch(text)
        return (self.value(tuple(int(group) if group else None for group in found.groups())) or None) if found else None


def g_word(value: int) -> str:
    """Return the G word of a value: 54 is G54."""
    return f"G{value}"


def first_number(numbers: tuple[int | None, ...]) -> int:
    """Return the first number: the value of an offset whose word has one number."""
    return numbers[0] or 0
