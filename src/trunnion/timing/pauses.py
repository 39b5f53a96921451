"""Events for which the axes wait, and how long."""

import math
from collections.abc import Iterator

from trunnion.model.run import Run, RunEvent
from trunnion.timing.dynamics import AxisDynamics


def pauses(run: Run, dynamics: AxisDynamics) -> Iterator[tuple[RunEvent, float]]:
    """Each event and the seconds that the axes wait for it; revolutions of a spindle of unknown speed take none."""
    last = len(run) - 1
    for event in run.events:
        takes = dynamics.tool_change if event.kind == "tool_change" else 0.0
        if event.kind == "dwell" and isinstance(event.value, float) and math.isfinite(event.value):
            takes = event.value
            if takes < 0.0:
                rpm = float(run.state.rpm[min(event.before_row, last)]) if last >= 0 else 0.0
                takes = -takes * 60.0 / rpm if rpm > 0.0 else 0.0
        yield event, takes
