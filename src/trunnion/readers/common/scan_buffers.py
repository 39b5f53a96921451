"""What a scan kernel and the virtual control hand to each other: counters, columns with room, and notes."""

from typing import Final, NamedTuple

from trunnion.arrays import Codes, Floats, Ints

#: Fields of ``counts``: motion kind (0 rapid, 1 line, more for circles), rows, comments, place in the text, feeds,
#: surface normals.
KIND: Final = 0
ROW: Final = 1
COMMENTS: Final = 2
POSITION: Final = 3
LINE: Final = 4
FEEDS: Final = 5
NORMALS: Final = 6
FIELDS: Final = 7

#: Comments, feeds and normals that a kernel may note before it comes back.
ROOM: Final = 4096


class Target(NamedTuple):
    """Columns that rows go to; see ``Columns``. In those from ``block`` on, row r is at r - ``base``."""

    kind: Codes
    programmed: Codes
    place: Floats
    rotary: Floats
    base: int
    block: Ints
    number: Ints
    vector: Floats
    way: Codes


class Notes(NamedTuple):
    """What the kernel notes besides rows, written from the top; ``counts`` says how many there are.

    comments    (k, 4) int64   line, row, first byte and end of each comment
    feed_rows   (k,) int64     rows from which another feed holds
    feeds       (k,) float64   that feed
    touching    (k,) int64     rows whose blocks say the surface's normal
    normals     (k, 3) float64 that normal, workpiece frame, as long as it was said
    numbers     (12,) float64  the numbers of one block, while it is being read
    """

    comments: Ints
    feed_rows: Ints
    feeds: Floats
    touching: Ints
    normals: Floats
    numbers: Floats
