"""Take a program of one machine to another: python convert_to_another_machine.py

The program of a table-table machine is read back, posted for a head-head machine, proven there, and compared with the
first one: both make the tool do the same. Writes head_head.mpf and blade.cls into the current folder.
"""

from pathlib import Path

import trunnion

PROGRAM = Path(__file__).resolve().parents[1] / "tests" / "golden" / "yl569" / "3_blade_finish.expected.mpf"
FROM, TO = "yl569", "generic_head_head_ca"

converted = trunnion.convert(PROGRAM, machine=FROM, to_machine=TO, output="head_head.mpf")
for problem in converted.problems:
    print(problem)
print(f"{converted.output}: {'proven' if converted.posted and converted.posted.passed else 'not proven'}")

comparison = trunnion.diff(PROGRAM, "head_head.mpf", machine=FROM, to_machine=TO, tolerance=0.00002)
print("the tool does the same" if comparison.same else f"{comparison.count} differences")

as_cl = trunnion.convert(PROGRAM, machine=FROM, to_cl=True, output="blade.cls")
print(f"{as_cl.output}: {', '.join(operation.name for operation in as_cl.toolpath.operations)}")
