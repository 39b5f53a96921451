"""What the scan kernels and the virtual control share: words of blocks, settings, rows, and records besides rows.

A scan has two steps. The kernel of a language reads plain blocks to ``BlockWords``; ``execute_blocks``, which all
languages share, turns them into rows.
"""

from typing import Final, NamedTuple

import numpy as np

from trunnion.arrays import Codes, Floats, Floats2, Ints, Ints2

#: Blocks that a scan reads at most. The buffers of everything that is recorded of blocks besides rows have this length.
MAX_BLOCKS: Final = 4096

#: Slots of the words of a block, that is columns of ``BlockWords.values`` and bits of ``BlockWords.seen``. Slots below
#: ``FEED`` are free for each kernel.
FEED: Final = 3
SLIDE: Final = 4  # X, and the two after it: Y, Z
ROTARY: Final = 7  # and the one after it
VECTOR: Final = 9  # and the two after it: the tool axis
NORMAL: Final = 12  # and the two after it: the surface normal
CENTRE: Final = 15  # and the two after it: the centre of a circle from its start
SLOT_COUNT: Final = 18

SLIDE_BITS: Final = 0b111 << SLIDE
ROTARY_BITS: Final = 0b11 << ROTARY
VECTOR_BITS: Final = 0b111 << VECTOR
NORMAL_BITS: Final = 0b111 << NORMAL
CENTRE_BITS: Final = 0b111 << CENTRE
MOTION_BITS: Final = SLIDE_BITS | ROTARY_BITS | VECTOR_BITS


class BlockWords(NamedTuple):
    """The words of up to m plain blocks, which are those of consecutive lines.

    seen     (m,) int64       bits of the words that are written
    kind     (m,) uint8       motion in force: 0 rapid, 1 line, 2 circle clockwise, 3 counter-clockwise
    number   (m,) int64       N number, -1 for none
    values   (m, 18) float64  numbers by their slots
    comment  (m, 2) int64     first byte of the comment, -1 for none, and the byte after it
    begin    (m,) int64       first byte of the block
    """

    seen: Ints
    kind: Codes
    number: Ints
    values: Floats2
    comment: Ints2
    begin: Ints

    @staticmethod
    def empty() -> "BlockWords":
        """Return buffers for ``MAX_BLOCKS`` blocks."""
        return BlockWords(
            np.empty(MAX_BLOCKS, np.int64),
            np.empty(MAX_BLOCKS, np.uint8),
            np.empty(MAX_BLOCKS, np.int64),
            np.empty((MAX_BLOCKS, SLOT_COUNT)),
            np.empty((MAX_BLOCKS, 2), np.int64),
            np.empty(MAX_BLOCKS, np.int64),
        )


class BlockModes(NamedTuple):
    """What holds where a scan of letters begins.

    motion   the motion in force: 0 rapid, 1 line, 2 and 3 circles, more for others
    vectors  whether A3= B3= C3= are allowed
    plane    the normal axis of the plane in which circles are plain; -1: none are
    """

    motion: int
    vectors: bool
    plane: int


class ScanSettings(NamedTuple):
    """What programmed numbers mean while blocks are scanned.

    length_unit   mm of a programmed length
    feed_unit     mm of the length in a programmed feed
    turn_rule     turn rules of both rotary axes, see ``trunnion.model.axis_positions``
    position_map  (3, 4) float64  from programmed position to ``RowColumns.xyz``
    vector_map    (3, 3) float64  from programmed vector to the workpiece frame
    """

    length_unit: float
    feed_unit: float
    turn_rule: int
    position_map: Floats2
    vector_map: Floats2


class RowColumns(NamedTuple):
    """The columns of a ``RowBuffer``. From ``line`` on, row r is at index r - ``base``."""

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
    """What is recorded of blocks besides rows.

    comments     (k, 4) int64    line, row, first byte and end of each comment
    feed_rows    (k,) int64      rows from which on another feed holds
    feed_values  (k,) float64    that feed
    normal_rows  (k,) int64      rows whose blocks program the surface normal
    normals      (k, 3) float64  that normal, workpiece frame, of the programmed length
    """

    comments: Ints2
    feed_rows: Ints
    feed_values: Floats
    normal_rows: Ints
    normals: Floats2

    @staticmethod
    def empty() -> "ScanRecords":
        """Return buffers with room for what ``MAX_BLOCKS`` blocks can hold."""
        return ScanRecords(
            np.empty((MAX_BLOCKS, 4), np.int64),
            np.empty(MAX_BLOCKS, np.int64),
            np.empty(MAX_BLOCKS),
            np.empty(MAX_BLOCKS, np.int64),
            np.empty((MAX_BLOCKS, 3)),
        )


class ScannedCircles(NamedTuple):
    """The circles of blocks that were read, in programmed positions, mm.

    block   (k,) int64      the block
    row     (k,) int64      its row, counted from that of the first block
    start   (k, 3) float64
    centre  (k, 3) float64  at the height of the start
    radius  (k,) float64
    """

    block: Ints
    row: Ints
    start: Floats2
    centre: Floats2
    radius: Floats

    @staticmethod
    def empty() -> "ScannedCircles":
        """Return buffers with room for what ``MAX_BLOCKS`` blocks can hold."""
        return ScannedCircles(
            np.empty(MAX_BLOCKS, np.int64),
            np.empty(MAX_BLOCKS, np.int64),
            np.empty((MAX_BLOCKS, 3)),
            np.empty((MAX_BLOCKS, 3)),
            np.empty(MAX_BLOCKS),
        )
