"""What a scan kernel and the virtual control hand to each other: counters, columns with room, and notes."""

from typing import Final, NamedTuple

from trunnion.arrays import Codes, Floats, Floats2, Ints, Ints2

#: Fields of ``counters``: motion kind (0 rapid, 1 line, more for circles), rows, comments, place in the text, feeds,
#: surface normals.
KIND: Final = 0
ROW: Final = 1
COMMENTS: Final = 2
POSITION: Final = 3
LINE: Final = 4
FEEDS: Final = 5
NORMALS: Final = 6
COUNTER_COUNT: Final = 7

#: Comments, feeds and normals that a kernel may note before it comes back.
RECORD_CAPACITY: Final = 4096


class ScanTarget(NamedTuple):
    """Columns that rows go to; see ``RowBuffer``. In those from ``line`` on, row r is at r - ``base``."""

    kind: Codes
    programmed: Codes
    xyz: Floats2
    rotary: Floats2
    base: int
    line: Ints
    block_number: Ints
    vector: Floats2
    turn_rule: Codes


class ScanRecords(NamedTuple):
    """What the kernel notes besides rows, written from the top; ``counters`` says how many there are.

    comments    (k, 4) int64   line, row, first byte and end of each comment
    feed_rows   (k,) int64     rows from which another feed holds
    feed_values (k,) float64   that feed
    touching    (k,) int64     rows whose blocks say the surface's normal
    normals     (k, 3) float64 that normal, workpiece frame, as long as it was said
    numbers     (12,) float64  the numbers of one block, while it is being read
    """

    comments: Ints2
    feed_rows: Ints
    feed_values: Floats
    normal_rows: Ints
    normals: Floats2
    numbers: Floats
