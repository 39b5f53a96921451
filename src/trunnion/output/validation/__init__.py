"""Validation: what a control would lack or reject in a program, found before it is written.

In:     a program, not yet written.
Out:    problems with lines of the CL file; errors mean that the program must not be written.
"""

from trunnion.output.validation.cycles import unsupported_cycle_reasons
from trunnion.output.validation.program import check_program

__all__ = ["check_program", "unsupported_cycle_reasons"]
