"""Words, number formats and blocks: how a program is spelt, for any control that writes words.

In:     columns of numbers, one a word, and lines of text between them.
Out:    the bytes of the program, in blocks.
Knows nothing of machines, of CL files, or of what a word means to a control.
"""

from trunnion.nc.words import ABSENT, NumberFormat, Word, count_column, counts
from trunnion.nc.writer import CHUNK, ROOM_OF_NUMBER, BlockNumbers, BlockWriter, write_blocks

#: Kernels that every program needs.
KERNELS = (count_column, write_blocks)

__all__ = [
    "ABSENT",
    "CHUNK",
    "KERNELS",
    "ROOM_OF_NUMBER",
    "BlockNumbers",
    "BlockWriter",
    "NumberFormat",
    "Word",
    "counts",
]
