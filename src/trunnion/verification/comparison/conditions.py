"""Conditions under which a machine acts, where the path does not show them.

In:     a run; the other program is for the same machine.
Out:    rows, and in words what holds there: a tool change with the spindle turning, both senses in one block, coolant
        after a stop, a plane that is on while rotary axes turn, a spindle that turns while they are positioned, lengths
        in units that the program does not state; the work offset in which rotary axes are positioned.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.messages import Wording
from trunnion.model.programmed_words import ROTARY_WORDS
from trunnion.model.run import EventValue, Run
from trunnion.verification.comparison.stated_axes import first_statements
from trunnion.verification.event_words import event_word
from trunnion.verification.kinematics.positioning_moves import rotary_positioning_flags
from trunnion.verification.spindle_words import TURNING, both_senses

_STOPS: Final = ("stop", "optional_stop")
_PLANES: Final = ("tilt", "plane", "cycle800")
_SENSES: Final = {1: "clockwise", -1: "counter-clockwise"}

#: Words of units; what else a program relies on is compared in its cuts.
_UNITS: Final = frozenset({"G20", "G21", "G70", "G71"})

#: Positions of M92 count from a place that the builder has set: they are read as those of M91.
_SECOND_MACHINE: Final = "m92_counts_set_machine_taken"

#: G30 goes where the builder has set another reference position: it is read as G28.
_SECOND_REFERENCE: Final = "second_reference"

#: An axis that turns by no more stands, degrees.
_STILL: Final = 1e-6


def conditions(run: Run) -> Iterator[tuple[int, Wording]]:
    """Yield what holds, by the row before which it does."""
    row = run.first_without_units
    if row is not None:
        yield row, Wording("comparison", "no_units")
    for word in _UNITS.intersection(run.assumed_modes) if row is None else ():
        yield 0, Wording("comparison", "relies_on", word=word)
    for each in run.diagnostics:
        if each.wording.variant == _SECOND_MACHINE:
            yield 0, Wording("comparison", "second_machine")
        elif each.wording.variant == _SECOND_REFERENCE:
            yield 0, each.wording
    yield from _of_spindle(run)
    yield from _after_stops(run)
    yield from _turns_in_planes(run)
    yield from _of_turns(run)


def _of_spindle(run: Run) -> Iterator[tuple[int, Wording]]:
    """Yield tool changes while the spindle turns or coolant flows, and blocks that start it in both senses."""
    for before, event in both_senses(run):
        senses = {"first": event_word(before.value), "second": event_word(event.value)}
        yield event.before_row, Wording("comparison", "both_senses", **senses)
    turns: EventValue = None
    coolant: EventValue = None
    for event in run.events:
        if event.kind == "spindle":
            turns = event.value if event.value in TURNING else None
        elif event.kind == "coolant":
            coolant = event.value if event.value != "off" else None
        elif event.kind == "tool_change" and turns:
            yield event.before_row, Wording("comparison", "change_while_turning", sense=event_word(turns))
        elif event.kind == "tool_change" and coolant:
            yield event.before_row, Wording("comparison", "change_with_coolant", word=event_word(coolant))


def _after_stops(run: Run) -> Iterator[tuple[int, Wording]]:
    """Yield words of coolant and spindle after a stop: many machines turn them off there, and they are off without."""
    stopped = started = -1
    for event in run.events:
        if event.kind in _STOPS:
            stopped = event.before_row
        elif event.kind == "coolant" and event.before_row == stopped:
            yield stopped, Wording("comparison", "coolant_after_stop", word=event_word(event.value))
        elif event.kind == "spindle" and event.value in TURNING and event.before_row == stopped != started:
            started = stopped  # once: a program may say it again
            yield stopped, Wording("comparison", "spindle_after_stop", word=event_word(event.value))


def _turns_in_planes(run: Run) -> Iterator[tuple[int, Wording]]:
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
            yield row, Wording("comparison", "turns_in_plane")


def _positioned_turns(run: Run) -> Iterator[int]:
    """Yield the first row between two motions of the tool that turns rotary axes without going to a point.

    One that states an axis for the first time, or in another work offset, turns it from wherever it has been.

    Nothing else of such rows is compared. Whether one block turns both axes or two of them one each makes no
    difference.
    """
    positioning = rotary_positioning_flags(run, 0, len(run))
    rows = np.flatnonzero(positioning)
    if not len(rows):
        return
    columns = list(run.machine.rotary)
    angles = np.concatenate((run.start[None, columns], run.rotary))
    turned = np.abs(angles[rows + 1] - angles[rows])
    for k, column in enumerate(columns):
        if run.machine.axes[column].endless:
            turned[:, k] = np.abs((turned[:, k] + 180.0) % 360.0 - 180.0)
    rows = rows[(turned > _STILL).any(axis=1) | np.isin(rows, first_statements(run)) | _is_in_other_offset(run, rows)]
    motions = np.cumsum(~positioning)[rows]
    yield from rows[np.flatnonzero(np.diff(motions, prepend=-1))].tolist()


def _is_in_other_offset(run: Run, rows: Ints) -> Flags:
    """Which rows state rotary axes in another work offset than the row before that states one, (k,)."""
    stated = np.flatnonzero(((run.programmed & int(ROTARY_WORDS)) != 0) & ~run.machine_frame)
    offsets = run.state.work_offset.at(stated)
    return np.isin(rows, stated[1:][offsets[1:] != offsets[:-1]])


def _of_turns(run: Run) -> Iterator[tuple[int, Wording]]:
    """Yield where rotary axes are positioned with the spindle turning, and in which work offset they are.

    An offset may have values of rotary axes, too.
    """
    in_machine, offsets = run.state.machine_frame, run.state.work_offset
    for row in _positioned_turns(run):
        if sense := int(run.spindle[row]):
            yield row, Wording("comparison", "turns_with_spindle", sense=event_word(_SENSES[sense]))
        if not in_machine[row] and (offset := int(offsets[row])):
            yield row, Wording("comparison", "turns_in_offset", offset=run.work_offset_name(offset))
