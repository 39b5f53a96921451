"""A run with rows between its rows."""

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trunnion.arrays import Floats, Ints
from trunnion.model.columns import RampColumn, StepColumn
from trunnion.model.run import Run
from trunnion.model.run_columns import ModalState
from trunnion.model.toolpath import Arcs, Kind
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Insertion:
    """Rows that end elsewhere, and rows that are inserted.

    rows           (k,) int64, ascending: rows that end elsewhere
    tip            (k, 3) where, mm, workpiece frame
    before         (j,) int64, ascending: the row before which each is inserted, whose state it has
    inserted       (j, 3) where these end
    centre, normal (j, 3), radius (j,): of circles; a normal of 0 is that of a line
    circles        (i,) int64: rows that stay circles, and circle_radius (i,) their radii now
    """

    rows: Ints
    tip: Floats
    before: Ints
    inserted: Floats
    centre: Floats
    normal: Floats
    radius: Floats
    circles: Ints
    circle_radius: Floats


def with_inserted_rows(run: Run, insertions: Sequence[Insertion]) -> tuple[Run, Ints]:
    """Return a run with rows that end elsewhere and rows between them, and where each row of the run is in it, (n,).

    What is inserted before a row comes behind the events before that row, and has its line.
    """
    before = np.concatenate([each.before for each in insertions])
    count = np.bincount(before, minlength=len(run))
    take = np.repeat(np.arange(len(run)), count + 1)
    row_of = np.arange(len(run)) + np.cumsum(count)
    first = np.append(row_of - count, len(take))
    added = np.ones(len(take), np.bool_)
    added[row_of] = False
    at = np.flatnonzero(added)
    kind, xyz = run.kind[take], run.xyz[take]
    is_tip = run.state.xyz_is_tip.column()[take].astype(np.bool_)
    for each in insertions:
        xyz[row_of[each.rows]] = each.tip
        is_tip[row_of[each.rows]] = True
    xyz[at] = np.concatenate([each.inserted for each in insertions])
    is_tip[at] = True
    normal = np.concatenate([each.normal for each in insertions])
    curved = np.abs(normal).max(axis=1, initial=0.0) > 0.0
    kind[at] = np.where(curved, Kind.ARC, np.where(kind[at] == Kind.ARC, Kind.LINEAR, kind[at]))
    state = ModalState(**{each.name: _moved(getattr(run.state, each.name), first) for each in fields(ModalState)})
    found = replace(
        run,
        lines=_ramps(run.line[take].astype(np.int64)),
        block_numbers=_ramps(run.block_number[take]),
        kind=kind,
        programmed=run.programmed[take],
        xyz=xyz,
        rotary=run.rotary[take],
        state=replace(state, xyz_is_tip=_steps(is_tip)),
        arcs=arcs_with_inserted(run.arcs, insertions, row_of, at[curved]),
        splines=replace(run.splines, first=first[run.splines.first], last=row_of[run.splines.last]),
        normals=replace(run.normals, row=row_of[run.normals.row]),
        setups=None if run.setups is None else replace(run.setups, number=_moved(run.setups.number, first)),
        comments=[replace(each, before_row=int(first[each.before_row])) for each in run.comments],
        events=[replace(each, before_row=int(first[each.before_row])) for each in run.events],
        units_from=None if run.units_from is None else int(first[run.units_from]),
        spindle_holes=tuple(
            replace(hole, first=int(first[hole.first]), end=int(first[hole.end])) for hole in run.spindle_holes
        ),
    )
    return found, row_of


def arcs_with_inserted(arcs: Arcs, insertions: Sequence[Insertion], row_of: Ints, rows: Ints) -> Arcs:
    """Return circles with those that are inserted in ``rows``."""
    radius = arcs.radius.copy()
    for each in insertions:
        radius[np.searchsorted(arcs.row, each.circles)] = each.circle_radius
    normal = np.concatenate([each.normal for each in insertions])
    curved = np.abs(normal).max(axis=1, initial=0.0) > 0.0
    row = np.concatenate((row_of[arcs.row], rows))
    order = np.argsort(row, kind="stable")
    return Arcs(
        row[order],
        np.concatenate((arcs.centre, *(each.centre for each in insertions)))[_kept(len(arcs.row), curved)][order],
        np.concatenate((arcs.normal, normal))[_kept(len(arcs.row), curved)][order],
        np.concatenate((radius, *(each.radius for each in insertions)))[_kept(len(arcs.row), curved)][order],
        np.concatenate((arcs.full_turns, np.zeros(len(rows), np.int64)))[order],
    )


def _kept(count: int, curved: NDArray[np.bool_]) -> NDArray[np.bool_]:
    return np.concatenate((np.ones(count, np.bool_), curved))


def _moved(column: StepColumn, first: Ints) -> StepColumn:
    n = column.n
    rows = np.where(column.rows < n, first[np.minimum(column.rows, n)], column.rows - n + first[-1])
    return StepColumn(int(first[-1]), rows, column.values)


def _steps(column: NDArray[Any]) -> StepColumn:
    changes: Ints = np.flatnonzero(np.append(True, column[1:] != column[:-1]))
    return StepColumn(len(column), changes, column[changes])


def _ramps(column: Ints) -> RampColumn:
    """Return a column as stretches in which it stays."""
    steps = _steps(column)
    return RampColumn(steps.n, steps.rows, steps.values, np.zeros(len(steps.rows), np.int64))
