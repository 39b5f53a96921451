"""Plan a CL file and look at the motion of the machine, in arrays: python plan_and_inspect.py

Nothing is written: the plan is there before any text.
"""

from pathlib import Path

import numpy as np

import trunnion
from trunnion.machines import forward, slide_positions

CL_FILE = Path(__file__).resolve().parents[1] / "tests" / "golden" / "yl569" / "3_blade_finish.cls"

machine = trunnion.load_machine("yl569")
plan = trunnion.plan(CL_FILE, machine=machine)
for motion in plan.motions:
    moves = motion.operation.moves
    print(f"{motion.operation.name}: {motion.mode}, {len(moves)} points")
    for axis, positions in zip(machine.rotary, motion.rotary.T, strict=True):
        print(f"  {machine.axes[axis].name} from {positions.min():.3f} to {positions.max():.3f} degrees")

    # Where every axis stands, and back again: the tip is where the CL file has it.
    joints = slide_positions(machine, moves.tip, motion.rotary)
    tip, _ = forward(machine, joints)
    print(f"  forward map and CL points differ by {np.abs(tip - moves.tip).max():.1e} mm")

    # The largest turn of the tool axis between two points.
    cosine = np.clip((moves.axis[1:] * moves.axis[:-1]).sum(axis=1), -1.0, 1.0)
    turn = np.degrees(np.arccos(cosine))
    print(f"  largest turn between two points {turn.max():.2f} degrees, in line {moves.line[1:][turn.argmax()]}")
for decision in plan.decisions:
    print(decision.text)
