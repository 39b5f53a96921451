"""What a project says of stock and fixtures, and nothing simulates.

In:     a project whose checks simulate nothing, and its posted programs.
Out:    warnings of rapids on the way to the first cut that go through the box of the stock, which nothing has cut yet;
        and of what is not looked at: fixtures, and stock that is clamped turned or that an earlier set-up has cut.
"""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.errors import Problem, warning
from trunnion.jobs.inputs.simulation_input import SetupInput
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.project.project import Judgement, PostedSetup, Project
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.kinematics.unknown_approaches import unknown_approaches

#: How deep a rapid may be in the box of the stock, mm: sizes are rounded, and it may touch.
_TOUCHES: Final = 0.01


def unsimulated_problems(
    project: Project, posted: Sequence[tuple[PostedSetup, Sequence[PostResult]]]
) -> Iterator[Problem]:
    """Yield warnings of a project that simulates nothing."""
    if project.checks.simulate is not Judgement.OFF:
        return
    for setup in project.simulation.setups:
        if setup.fixtures:
            wording = Wording("PRJ240", "fixtures_not_checked", count=len(setup.fixtures))
            yield _of_setup(project, setup, wording)
    first = project.simulation.setups[0]
    for setup in project.simulation.setups:
        if project.simulation.stock and (setup is not first or _is_placed_anew(setup)):
            yield _of_setup(project, setup, Wording("PRJ240", "stock_not_checked"))
    if not (project.simulation.stock and posted and posted[0][0] is project.posted[0]) or _is_placed_anew(first):
        return
    result = posted[0][1][0]
    if result.run is None or result.output is None:
        return
    from trunnion.simulation.stock.solids import stock_shape  # few projects have stock that nothing simulates

    shape = stock_shape(project.simulation.stock)
    row = _first_row_within(result.run, shape.low, shape.high)
    if row is not None:
        name, line = str(project.place_of(result.output)), result.run.lines[row]
        yield warning(name, line, Wording("PRJ240", "rapid_through_stock", stock=str(project.simulation.stock)))


def _of_setup(project: Project, setup: SetupInput, wording: Wording) -> Problem:
    """Return a warning of a set-up."""
    return warning(str(project.path), 0, wording.within("in_setup", setup=setup.name) if setup.name else wording)


def _is_placed_anew(setup: SetupInput) -> bool:
    """Whether stock as it is drawn is elsewhere than in coordinates of the program."""
    return setup.pose is not None or bool(setup.turn or setup.tilt)


def _first_row_within(run: Run, low: Floats, high: Floats) -> int | None:
    """Return the first rapid before all cuts that is within a box, as far as it is known where it goes."""
    rows = _rapids_to_first_cut(run)
    if not len(rows):
        return None
    starts = np.where(_begins_known(run, rows), rows - 1, rows)
    begin, end = run.positions(np.maximum(starts, 0)).tip, run.positions(rows).tip
    begin = np.where((starts >= 0)[:, None], begin, end)
    found = np.flatnonzero(_crosses(begin, end, low + _TOUCHES, high - _TOUCHES))
    return int(rows[found[0]]) if len(found) else None


def _rapids_to_first_cut(run: Run) -> Ints:
    """Rapids in coordinates of the workpiece before the first other motion, of which it is known where they end."""
    frame = run.state.machine_frame.column()
    cuts = np.flatnonzero((run.kind != Kind.RAPID) & ~frame)
    rows = np.flatnonzero(~frame[: cuts[0] if len(cuts) else len(run)])
    rows = np.setdiff1d(rows, unknown_approaches(run).rows)
    return np.asarray(rows[~MachinePositions.of(run).unplaced(rows).any(axis=1)])


def _begins_known(run: Run, rows: Ints) -> Flags:
    """Which rows begin where coordinates of the workpiece have put the tool, (k,) bool."""
    if MachinePositions.of(run).known:
        return np.asarray(rows > 0)
    return np.asarray(np.isin(rows - 1, rows))


def _crosses(begin: Floats, end: Floats, low: Floats, high: Floats) -> Flags:
    """Which lines (k, 3) have a point within a box, (k,) bool."""
    way = end - begin
    with np.errstate(divide="ignore", invalid="ignore"):
        one, two = (low - begin) / way, (high - begin) / way
    still = way == 0.0
    inside = (begin > low) & (begin < high)
    enters = np.where(still, np.where(inside, -np.inf, np.inf), np.minimum(one, two)).max(axis=1)
    leaves = np.where(still, np.where(inside, np.inf, -np.inf), np.maximum(one, two)).min(axis=1)
    return np.asarray(np.maximum(enters, 0.0) < np.minimum(leaves, 1.0))
