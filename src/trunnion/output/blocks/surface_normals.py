"""Surface normals in motion blocks, for controls that compensate the tool in three dimensions."""

import numpy as np

from trunnion.arrays import Flags
from trunnion.controls.vocabulary import SURFACE_NORMAL_WORDS, TOOL_VECTOR_WORDS, VECTOR_LINE_WORD
from trunnion.controls.words import ABSENT, round_to_counts
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Kind, Moves
from trunnion.output.blocks.block_table import BlockTable
from trunnion.output.blocks.block_writer import BlockWriter


def contact_rows(motion: Motion, rows: slice) -> Flags:
    """(n,) bool: rows of lines along which the tool touches a surface whose normal is to be written."""
    moves = motion.operation.moves
    if moves.normal is None or motion.mode.goes_straight:
        return np.zeros(len(moves.kind[rows]), np.bool_)
    return np.asarray((moves.kind[rows] == Kind.LINEAR) & np.isfinite(moves.normal[rows, 0]))


def add_vector_lines(
    table: BlockTable, moves: Moves, rows: slice, contact: Flags, uses_vectors: bool, writer: BlockWriter
) -> None:
    """Open blocks with a tool vector or a surface normal by ``VECTOR_LINE_WORD``; they get X, Y and Z, and the normal.

    table        with the tool vectors of the rows, where ``uses_vectors``
    moves, rows  those of the table, in the order of the operation
    contact      (n,) bool: as ``contact_rows`` returns it
    """
    written = table.columns[TOOL_VECTOR_WORDS[0]] != ABSENT if uses_vectors else contact
    _add_normals(table, moves, rows, written & contact, writer)
    table.columns[VECTOR_LINE_WORD] = np.where(written, 1, ABSENT)
    table.columns["line"] = np.where(written, ABSENT, table.columns["line"])
    for word in "XYZ":
        table.force(word, written)


def _add_normals(table: BlockTable, moves: Moves, rows: slice, written: Flags, writer: BlockWriter) -> None:
    if moves.normal is None or not written.any():
        return
    decimals = writer.word(SURFACE_NORMAL_WORDS[0]).format.decimals
    normal = np.where(written[:, None], moves.normal[rows], np.nan)
    for k, word in enumerate(SURFACE_NORMAL_WORDS):
        table.columns[word] = round_to_counts(np.ascontiguousarray(normal[:, k]), decimals)
