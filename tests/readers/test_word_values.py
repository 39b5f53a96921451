"""Values that a word cannot have on its control are errors, and those that it can have are not."""

from pathlib import Path

import pytest

import trunnion
from tests.support.block_frames import HEADS, TAILS

PLANE = "G68.2 X0 Y0 Z0 I0 J0 K0\nG53.1"

CYCLE_32 = "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1"

SWIVEL = 'CYCLE800(0,"",0,'
TAP = "CYCLE84(9.,0.,1.,-9.,,,"

#: A machine, blocks that its control knows, and blocks with values that it does not know.
WORDS = [
    ("matsuura_mx330", ["G05.1 Q1", "G05.1 Q1 R10", "G05.1 Q0"], ["G05.1 Q8", "G05.1 Q1 R11", "G05.1 Q3 X0 Y0"]),
    ("matsuura_mx330", ["G05 P10000", "G05 P0", "G08 P1", "G08 P0"], ["G05 P1000", "G08 P2"]),
    ("matsuura_mx330", ["G10 L2 P6 X1.", "G10 L20 P1 X1."], ["G10 L12 P5 R3.", "G10 L2 P0 X1.", "G10 L20 P0 X1."]),
    ("matsuura_mx330", ["G30 P2 Z0", "G4 P1500"], ["G30 P9 Z0", "G10 L12 P0 R3.", "G4 P-5", "G10 L4 P1 R3."]),
    ("matsuura_mx330", [], ["G10 L1 P3 R1.", "G10 L3 P1 L50", "G10 L10 P3 R5.", "G10 L11 P3 R0.1", "G10 L13 P3 R0.1"]),
    ("xyzac_trt", ["G10 L2 P1 X1", "G10 L0", "M68 E2 Q1"], ["G10 L1 P6 Z5", "G10 L10 P6 Z5", "G10 L11 P6 Z5"]),
    ("xyzac_trt", [], ["M68 E3 Q0", "M67 E3 Q1"]),
    ("haas_umc750", ["G187 P1", "G187 P3 E0.02"], ["G187 P4", "G187 P"]),
    ("xyzac_trt", ["G64 P0.02 Q0.01", "M50 P0", "M66 P3 L4 Q1"], ["G64 P-0.02", "M50 P2", "M66 P3 L5 Q1"]),
    ("hs664rt", ["G17 Q1", "G4 HD1."], ["G17 Q2", "G4 HD-1", "G4", "G1 F100\nG4 HD1. X5."]),
    ("matsuura_mx330", ["G52 X1.", "G92 X5."], ["G52", "G92"]),
    ("xyzac_trt", ["G52 X1", "G4 P1"], ["G52", "G4 P-1"]),
    ("yl569", ["G4 F1", "G4 S3"], ["G4"]),
    ("yl569", ["G60 CFC", "G64 FNORM"], ["G331 Z-9 K1", "G332 Z-9 K1", "G33 Z-9 K1", "G63 Z-9", "G331", "G96 S99"]),
    ("yl569", ["WALIMON", "M40"], ["G25 S99", "G26 S1000", "G26 X5", "LIMS=1000", "SVC=90", "M41", "G621", "G810"]),
    ("yl569", ["FGROUP()", "FGROUP(Z,X,Y)"], ["FGROUP(Z)", "FGROUP(X,Y,Z,C)", "FL[X]=9", "VELOLIM[X]=50", "FLIN"]),
    ("yl569", ["OTOL=0.1 STOL=2 ADISPOS=.5"], ["OTOL=5", "STOL=99", "ADISPOS=9", "CTOLG=9", "OTOLG=9", "RTLIOF"]),
    ("yl569", ["TRAORI(1)\nA3=0 C3=1"], ["TRAORI(3)", "A3=0 C3=1", "DIAMON", "DIAM90", "PROC A SAVE", "FPO"]),
    ("yl569", ["TRAORI(1,,,1,0,0)", "TRAORI()"], ["TRAORI(1,1,0,0)", "TRAORI(,0,1,0)", "TRAORI(1,0,0,-1)"]),
    ("yl569", ["TRAORI(1,,,,0)", "SPCOF", "SPCON(1)"], ["TRAORI(1,,,,5,0)", "TRAORI(1,,,,,5)", "TRAORI(2)"]),
    ("yl569", ["FGREF[C]=10 G1 X1 C9", "FGREF[C]=57.296 G1 C9"], ["FGREF[C]=10 G1 C9", "FGREF[C]=10\nG1 C9\nC5"]),
    ("yl569", ["CFTCP KONTT G62", "G41 X9 NORM"], ["G41 CFTCP", "CFIN\nG42 X9", "G41 G62", "G41 KONTT"]),
    ("matsuura_mx330", ["G61\nG64", "G22\nG23", f"{PLANE} P0"], ["G60 X5.", "G62", "G22 X9.", "G96 S99", "G5.3 P1"]),
    ("matsuura_mx330", ["G43 H1 Z9.\nG69"], [f"{PLANE}\nG43 H1 Z9.\nG69", "G43 H1 Z9.\nG68.2 X0 Y0 Z0 I0 J0 K0"]),
    ("matsuura_mx330", ["M29 S99"], ["G84 X1. Z-9. R1. J2", "G33 Z-9. F1.", "G31 Z-9. F9.", f"{PLANE} P1"]),
    ("haas_umc750", ["G187", "G187 E.02", "M83"], ["G187 P", "M39", "M41", "M50", "M82", "M86", "M138", "G60 X5."]),
    ("xyzac_trt", ["M52", "M52 P1", "G92 X5\nG92.3", "M110"], ["G92.3", "M129", "G38.2 Z0 F9", "G33 Z0 K1"]),
    ("dmu65", ["M103", "M110", "M111", "M124", "M124 T.1", "M138", "M138 A C"], ["M103 F20", "M109", "M138 A"]),
    ("dmu65", ["FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS"], ["M98", "M112 T.5", "M144", "M150", "LN X+1 TX+0 TZ+1"]),
    ("dmu65", ["CYCL DEF 251"], ["CYCL DEF 239 Q570=+0", "CYCL DEF 220", "FUNCTION TCPM F CONT AXIS POS"]),
    ("yl569", ["CYCLE832(.02,_ORI_FINISH,1)", "CYCLE832(.02,112102)"], ["CYCLE832(.02,5)", "CYCLE832(.02,21,1)"]),
    ("yl569", ["CYCLE832(.02,2000012,.5)", "OVR=100"], ["CYCLE832(.02,11,-1)", "CYCLE832(.02,1,5)", "OVR=50", "FB=20"]),
    ("yl569", ["CYCLE83(9.,0.,1.,-9.,,-3.,,,,,,1)"], ["CYCLE83(9.,0.,1.,-9.,,-3.,,,,,,2)"]),
    ("yl569", ['CYCLE800(0,"",0,57,0,0,0,0,0,0,0,0,0,0)'], ['CYCLE800(9,"",0,57,0,0,0,0,0,0,0,0,0,0)']),
    ("yl569", ['CYCLE800(0,"",1,57,0,0,0,0,0,0,0,0,0,0)'], ['CYCLE800(0,"",2,57,0,0,0,0,0,0,0,0,0,0)']),
    ("dmu65", [f"{CYCLE_32} T0.02\nCYCL DEF 32.2 HSC-MODE:1 TA0.1"], [f"{CYCLE_32} X0.02"]),
    ("dmu65", [f"{CYCLE_32} T0.02\nCYCL DEF 32.2 TA1"], [f"{CYCLE_32} T0.02\nCYCL DEF 32.2 TA3"]),
    ("yl569", ["S250 D1", "S0", "F25. T=3"], ["S-250", "S250 S2500", "D2 D1", "F25. F250.", "T=3 T=2", "X1. X2."]),
    ("yl569", ["CYCLE82(9.,0.,1.,-9.,,.5,0,1,12,,)"], ["CYCLE82(9.,0.,1.,-9.,,.5,0,1,12,1)"]),
    ("yl569", [f"{TAP}3,,1.,0.,500)", f"{TAP}5,6,1.,0.,500)"], [f"{TAP}0,,1.,0.,500)", f"{TAP}3,8,1.,0.,500)"]),
    ("yl569", [f"{TAP}4,6,,0.,500)"], [f"{TAP}3,6,-1.,0.,500)", f"{TAP}3,6,,0.,-500)"]),
    ("yl569", [f"{SWIVEL}57,0,0,0,0,0,0,0,0,0,0,0,1)"], [f"{SWIVEL}57,0,0,0,0,0,0,0,0,0,0,0,2)", f"{SWIVEL}192)"]),
    *((machine, ["T12345678"], ["T-1", "T1.5"]) for machine in ("matsuura_mx330", "haas_umc750", "xyzac_trt")),
    ("yl569", ["T=12345678", 'T="MILL"'], ["T=-1", "T=1.5", "T-1"]),
    ("hs664rt", ["T12345678\nM306"], ["T-1", "T1.5"]),
    ("haas_umc750", [], ["G99 G91 G81 X1. Z-1. R-1. L1.5\nG80 G90"]),
    ("xyzac_trt", ["M19 R90.5 Q0.5 P2"], ["M19 R361", "M19 R-1", "M19 R9 Q0", "G98 G89 X1 Z-1 R1 P-0.5\nG80"]),
    ("matsuura_mx330", ["S250"], ["S-250"]),
    ("haas_umc750", ["S250"], ["S-250"]),
    ("xyzac_trt", ["S250"], ["S-250"]),
    ("hs664rt", ["S250"], ["S-250"]),
    ("dmu65", ["TOOL CALL Z S250"], ["TOOL CALL Z S-250"]),
    ("dmu65", ["FN 16: F-PRINT A"], ["FN 17: SYSWRITE ID150 NR2 IDX1 = +5"]),
    ("dmu65", ["M120 LA5"], [f"{CYCLE_32} T0.02\nCYCL DEF 32.2 HSC-MODE:2", "M120 LA500"]),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "known", "unknown"), WORDS, ids=[f"{m}-{k}" for k, (m, _, _) in enumerate(WORDS)])
def test_values_that_a_control_does_not_know_are_errors(
    machine: str, known: list[str], unknown: list[str], tmp_path: Path
) -> None:
    program = tmp_path / "part.nc"

    def errors(block: str) -> list[str]:
        program.write_text(f"{HEADS[machine]}{block}\n{TAILS.get(machine, '')}")
        return [error.text for error in trunnion.read_program(program, machine=machine).errors]

    assert {block: found for block in known if (found := errors(block))} == {}
    assert [block for block in unknown if not errors(block)] == []
