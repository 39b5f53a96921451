"""Conditions under which a machine acts, where the path does not show them.

In:     a run; the other program is for the same machine.
Out:    rows, and in words what holds there: a tool change with the spindle turning, both senses in one block, coolant
        after a stop, a plane that is on while rotary axes turn, lengths in units that the program does not state.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.model.run import Run
from trunnion.verification.spindle_words import TURNING, both_senses

_STOPS: Final = ("stop", "optional_stop")
_PLANES: Final = ("tilt", "plane", "cycle800")


def conditions(run: Run) -> Iterator[tuple[int, str]]:
    """Yield what holds, by the row before which it does."""
    row = run.first_without_units
    if row is not None:
        yield row, "moves before the program says whether it counts in mm or inches"
    yield from _of_spindle(run)
    yield from _after_stops(run)
    yield from _turns_in_planes(run)


def _of_spindle(run: Run) -> Iterator[tuple[int, str]]:
    """Yield tool changes while the spindle turns, and blocks that start it in both senses."""
    for before, event in both_senses(run):
        yield event.before_row, f"one block turns the spindle {before.value} and {event.value}"
    turns = ""
    for event in run.events:
        if event.kind == "spindle":
            turns = str(event.value) if event.value in TURNING else ""
        elif event.kind == "tool_change" and turns:
            yield event.before_row, f"tool change while the spindle turns {turns}"


def _after_stops(run: Run) -> Iterator[tuple[int, str]]:
    """Yield words of coolant after a stop: many machines turn it off there, and it is off without them."""
    stopped = -1
    for event in run.events:
        if event.kind in _STOPS:
            stopped = event.before_row
        elif event.kind == "coolant" and event.before_row == stopped:
            yield stopped, f"coolant {event.value} after a stop"


def _turns_in_planes(run: Run) -> Iterator[tuple[int, str]]:
    """Yield rows that turn a rotary axis while a tilted plane is on: one that has been used, or machine coordinates."""
    begins, on = [0], [False]
    for event in run.events:
        if event.kind in _PLANES:
            value = str(event.value or "")
            begins.append(event.before_row)
            on.append(bool(value) and not value.startswith("RESET"))
    if not any(on):
        return
    angles = np.concatenate((run.start[None, list(run.machine.rotary)], run.rotary))
    turns = np.abs(np.diff(angles, axis=0)).max(axis=1, initial=0.0) > 0.0
    in_machine = run.state.machine_frame.column()
    # How many motions in the workpiece there are up to each row that turn nothing.
    used = np.concatenate(([0], np.cumsum(~turns & ~in_machine)))
    rows = np.flatnonzero(turns)
    for row, k in zip(rows.tolist(), np.searchsorted(begins, rows, side="right").tolist(), strict=True):
        if on[k - 1] and (in_machine[row] or used[row] > used[begins[k - 1]]):
            yield row, "rotary axes turn while a tilted plane is on"
