"""The beginnings and ends of tiny programs and their CL files, and the checks of a verification."""

from collections.abc import Callable

from trunnion.verification import Check, Verification

Verifier = Callable[..., Verification]

#: A program up to its first motion, and after its last.
HEAD = "G17 G710 G90 G94\nSUPA G0 Z0 D0\nSUPA G0 X0 Y0 B0 C0 D1\nT1\nM6\nG54\nS1000 M3\n"
FOOT = "SUPA G0 Z0 D0\nSUPA G0 X0 Y0 B0 C0 D1\nM5\nM30\n"
CL_HEAD = """TOOL PATH/OP1,TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,1000.0000,CLW
RAPID
GOTO/0.0,0.0,50.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
"""
CL_FOOT = "END-OF-PATH\n"


def check(found: Verification, key: str) -> Check:
    """The check with this key."""
    return next(check for check in found.checks if check.key == key)
