"""Reading NC programs: what a control does with a program, worked out independently of what wrote it.

The readers are written from the manuals of the controls. They share nothing with the writers but the machine model.
"""

from trunnion.machines.forward import forward_rows
from trunnion.model.axis_positions import resolve_turns, write_joints
from trunnion.model.turning_lines import write_beyond
from trunnion.readers.program.kinds import kind_problem, program_for_cl_file, with_kind
from trunnion.readers.program.known_words import KnownWord, known_words
from trunnion.readers.program.options import RunOptions
from trunnion.readers.program.settings import GIVEN
from trunnion.readers.program.stated_words import with_reading, with_stated
from trunnion.readers.registry import can_read, check_reading, reader_of, role_of, run_program, with_role
from trunnion.readers.scan.letter_blocks import read_blocks
from trunnion.readers.scan.rows import execute_blocks

#: Kernels that most programs need.
KERNELS = (write_joints, forward_rows, read_blocks, execute_blocks, resolve_turns, write_beyond)

__all__ = [
    "GIVEN", "KERNELS", "KnownWord", "RunOptions", "can_read", "check_reading", "kind_problem", "known_words",
    "program_for_cl_file", "reader_of", "role_of", "run_program", "with_kind", "with_reading",
    "with_role", "with_stated",
]  # fmt: skip
