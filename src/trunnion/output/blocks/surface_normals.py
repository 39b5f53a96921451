"""The surface's normal in motion blocks: in which rows it is said, and its words.

In:     rows of a motion as it is written, with the column ``Moves.normal`` where somebody asked for it.
Out:    flags, and counts of the last printed digit.
"""

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.controls.vocabulary import SURFACE_NORMAL_WORDS
from trunnion.controls.words import round_to_counts
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Kind, Moves
from trunnion.output.blocks.block_writer import BlockWriter


def contact_rows(motion: Motion, part: slice) -> Flags:
    """Rows of a line along which the tool touches a surface whose normal is to be said."""
    moves = motion.operation.moves
    if moves.normal is None or motion.mode is MachiningMode.WITHOUT_TCP:
        return np.zeros(len(moves.kind[part]), np.bool_)
    return np.asarray((moves.kind[part] == Kind.LINEAR) & np.isfinite(moves.normal[part, 0]))


def normal_words(moves: Moves, part: slice, rows: Flags, writer: BlockWriter) -> dict[str, Ints]:
    """The words of the surface's normal in these rows of a part; none where there are no such rows."""
    if moves.normal is None or not rows.any():
        return {}
    decimals = writer.word(SURFACE_NORMAL_WORDS[0]).format.decimals
    normal = np.where(rows[:, None], moves.normal[part], np.nan)
    return {
        word: round_to_counts(np.ascontiguousarray(normal[:, k]), decimals)
        for k, word in enumerate(SURFACE_NORMAL_WORDS)
    }
