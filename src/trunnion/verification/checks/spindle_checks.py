"""The spindle of a program against SPINDL in the CL files, and against the range that the machine has."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.machines import spindle_speed_fault, states_spindle_range
from trunnion.messages import Wording, phrase
from trunnion.model.run import Run
from trunnion.verification.checks.coverage import coverage_of
from trunnion.verification.checks.matched_rows import first_wrong_pair
from trunnion.verification.context import ComparedContext, Context, Faults, check_from_places
from trunnion.verification.expected.spindle_and_tool import ExpectedSpindle
from trunnion.verification.expected.states import all_spindles, spindle_states
from trunnion.verification.kinematics.seen_rows import SeenRows
from trunnion.verification.results import Check, Place
from trunnion.verification.row_ranges import chunk_bounds

#: Spindle speeds are printed without decimals: this much is rounding, rev/min.
RPM_TOLERANCE: Final = 0.5 + 1e-6

_SENSES: Final = {"clockwise": 1, "counter-clockwise": -1}


def check_spindle(context: ComparedContext) -> Check:
    """Speed and sense at every CL point, and no others anywhere."""
    run, matching = context.run, context.matching
    places: list[Place] = []
    asked: set[ExpectedSpindle] = set()
    for state in spindle_states(context.expected):
        wanted = state.value
        first, end = matching.pair_range(state.first, state.end)
        if wanted is None or first == end:
            continue
        asked.add(wanted)
        if wanted.sense == 0 and _stops_after(context, matching.nc[first]):
            first += 1
        bad = first_wrong_pair(matching, first, end, partial(_differs, run, wanted))
        if bad is not None:
            row, cl = bad
            actual = ExpectedSpindle(run.state.rpm[row], run.state.spindle[row])
            said = Wording("spindle", "other", has=_words(actual), wanted=_words(wanted))
            places.append(context.place_with_cl(row, actual.rpm, said, cl))
    places += _foreign_events(context, asked | all_spindles(context.expected)) if asked else ()
    places.sort(key=lambda place: place.nc_line)
    speeds = tuple(_words(each) for each in sorted(asked, key=lambda each: (each.rpm, each.sense)))
    good = Wording("spindle", "good", speeds=speeds) if speeds else Wording("spindle", "none_asked")
    return check_from_places("spindle", places, good)


def _foreign_events(context: ComparedContext, asked: set[ExpectedSpindle]) -> Iterator[Place]:
    """Words for a sense or a speed that the CL file never asks for."""
    for event in context.run.events:
        if event.kind == "spindle":
            sense = _SENSES.get(str(event.value), event.value)
            if isinstance(sense, int | float) and sense and not any(each.sense == sense for each in asked):
                yield context.place_of_event(event, 0.0, Wording("spindle", "other_sense"))
        elif event.kind == "speed" and isinstance(event.value, float):
            rpm = event.value
            if not any(abs(each.rpm - rpm) <= RPM_TOLERANCE for each in asked):
                yield context.place_of_event(event, rpm, Wording("spindle", "other_speed", speed=rpm))


def _stops_after(context: ComparedContext, row: int) -> bool:
    """Whether the spindle is off after a row: M5 acts after the motion of its block."""
    after = context.next_row(row)
    return after != row and context.run.state.spindle[after] == 0


def _differs(run: Run, wanted: ExpectedSpindle, nc: Ints) -> Flags:
    wrong = run.state.spindle.at(nc) != wanted.sense
    if wanted.sense:
        wrong |= np.abs(run.state.rpm.at(nc) - wanted.rpm) > RPM_TOLERANCE
    return np.asarray(wrong)


def _words(spindle: ExpectedSpindle) -> Wording:
    if spindle.sense == 0:
        return Wording("spindle", "off")
    return Wording("spindle", "clockwise" if spindle.sense > 0 else "counterclockwise", speed=spindle.rpm)


def check_spindle_range(context: Context) -> Check:
    """Every speed at which the spindle turns during a motion; a place for each change to a wrong one."""
    run = context.run
    if not states_spindle_range(run.machine):
        return Check("rpm", True, None)
    found, seen = Faults(), SeenRows()
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
                    found.add(context.place(start + k, speed, fault))
        last = float(rpm[-1])
        still = (phrase("left_standing_spindle"), rpm == 0.0)
        seen.add(start, end - start, (still, (phrase("left_no_speed"), ~(rpm > 0.0))))
    good = Wording("rpm", "good", low=min(speeds), high=max(speeds)) if speeds else Wording("rpm", "stands")
    return replace(found.check("rpm", good), coverage=coverage_of(context, seen))
