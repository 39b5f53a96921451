"""Programs in several work offsets, in the frame of one of them: the part stands where that one has it.

In:     the runs of a set-up, each row in the frame of its own work offset, with the zeros of the offsets.
Out:    the runs in one workpiece frame.
Units:  mm. Zeros shift the frame, and never turn it.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine
from trunnion.machines.machine import Vector
from trunnion.model.programmed_words import POSITION_WORDS, ROTARY_WORDS
from trunnion.model.run import Run
from trunnion.model.run_setups import RunSetups
from trunnion.records import dataclass

_WORDS: Final = int(POSITION_WORDS | ROTARY_WORDS)


@dataclass(frozen=True, slots=True)
class WorkpieceFrame:
    """That of a work offset, 0 for none, with its zero; None: it is not known."""

    offset: int
    zero: Vector | None

    def runs(self, runs: Sequence[Run]) -> tuple[Run, ...]:
        """Return runs in this frame; as they are where one zero holds throughout, or none is stated of any offset."""
        each = [setup for run in runs if run.setups is not None for setup in run.setups.each]
        if all(setup.machine.workpiece_zero is None for setup in each):
            return tuple(runs)
        return tuple(run if run.setups is None else self._moved(run, run.setups) for run in runs)

    def _moved(self, run: Run, setups: RunSetups) -> Run:
        """Return a run in this frame, with the work offsets marked of which nobody knows where they are in it."""
        known = [self.zero is not None and setup.machine.workpiece_zero is not None for setup in setups.each]
        marked = tuple(
            replace(setup, is_elsewhere=not is_known and setup.work_offset != self.offset)
            for setup, is_known in zip(setups.each, known, strict=True)
        )
        run = replace(run, setups=RunSetups(marked, setups.number))
        return run if self.zero is None else _moved(run, self.zero)


def frame_of_offset(runs: Sequence[Run], stated: int | None) -> WorkpieceFrame:
    """Return the frame of the stated work offset, or of the first in which programs move."""
    offset = _first_offset(runs) if stated is None else stated
    return WorkpieceFrame(offset, _zero_of(offset, runs))


def _first_offset(runs: Sequence[Run]) -> int:
    for run in runs:
        rows = np.flatnonzero(((run.programmed & _WORDS) != 0) & ~run.machine_frame & (run.work_offset != 0))
        if len(rows):
            return int(run.work_offset[rows[0]])
    return 0


def _zero_of(offset: int, runs: Sequence[Run]) -> Vector | None:
    """Return the zero of a work offset where it is stated."""
    return next(
        (
            setup.machine.workpiece_zero
            for run in runs
            if run.setups is not None
            for setup in run.setups.each
            if setup.work_offset == offset and setup.machine.workpiece_zero is not None
        ),
        None,
    )


def _moved(run: Run, zero: Vector) -> Run:
    """Return a run with the zero of one work offset throughout: what it says of axes and their positions stays."""
    assert run.setups is not None
    each = run.setups.each
    shifts = np.array([np.subtract(setup.machine.workpiece_zero or zero, zero) for setup in each], np.float64)
    machines: dict[float | None, Machine] = {}
    for setup in each:
        length = setup.machine.tool_length
        machines.setdefault(length, replace(setup.machine, workpiece_zero=zero))
    setups = tuple(replace(setup, machine=machines[setup.machine.tool_length]) for setup in each)
    numbers = run.setups.number
    machine = replace(run.machine, workpiece_zero=zero)
    if not shifts.any():
        return replace(run, machine=machine, setups=RunSetups(setups, numbers))
    xyz, is_tip = run.xyz.copy(), run.state.xyz_is_tip.column().astype(np.bool_)
    xyz[is_tip] += shifts[numbers.at(np.flatnonzero(is_tip))]
    return replace(
        run,
        machine=machine,
        setups=RunSetups(setups, numbers),
        xyz=xyz,
        arcs=replace(run.arcs, centre=run.arcs.centre + _at(shifts, numbers.at(run.arcs.row))),
        splines=run.splines.with_poles(
            run.splines.poles + _at(shifts, np.repeat(numbers.at(run.splines.last), np.diff(run.splines.pole_begin)))
        ),
    )


def _at(shifts: Floats, numbers: Ints) -> Floats:
    return np.asarray(shifts[np.asarray(numbers, np.int64)].reshape(-1, 3))
