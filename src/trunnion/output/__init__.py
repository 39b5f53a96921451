"""NC programs: planned motion in, the blocks of a control out.

In:     motions on a machine, the control's definition and the settings of the run (``Program``).
Out:    the NC program, through the block writer.
"""

from trunnion.controls.words import round_column
from trunnion.output.blocks.block_kernel import write_blocks
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.output.subprograms import SubprogramOutput
from trunnion.output.validation import check_program

#: Kernels that every program needs.
KERNELS = (round_column, write_blocks)

__all__ = ["KERNELS", "Program", "SubprogramOutput", "check_program", "write_program"]
