"""Controls: what a program for each family of controls says, and in which order.

In:     a toolpath, its motion on the machine, the control's definition and the settings of the run.
Out:    the NC program, through the block writer.
"""

from trunnion.control.author import write_program
from trunnion.control.check import check_program
from trunnion.control.definition import Control, load_control
from trunnion.control.program import Program
from trunnion.control.subprograms import Division

__all__ = ["Control", "Division", "Program", "check_program", "load_control", "write_program"]
