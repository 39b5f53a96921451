"""What a dialect of CL files is: words and a few small functions. One reader reads them all."""

import re
from collections.abc import Callable, Mapping

from trunnion.cl.conventions import Conventions
from trunnion.cl.state import ReaderState
from trunnion.cl.statement import Statement
from trunnion.cl.text_format import APT_TEXT, TextFormat
from trunnion.records import dataclass

#: Raises ``StatementError`` if the statement cannot be used.
Handler = Callable[[ReaderState, Statement], None]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Dialect(Conventions):
    """One way of writing CL files.

    marks          beginnings of lines that only this dialect has
    first_line     beginning of the first line of its files, which settles that they are of this dialect; None: any line
    handlers       what its statements mean, by their major words
    text           the form of its text
    is_general     its marks are words that other dialects have as well: they count where no other has one
    comment        takes the text of a ``$$`` line that carries a statement
    after_comment  checks lines of comment that belong together, where other lines follow
    alias          takes twelve numbers behind an unknown word: the coordinate system under another name
    """

    marks: tuple[re.Pattern[bytes], ...]
    handlers: Mapping[str, Handler]
    text: TextFormat = APT_TEXT
    first_line: re.Pattern[bytes] | None = None
    is_general: bool = False
    comment: Callable[[ReaderState, str], None] | None = None
    after_comment: Callable[[ReaderState], None] | None = None
    alias: Handler | None = None


def marks(*patterns: bytes) -> tuple[re.Pattern[bytes], ...]:
    """Beginnings of lines as patterns in capitals or not, blanks before them allowed."""
    return tuple(re.compile(rb"[ \t]*" + pattern, re.IGNORECASE) for pattern in patterns)
