"""Programs read back: an independent author of what a control does with them.

The readers are written from the language of the controls. They share nothing with what writes programs but the machine.
"""

from trunnion.model.axis_positions import resolve_turns, write_joints
from trunnion.readers.registry import can_read, reader_of, run_program

#: Kernels that every program needs.
KERNELS = (resolve_turns, write_joints)

__all__ = ["KERNELS", "can_read", "reader_of", "run_program"]
