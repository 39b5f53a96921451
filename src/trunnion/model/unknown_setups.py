"""Rows at the workpiece of which the zero of the work offset, or the length of the tool, is not stated.

In:     a run whose work offsets have zeros, or whose tools have lengths, of their own.
Out:    its rows without one, and which they are without. No other offset's or tool's value stands in for it.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints, distinct
from trunnion.messages import Wording, phrase
from trunnion.model.columns import StepColumn
from trunnion.model.programmed_words import ROTARY_WORDS, names_no_axis
from trunnion.model.run import NO_OFFSET, ProgrammedWord, Run
from trunnion.model.run_setups import Setup, known_values

_SLIDE_WORDS: Final = int(ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z)


def offsets_without_zero(run: Run) -> tuple[str, ...]:
    """Return the work offsets without a zero in which the program moves slides, if others have one."""
    used = [setup for setup, _ in _used(run)]
    if run.setups is None or all(setup.machine.workpiece_zero is None for setup in used):
        return ()
    without = [setup.work_offset for setup in used if setup.machine.workpiece_zero is None]
    return tuple(dict.fromkeys(offset_name(run, offset) for offset in without))


def tools_without_length(run: Run) -> tuple[str, ...]:
    """Return the tools without a length with which the program moves slides at the workpiece, if others have one."""
    used = [setup for setup, _ in _used(run)]
    if run.setups is None or all(setup.machine.tool_length is None for setup in used):
        return ()
    return tuple(dict.fromkeys(_tool_name(setup.tool) for setup in used if setup.machine.tool_length is None))


def stated_rows(run: Run) -> tuple[StepColumn, StepColumn]:
    """Return in which rows the zero is stated, and in which the length of the tool, bool each.

    Of an offset that is elsewhere it is not, whatever the frame of the run.
    """
    machines = [run.machine] if run.setups is None else [setup.machine for setup in run.setups.each]
    number = StepColumn.constant(len(run), 0, np.int64) if run.setups is None else run.setups.number
    away = [False] if run.setups is None else [setup.is_elsewhere for setup in run.setups.each]
    zero = np.array([machine.workpiece_zero is not None for machine in machines]) & ~np.array(away)
    length = np.array([machine.tool_length is not None for machine in machines])
    return replace(number, values=zero[number.values]), replace(number, values=length[number.values])


def rows_elsewhere(run: Run) -> Flags:
    """Return which rows name places of a work offset of which nobody knows where it is in the run's frame, (n,)."""
    if run.setups is None or not any(setup.is_elsewhere for setup in run.setups.each):
        return np.zeros(len(run), np.bool_)
    away = np.array([setup.is_elsewhere for setup in run.setups.each])
    return np.asarray(away[run.setups.number.column()] & ~run.machine_frame & (run.work_offset != NO_OFFSET))


def rows_without_values(run: Run) -> Iterator[tuple[int, Wording]]:
    """Yield the rows of which less is stated than of others, each with what is missing."""
    used = list(_used(run))
    most = max((known_values(setup) for setup, _ in used), default=0)
    for setup, rows in used:
        if known_values(setup) < most:
            if setup.machine.workpiece_zero is None:
                why = phrase("no_zero_of", names=(offset_name(run, setup.work_offset),))
            else:
                why = phrase("no_length_of", names=(_tool_name(setup.tool),))
            yield from ((row, why) for row in rows.tolist())


def _used(run: Run) -> Iterator[tuple[Setup, Ints]]:
    """Yield the set-ups in which slides move at the workpiece, with their rows."""
    if run.setups is None:
        return
    named = (run.programmed & _SLIDE_WORDS) != 0
    moves = named | names_no_axis(run.programmed) | (run.tcp & ((run.programmed & int(ROTARY_WORDS)) != 0))
    rows = np.flatnonzero(moves & ~run.machine_frame)
    numbers = run.setups.number.at(rows)
    for number in distinct(numbers).tolist():
        yield run.setups.each[number], rows[numbers == number]


def offset_name(run: Run, offset: int) -> str:
    """Return what messages call a work offset, 0 for none."""
    return run.work_offset_name(offset) if offset else "no work offset"


def _tool_name(tool: str) -> str:
    return f"tool {tool}" if tool else "no tool"
