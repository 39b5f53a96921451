"""CL text of a block with holes along three axes, which turns the rotary axes twice."""

HEAD = """TOOL PATH/HOLES,TOOL,DRILL_8
TLDATA/DRILL,MILL,8.0000,0.0000,75.0000,118.0000,50.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,1000.0000,CLW
"""


def hole(tip: tuple[float, float, float], axis: tuple[float, float, float], retract: float = 30.0) -> str:
    """CL text of one hole, with a rapid to and from the height of its retract."""
    above = ",".join(f"{t + retract * a:.4f}" for t, a in zip(tip, axis, strict=True))
    direction = ",".join(f"{a:.4f}" for a in axis)
    point = ",".join(f"{t:.4f}" for t in tip)
    return (
        f"RAPID\nGOTO/{above},{direction}\nCYCLE/DRILL,RAPTO,3,FEDTO,-20,RTRCTO,{retract},MMPM,90\n"
        f"GOTO/{point}\nCYCLE/OFF\nRAPID\nGOTO/{above}\n"
    )


TOP, FRONT, RIGHT = (0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0)
#: A block of 300 mm: a hole in its top, in its front, and in its right side.
BLOCK = HEAD + hole((0, 0, 0), TOP) + hole((0, -150, -150), FRONT) + hole((150, 0, -150), RIGHT) + "END-OF-PATH\n"
