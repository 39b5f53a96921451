"""Fit a path so that what it leaves deviates least from a flank: sequential linear programs with a trust region.

Each round makes the deviations linear in the control points and solves one linear program (SciPy's HiGHS): the least
possible of max(overcut, undercut), or of the undercut while the overcut stays within a limit. The control points move
by the trust region at most; a step that does not improve what is really left is taken back and the region shrinks.

Units: mm.
"""

from typing import Any, Final, NamedTuple

import numpy as np

from trunnion.arrays import Floats
from trunnion.extras import import_extra
from trunnion.impeller.flank.deviations import Deviations, deviations_of, slopes_of
from trunnion.impeller.flank.path import FlankPath, basis
from trunnion.impeller.linear_program import SIMPLEX, solve_linear_program
from trunnion.impeller.progress import Advance, ignore
from trunnion.records import dataclass

#: Local minima along the path of which each must not cut too much: the least is not always the same one.
_MINIMA: Final = 3

#: Part of the largest deviation by which the roughness of a step counts: enough to choose among equal steps.
_SMOOTH: Final = 1e-4

#: A fit ends when so many rounds have improved it by less than so large a part.
_RESTING: Final = 6
_NOTHING: Final = 0.005

#: By how much overcut beyond its limit counts more than undercut.
_PENALTY: Final = 20.0


@dataclass(frozen=True, slots=True)
class Limits:
    """What a fit makes least.

    overcut  its limit, mm; None: overcut and undercut count the same
    enough   what need not become less, mm
    rounds   linear programs at most
    """

    overcut: float | None = None
    enough: float = 2e-4
    rounds: int = 60

    def merit(self, deviations: Floats) -> float:
        """Return what is made least, of deviations (n,)."""
        both = Deviations.of(deviations)
        if self.overcut is None:
            return both.largest
        return both.undercut + _PENALTY * max(0.0, both.overcut - self.overcut)


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """A fitted path: what is left at the points it was fitted to, and after each round what was made least."""

    path: FlankPath
    deviations: Deviations
    history: tuple[float, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Floor:
    """A surface that the ball at the cutter's end must stay clear of: how far it is and where, at even parameters.

    distances  of points (n, 3): (n,) mm, and the directions (n, 3) in which they grow
    least      that the ball's centre must have, mm
    """

    distances: Any
    least: float
    places: int = 120


class _Left(NamedTuple):
    """What a path leaves at points (n, 3): what is made least, the deviations (n, minima), and where they are."""

    merit: float
    points: Floats
    found: Floats
    at: Floats


def fit_path(
    path: FlankPath, points: Floats, limits: Limits, floor: Floor | None = None, advance: Advance = ignore
) -> Fit:
    """Return the path fitted to points (n, 3) of a flank, from one that is near."""
    left = _left(path, points, limits, floor)
    history = [left.merit]
    region = min(max(2.0 * left.merit, 1e-3), 0.25 * path.cutter.radius)
    smallest = 1e-3 * limits.enough
    for _ in range(limits.rounds):
        if left.merit <= limits.enough or region < smallest:
            break
        advance(1)
        step, foreseen = _step(path, left, limits, region, floor)
        tried = FlankPath(path.lower + step[0], path.upper + step[1], path.cutter)
        new = _left(tried, points, limits, floor)
        gain, hoped = left.merit - new.merit, left.merit - foreseen
        if hoped < 1e-4 * limits.enough or _rests(history):
            break
        if gain > 0.0:
            path, left = tried, new
            history.append(left.merit)
        if gain > 0.7 * hoped:
            region *= 2.0
        elif gain < 0.25 * hoped:
            region *= 0.35
    return Fit(path, Deviations.of(left.found[:, 0]), tuple(history))


def _rests(history: list[float]) -> bool:
    """Whether the last rounds have changed next to nothing."""
    return len(history) > _RESTING and history[-1] > (1.0 - _NOTHING) * history[-1 - _RESTING]


def _left(path: FlankPath, points: Floats, limits: Limits, floor: Floor | None) -> _Left:
    """Return what a path leaves."""
    found, at = deviations_of(path, points, _MINIMA)
    merit = limits.merit(found[:, 0])
    if floor is not None:
        distance = floor.distances(path.poses(np.linspace(0.0, 1.0, floor.places))[0])[0]
        merit += _PENALTY * max(0.0, floor.least - float(distance.min()))
    return _Left(merit, points, found, at)


def _step(path: FlankPath, now: _Left, limits: Limits, region: float, floor: Floor | None) -> tuple[Floats, float]:
    """Return the step of the lower and upper control points (2, k, 3), and what is left after it by the linear program.

    Unknowns: the control points' moves, what is made least, what is beyond a limit, roughness.
    """
    sparse = import_extra("scipy.sparse", "geometry")
    _, points, found, at = now
    count = len(path.lower)
    moves = 6 * count
    rows, bounds = [], []
    reach = 4.0 * region
    # Overcut at every local minimum that may come to count, undercut at the least one.
    allowed = Deviations.of(found[:, 0]).overcut if limits.overcut is None else limits.overcut
    which, minimum = np.nonzero(found < reach - 0.5 * allowed)
    gap, change = found[which, minimum], _change(path, points[which], at[which, minimum])
    hard = limits.overcut is not None
    rows.append(_rows(sparse, -change, -1.0 if not hard else 0.0, -1.0 if hard else 0.0))
    bounds.append(gap + (limits.overcut if limits.overcut is not None else 0.0))
    left = found[:, 0] >= min(Deviations.of(found[:, 0]).undercut - reach, found[:, 0].max())
    rows.append(_rows(sparse, _change(path, points[left], at[left, 0]), -1.0, 0.0))
    bounds.append(-found[left, 0])
    if floor is not None:
        places = np.linspace(0.0, 1.0, floor.places)
        distance, grow = floor.distances(path.poses(places)[0])
        from_floor = _floor_change(path, places, grow)
        rows.append(_rows(sparse, -from_floor, 0.0, -1.0))
        bounds.append(distance - floor.least)
    program = sparse.vstack(rows)
    rough = _roughness(sparse, count)
    base = np.concatenate((path.lower.ravel(), path.upper.ravel()))
    bend = rough @ base
    more = rough.shape[0]
    eye = sparse.identity(more)
    gap_columns = sparse.csr_matrix((more, 2))
    matrix = sparse.vstack(
        (
            sparse.hstack((program, sparse.csr_matrix((program.shape[0], more)))),
            sparse.hstack((rough, gap_columns, -eye)),
            sparse.hstack((-rough, gap_columns, -eye)),
        )
    ).tocsr()
    right = np.concatenate((*bounds, -bend, bend))
    cost = np.concatenate((np.zeros(moves), [1.0, _PENALTY], np.full(more, _SMOOTH / more)))
    ranges: list[tuple[float | None, float | None]] = [(-region, region)] * moves + [(0.0, None)] * (2 + more)
    solved = solve_linear_program(cost, matrix, right, ranges, SIMPLEX)
    if solved is None:
        return np.zeros((2, count, 3)), np.inf
    return solved[:moves].reshape(2, count, 3), float(solved[moves] + _PENALTY * solved[moves + 1])


def _rows(sparse: Any, change: Floats, left: float, beyond: float) -> Any:
    """Rows of the program: changes by the control points, and factors of what is left and of what is beyond a limit."""
    ends = np.tile([left, beyond], (len(change), 1))
    return sparse.csr_matrix(np.concatenate((change, ends), axis=1))


def _change(path: FlankPath, points: Floats, at: Floats) -> Floats:
    """Return changes (n, 6 k) of distances by the coordinates of lower, then of upper control points."""
    return slopes_of(path, points, at).changes()


def _floor_change(path: FlankPath, places: Floats, grow: Floats) -> Floats:
    """Return changes (n, 6 k) of the lower points' distances to the floor."""
    weights = basis(places, len(path.lower))
    part = (weights[:, :, None] * grow[:, None]).reshape(len(places), -1)
    return np.concatenate((part, np.zeros_like(part)), axis=1)


def _roughness(sparse: Any, count: int) -> Any:
    """Third differences of the control points of both curves, as rows."""
    one = sparse.diags([-1.0, 3.0, -3.0, 1.0], [0, 1, 2, 3], shape=(count - 3, count))
    return sparse.kron(sparse.identity(2), sparse.kron(one, sparse.identity(3))).tocsr()
