"""What a getter of a table asks of a key: the questions of all getters are the schema of a definition."""

from enum import StrEnum
from typing import Final, NamedTuple

from trunnion.records import dataclass

#: No length, angle, speed or count of a definition is greater; squares of what is do not overflow.
GREATEST: Final = 1e9


class Form(StrEnum):
    """The form of a value; a ``SETTING`` is a text, a number or a flag, and ``LINES`` are a text or a list of texts.

    With ``ANY_KEY`` the table itself is meant, whose keys the definition chooses.
    """

    TEXT = "text"
    SETTING = "setting"
    NUMBER = "number"
    WHOLE = "whole"
    FLAG = "flag"
    VECTOR = "vector"
    INTERVAL = "interval"
    TEXTS = "texts"
    LINES = "lines"
    TABLE = "table"
    TABLES = "tables"
    ANY_KEY = "any key"


@dataclass(frozen=True, slots=True)
class Expected:
    """What the value of a key must be.

    required                  the key must be there
    default                   what counts where it is not; None: nothing
    one_of                    the words of a text; empty: any
    pattern                   regular expression of all of a text; empty: any
    above, at_least, at_most  bounds of a number; None: none but ``GREATEST``
    size                      numbers of a vector
    nothing                   a word that may stand for a number; empty: none
    """

    form: Form
    required: bool = False
    default: object = None
    one_of: tuple[str, ...] = ()
    pattern: str = ""
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    size: int = 0
    nothing: str = ""


class Question(NamedTuple):
    """That a getter of the table at ``path`` (``axis[1]``) was called for a key."""

    path: str
    key: str
    expected: Expected
