"""Verify a program that somebody else has written: python verify_program.py

Compares a program with its CL file, spoils one coordinate of it, and shows where the verification finds that.
"""

from pathlib import Path

import trunnion

GOLDEN = Path(__file__).resolve().parents[1] / "tests" / "golden" / "yl569"
CL_FILE, PROGRAM = GOLDEN / "3_blade_finish.cls", GOLDEN / "3_blade_finish.expected.mpf"

verification = trunnion.verify(PROGRAM, machine="yl569", cl=CL_FILE)
print(f"{PROGRAM.name}: {'passed' if verification.passed else 'failed'}, {len(verification.checks)} checks")
print(f"machining time {verification.seconds.sum():.1f} s for {len(verification.run)} motions")

spoiled = Path("spoiled.mpf")
spoiled.write_text(PROGRAM.read_text(encoding="utf-8").replace("X47.2619 ", "X47.3619 "), encoding="utf-8")
verification = trunnion.verify(spoiled, machine="yl569", cl=CL_FILE)
for check in verification.checks:
    if not check.passed:
        print(f"{check.title}: {check.summary}")
        for place in check.places:
            print(f"  {spoiled}:{place.nc_line} (N{place.number}), line {place.cl_line} of the CL file: {place.text}")

trunnion.write_report(verification, "spoiled.html")
