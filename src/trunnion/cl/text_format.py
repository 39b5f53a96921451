"""The form of CL text: how it is cut into points and statements, and how a statement is parsed.

Most systems write the statements of APT. A dialect of another form, such as pairs of lines of numbers, brings a scan
and a ``parse`` of its own; everything behind them is shared.
"""

from collections.abc import Callable
from functools import partial
from typing import Final, Protocol

from trunnion.arrays import Ints2
from trunnion.cl.scan import Piece, PointColumns, scan
from trunnion.cl.statement import Statement, parse
from trunnion.records import dataclass


class Scan(Protocol):
    """Reads a piece of a file until its lines, the rows or the spans are used up.

    row      first row of ``columns`` to write
    columns  of the points that the scan reads itself; the row of a span marked ``MAKES_ROW`` is NaN, for its handler
    spans    (s, 5) int64   written from 0 on: offset in the data, bytes, line, row before which it stands, marks
    returns  where to go on in the data, the line there, the next row, number of spans written

    Before the end of the file, a statement whose rest lies behind the piece is left for the next call; at the end it is
    marked ``UNFINISHED``. Marks are those of ``trunnion.cl.scan``.
    """

    def __call__(self, piece: Piece, row: int, columns: PointColumns, spans: Ints2) -> tuple[int, int, int, int]: ...


@dataclass(frozen=True, slots=True, eq=False)
class TextFormat:
    """The form of a CL file's text.

    scan        finds points and spans of statements
    parse       parses the bytes of a statement in the encoding of the file; raises ``StatementError``. The ``source``
                of a statement is ``MAJOR/values``, by which messages and definitions name it
    unfinished  the message for a file that ends within a statement
    has_words   statements begin with words: an unknown one may be damaged, or hide another statement, and is checked
    """

    scan: Scan
    parse: Callable[[bytes, str], Statement]
    unfinished: str
    has_words: bool = False


_CONTINUED: Final = "the file ends after a continuation sign $"

#: The text of APT dialects: comments with an arrow are statements, GOFWD and RETRCT are motions.
APT_TEXT: Final = TextFormat(partial(scan, True, 0), parse, _CONTINUED, has_words=True)

#: The text of NX CLSFs.
CLSF_TEXT: Final = TextFormat(partial(scan, False, 0), parse, _CONTINUED, has_words=True)

#: The text of CATIA, which prints no line of more than 72 columns: the last one continues a text, too.
CATIA_TEXT: Final = TextFormat(partial(scan, True, 72), parse, _CONTINUED, has_words=True)
