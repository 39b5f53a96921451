"""Controls: what a program for each family of controls says, and in which order.

In:     a toolpath, its motion on the machine, the control's definition and the settings of the run.
Out:    the NC program, through the block writer.
"""

from trunnion.control.definition import CHOICES, Control, is_lift, load_control
from trunnion.control.program import Program, check_program, write_program

__all__ = ["CHOICES", "Control", "Program", "check_program", "is_lift", "load_control", "write_program"]
