"""Programs read back: an independent author of what a control does with them.

The readers are written from the language of the controls. They share nothing with what writes programs but the machine.
"""

from trunnion.machines.forward import forward_rows
from trunnion.model.axis_positions import resolve_turns, write_joints
from trunnion.readers.registry import can_read, reader_of, run_program
from trunnion.readers.scan.letter_blocks import scan_blocks

#: Kernels that most programs need.
KERNELS = (write_joints, forward_rows, scan_blocks, resolve_turns)

__all__ = ["KERNELS", "can_read", "reader_of", "run_program"]
