"""A CL file of SolidWorks CAM with a cycle that nothing ends."""

from tests.support.apt_heads import HEADS

NEXT = "SPINDL/1200,RPM,CLW\nTRNTYP/WORLD,0,0,0\n"
HOLES = "RAPID/\nGOTO/40.,50.,25.\nGOTO/40.,50.,0\nGOTO/60.,50.,0\n"
CUT = "RAPID/\nGOTO/40.,50.,25.\nRAPID/\nGOTO/40.,50.,2.\nFEDRAT/100,MMPM\nGOTO/40.,50.,-1.\nGOTO/50.,50.,-1.\n"
CYCLE = "CYCLE/DRILL,FEDTO,9.8,MMPM,150.,RAPTO,3.,RTRCTO,25.\n"
HEAD = "\n".join(HEADS["solidworks"]) + "\nSPINDL/1500,RPM,CLW\nRAPID/\nGOTO/10.,10.,25.\n"
#: OPERATION 2 drills on with the tool, OPERATION 3 with another one, and OPERATION 4 cuts.
OPEN = f"{HEAD}{CYCLE}GOTO/10.,10.,0\n{NEXT}GOTO/20.,20.,0\nLOAD/TOOL,6\n{NEXT}{HOLES}LOAD/TOOL,7\n{NEXT}{CUT}FINI\n"
LOOKS = {"OPERATION 2": "goes_on", "OPERATION 3": "goes_on", "OPERATION 4": "ends"}
