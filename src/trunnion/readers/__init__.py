"""Programs read back: an independent author of what a control does with them.

The readers are written from the language of the controls. They share nothing with what writes programs but the machine.
"""

from trunnion.model.axis_positions import joint_rows, wind
from trunnion.readers.registry import can_read, numbers_lengths, reader_of, run_program

#: Kernels that every program needs.
KERNELS = (wind, joint_rows)

__all__ = ["KERNELS", "can_read", "numbers_lengths", "reader_of", "run_program"]
