"""Modes that a program says, which another may have left otherwise."""

from dataclasses import dataclass
from typing import Final

#: The mode that says where cycles end, which counts for a cycle alone.
END_OF_CYCLES: Final = "end of cycles"


@dataclass(frozen=True, slots=True)
class ModeWord:
    """A mode that holds from row ``before_row`` on because the program says so.

    mode  what it is of, such as ``plane``
    word  the word that holds; empty where the path shows which one: then it matters only that there is one
    """

    before_row: int
    mode: str
    word: str = ""
