"""Post a CL file and prove the program: python post_with_proof.py [CL_FILE]

Writes blade.mpf into the current folder.
"""

import sys
from pathlib import Path

import trunnion

SAMPLE = Path(__file__).resolve().parents[1] / "tests" / "golden" / "yl569" / "3_blade_finish.cls"
CL_FILE = sys.argv[1] if len(sys.argv) > 1 else SAMPLE

try:
    result = trunnion.post(CL_FILE, machine="yl569", output="blade.mpf", settings={"title": "BLADE FINISH"})
except trunnion.TrunnionError as error:  # every problem with its place and its cure; nothing is written
    sys.exit(str(error))
for check in result.checks:
    print(f"{check.key:<13} {'ok' if check.passed else 'FAIL'}  {check.summary}")
print(f"{result.output}: {len(result.run)} motions, proven" if result.run else "not proven")
