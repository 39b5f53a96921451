"""Values that a word cannot have on its control are errors, and those that it can have are not."""

from pathlib import Path

import pytest

import trunnion

HEADS = {
    "matsuura_mx330": "%\nO0001\nG21 G17 G90 G94 G54\n",
    "haas_umc750": "%\nO00001\nG21 G17 G90 G94 G54\n",
    "xyzac_trt": "G21 G17 G90 G94 G54\n",
    "hs664rt": "G90\nG71\nG55 O1\n",
    "yl569": "G710 G17 G90 G94 G54\nT1\nM6\nD1\nS500 F100 M3\n",
    "dmu65": "0 BEGIN PGM A MM\nTOOL CALL 1 Z S500\n",
}

CYCLE_32 = "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1"

#: A machine, blocks that its control knows, and blocks with values that it does not know.
WORDS = [
    ("matsuura_mx330", ["G05.1 Q1", "G05.1 Q1 R10", "G05.1 Q3 X0 Y0 Z0", "G05.1 Q0"], ["G05.1 Q8", "G05.1 Q1 R11"]),
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
    ("yl569", ["CYCLE832(.02,_ORI_FINISH,1)", "CYCLE832(.02,112102)"], ["CYCLE832(.02,5)", "CYCLE832(.02,21,1)"]),
    ("yl569", ["CYCLE832(.02,2000012,.5)", "OVR=100"], ["CYCLE832(.02,11,-1)", "OVR=50", "G1 X1. FB=20"]),
    ("yl569", ["CYCLE83(9.,0.,1.,-9.,,-3.,,,,,,1)"], ["CYCLE83(9.,0.,1.,-9.,,-3.,,,,,,2)"]),
    ("yl569", ['CYCLE800(0,"",0,57,0,0,0,0,0,0,0,0,0,0)'], ['CYCLE800(9,"",0,57,0,0,0,0,0,0,0,0,0,0)']),
    ("yl569", ['CYCLE800(0,"",1,57,0,0,0,0,0,0,0,0,0,0)'], ['CYCLE800(0,"",2,57,0,0,0,0,0,0,0,0,0,0)']),
    ("dmu65", [f"{CYCLE_32} T0.02\nCYCL DEF 32.2 HSC-MODE:1 TA0.1"], [f"{CYCLE_32} X0.02"]),
    ("dmu65", ["FN 16: F-PRINT A"], ["FN 17: SYSWRITE ID150 NR2 IDX1 = +5"]),
    ("dmu65", ["M120 LA5"], [f"{CYCLE_32} T0.02\nCYCL DEF 32.2 HSC-MODE:2", "M120 LA500"]),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "known", "unknown"), WORDS, ids=[f"{m}-{k}" for k, (m, _, _) in enumerate(WORDS)])
def test_values_that_a_control_does_not_know_are_errors(
    machine: str, known: list[str], unknown: list[str], tmp_path: Path
) -> None:
    program = tmp_path / "part.nc"

    def errors(block: str) -> list[str]:
        program.write_text(f"{HEADS[machine]}{block}\n")
        return [error.text for error in trunnion.read_program(program, machine=machine).errors]

    assert {block: found for block in known if (found := errors(block))} == {}
    assert [block for block in unknown if not errors(block)] == []
