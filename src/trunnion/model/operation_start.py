"""Where an operation begins in a program, which its writer knows: what ends the one before it stands above."""

from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class OperationStart:
    """The first line of an operation: home, tool change and positioning follow it.

    file    name of the subprogram it is in, empty for the program itself
    line    counted from 1
    number  of its first block that may have one, -1 if that has none
    """

    file: str
    line: int
    number: int
