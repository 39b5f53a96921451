"""Speeds of the spindle against the range that the machine's definition states."""

import numpy as np

from trunnion.machines import spindle_speed_fault, states_spindle_range
from trunnion.verification.context import Context, Faults
from trunnion.verification.results import Check
from trunnion.verification.row_ranges import chunk_bounds

_KEY = "rpm"
_TITLE = "spindle speeds that the machine has"


def check_spindle_range(context: Context) -> Check:
    """Every speed at which the spindle turns during a motion; a place for each change to a wrong one."""
    run = context.run
    if not states_spindle_range(run.machine):
        return Check(_KEY, _TITLE, True, "")
    found = Faults()
    speeds: set[float] = set()
    last = 0.0
    for start, end in chunk_bounds(len(run)):
        rpm = np.where(run.state.spindle.part(start, end) != 0, run.state.rpm.part(start, end), 0.0)
        for k in np.flatnonzero(np.diff(rpm, prepend=last)).tolist():
            speed = float(rpm[k])
            if speed > 0.0:
                speeds.add(speed)
                fault = spindle_speed_fault(run.machine, speed)
                if fault:
                    found.add(context.place(start + k, speed, str(fault)))
        last = float(rpm[-1])
    good = f"{min(speeds):g} to {max(speeds):g} rev/min" if speeds else "the spindle does not turn"
    return found.check(_KEY, _TITLE, good)
