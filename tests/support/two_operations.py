"""Two operations with one tool, and holes in three planes, as CL files."""

OPERATION = """TOOL PATH/{name},TOOL,D{tool}
TLDATA/MILL,1{tool}.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,{tool},ADJUST,{tool}
SPINDL/RPM,3000,CLW
COOLNT/ON
RAPID
GOTO/{x},0.0,30.0,{axis}
FEDRAT/MMPM,500.0
GOTO/{x},0.0,-1.0,{axis}
GOTO/{end},0.0,-1.0,{last}
RAPID
GOTO/{end},0.0,30.0,{last}
END-OF-PATH
"""

UP, TILTED, MORE = "0.0,0.0,1.0", "0.0,0.5,0.8660254", "0.0,0.5150381,0.8571673"


def operation(name: str, x: float, axis: str = UP, last: str = "", tool: int = 1) -> str:
    """Return a cut of 10 mm from x on, from one tool axis to another."""
    return OPERATION.format(name=name, x=x, end=x + 10.0, axis=axis, last=last or axis, tool=tool)


#: Two operations with one tool: at the tool along Z, in one plane, under TCP from one tilt to another and back, and in
#: planes that are tilted otherwise.
PATHS = {
    "three": operation("FIRST", 0.0) + operation("SECOND", 40.0),
    "tilted": operation("FIRST", 0.0, TILTED) + operation("SECOND", 40.0, TILTED),
    "tcp": operation("FIRST", 0.0, TILTED, MORE) + operation("SECOND", 40.0, MORE, TILTED),
    "turned": operation("FIRST", 0.0, UP) + operation("SECOND", 40.0, TILTED),
    "tools": operation("FIRST", 0.0, TILTED) + operation("SECOND", 40.0, TILTED, tool=2),
}

#: An operation between whose holes the tool axis changes, so that the table or the head turns within it.
HOLES = OPERATION.format(name="HOLES", x=0.0, end=10.0, axis=UP, last=UP, tool=1).removesuffix("END-OF-PATH\n") + (
    "GOTO/0.0,0.0,50.0\nCYCLE/DRILL,RAPTO,3.0,FEDTO,-5.0,MMPM,100.0\nGOTO/0.0,0.0,0.0\nGOTO/10.0,20.0,0.0\n"
    f"GOTO/10.0,40.0,0.0,{TILTED}\nGOTO/30.0,40.0,0.0,{TILTED}\nCYCLE/OFF\nEND-OF-PATH\n"
)
PATHS["holes"] = HOLES

#: Two holes behind one point, and from the last of them another.
PATHS["two_holes"] = """TOOL PATH/HOLES,TOOL,D5
TLDATA/DRILL,5,0,80,118,60
MSYS/0,0,0,1,0,0,0,1,0
LOAD/TOOL,5,ADJUST,5
SPINDL/RPM,3000,CLW
RAPID
GOTO/0,0,50,0,0,1
CYCLE/DRILL,RAPTO,3,FEDTO,-8,RTRCTO,10,MMPM,200
GOTO/15,10,0
GOTO/-15,10,0
CYCLE/OFF
RAPID
GOTO/-15,10,50
END-OF-PATH
"""
