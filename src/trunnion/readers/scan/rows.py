"""Rows from the words of plain blocks: the second step of a scan, the same for all languages."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats, Floats2
from trunnion.jit import inner, kernel
from trunnion.model.toolpath import Kind
from trunnion.readers.scan.buffers import (
    FEED,
    MOTION_BITS,
    NORMAL,
    NORMAL_BITS,
    ROTARY,
    SLIDE,
    VECTOR,
    VECTOR_BITS,
    BlockWords,
    RowColumns,
    ScanRecords,
    ScanSettings,
)

#: The kind of a row that is a circle, whichever way it turns.
_CIRCLE: Final = int(Kind.ARC)


@kernel(writes="commanded rows records")
def execute_blocks(
    count: int,
    first_line: int,
    first_row: int,
    words: BlockWords,
    settings: ScanSettings,
    commanded: Floats,
    rows: RowColumns,
    records: ScanRecords,
) -> tuple[int, int, int, int]:
    """Write the rows of ``count`` blocks; returns the row after the last, and how many records of each kind there are.

    commanded  (5,) float64  programmed X, Y, Z, mm, the feed, and the feed of the row before; updated
    returns    next row, number of comments, of feed changes and of surface normals
    """
    row = first_row
    comments = feeds = normals = 0
    position_map, vector_map = settings.position_map, settings.vector_map
    for block in range(count):
        seen = words.seen[block]
        if seen & (1 << FEED):
            commanded[3] = words.values[block, FEED] * settings.feed_unit
        for k in range(3):
            if seen & (1 << (SLIDE + k)):
                commanded[k] = words.values[block, SLIDE + k] * settings.length_unit
        if seen & MOTION_BITS:
            pending = row - rows.base
            rows.line[pending] = first_line + block
            rows.block_number[pending] = words.number[block]
            rows.kind[row] = min(words.kind[block], _CIRCLE)
            rows.turn_rule[pending] = settings.turn_rule
            # An unknown feed (NaN) differs from itself, but is no change.
            if commanded[3] != commanded[4] and (commanded[3] == commanded[3] or commanded[4] == commanded[4]):
                records.feed_rows[feeds] = row
                records.feed_values[feeds] = commanded[3]
                commanded[4] = commanded[3]
                feeds += 1
            for k in range(3):
                rows.xyz[row, k] = (
                    position_map[k, 0] * commanded[0]
                    + position_map[k, 1] * commanded[1]
                    + position_map[k, 2] * commanded[2]
                    + position_map[k, 3]
                )
            for k in range(2):
                rows.rotary[row, k] = words.values[block, ROTARY + k] if seen & (1 << (ROTARY + k)) else np.nan
            # The bits of ``ProgrammedWord``: X, Y, Z and the rotary axes, 32 for a vector, 64 for a feed.
            bits = (seen >> SLIDE) & 0b11111
            if seen & (1 << FEED):
                bits |= 64
            rows.vector[pending, 0] = np.nan
            if seen & VECTOR_BITS:
                bits |= 32
                _transform(vector_map, words.values, block, VECTOR, seen, rows.vector, pending)
            rows.programmed[row] = bits
            if seen & NORMAL_BITS:
                _transform(vector_map, words.values, block, NORMAL, seen, records.normals, normals)
                records.normal_rows[normals] = row
                normals += 1
            row += 1
        if words.comment[block, 0] >= 0:
            records.comments[comments, 0] = first_line + block
            records.comments[comments, 1] = row
            records.comments[comments, 2] = words.comment[block, 0]
            records.comments[comments, 3] = words.comment[block, 1]
            comments += 1
    return row, comments, feeds, normals


@inner
def _transform(
    vector_map: Floats2, values: Floats2, block: int, slot: int, seen: int, target: Floats2, target_row: int
) -> None:
    """Write a programmed vector, whose components begin in ``slot``, to a row; components not written are 0."""
    x = values[block, slot] if seen & (1 << slot) else 0.0
    y = values[block, slot + 1] if seen & (1 << (slot + 1)) else 0.0
    z = values[block, slot + 2] if seen & (1 << (slot + 2)) else 0.0
    for axis in range(3):
        target[target_row, axis] = vector_map[axis, 0] * x + vector_map[axis, 1] * y + vector_map[axis, 2] * z
