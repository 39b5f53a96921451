"""Rows of a motion with the splines that some of them stand for: these are lines of the family, the others blocks."""

from collections.abc import Sequence

import numpy as np

from trunnion.controls.family_writer import WordEvent
from trunnion.controls.words import WordRangeError
from trunnion.model.motion import Motion
from trunnion.model.splines import SplineRows
from trunnion.output.blocks.block_table import BlockTable
from trunnion.output.blocks.motion_blocks import MotionBlockWriter
from trunnion.output.changed_words import ChangedWords


def write_rows_and_splines(
    blocks: MotionBlockWriter,
    motion: Motion,
    first: int,
    last: int,
    joining_events: Sequence[WordEvent | ChangedWords],
    phase: int,
) -> int:
    """Write rows ``first`` to ``last`` (excluded), as ``MotionBlockWriter.write_rows`` does."""
    splines, start = motion.operation.splines, first
    for k in range(int(np.searchsorted(splines.first, first)), int(np.searchsorted(splines.first, last))):
        rows = splines[k]
        phase = blocks.write_rows(motion, start, rows.first, joining_events, phase)
        phase = _write_spline(blocks, motion, rows, joining_events, phase)
        start = rows.last + 1
    return blocks.write_rows(motion, start, last, joining_events, phase)


def _write_spline(
    blocks: MotionBlockWriter,
    motion: Motion,
    rows: SplineRows,
    joining_events: Sequence[WordEvent | ChangedWords],
    phase: int,
) -> int:
    """Write a spline, after a block with what is new at its start: the feed, and the events there."""
    moves, first, writer = motion.operation.moves, rows.first, blocks.writer
    phases, texts = blocks.phase_texts()
    own_phase = int(phases[moves.phase[first]])
    if own_phase not in (phase, -1):
        blocks.write_lines([texts[own_phase]])
    table, cuts = BlockTable(1), np.zeros(1, np.bool_)
    blocks.feeds.add_words(table, moves, slice(first, first + 1), cuts)
    blocks.feeds.force_at_mode_changes(table, cuts)
    for event in joining_events:
        if event.row == first:
            table.set_words(0, blocks.event_words(event))
    try:
        writer.write_table(table.columns, table.forced)
        formats = blocks.control.number_formats(motion.three_axis)
        blocks.write_lines(blocks.family.spline_lines(rows.spline, formats))
    except WordRangeError as error:
        raise error.at(blocks.program.file_of(motion.operation), int(moves.line[first])) from None
    writer.forget("motion", "X", "Y", "Z")
    blocks.tool_height, blocks.height_bound = float(moves.tip[rows.last, 2]), None
    blocks.progress(rows.last + 1 - first)
    return own_phase
