"""Declared deviations: rows at which a program departs from its CL file on purpose, and says so.

A planner may lean the tool axis near a pole, and lower a feed, so that no rotary axis has to exceed its speed. It
declares this row by row. A declaration is accepted only within bounds: the tool axis at the declared rotary positions
may be off the CL file's by the angle that was requested, no more; a feed may be lower than the CL file's, but only as
low as the rotary axes need it. Feeds that are what all axes reach are judged by the check ``reach``. The program must
then be as declared, within half the last digit, and everywhere else as the CL file has it.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine, forward
from trunnion.messages import Wording
from trunnion.model.deviations import Deviations
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.verification.expected.path import ExpectedPath, Section
from trunnion.verification.kinematics.axis_difference import degrees_apart
from trunnion.verification.kinematics.positioning_moves import oriented_by_vector
from trunnion.verification.matching.pairs import Matching

#: By how much a lean may exceed the requested angle for rounding, degrees.
_NOISE: Final = 1e-7

#: Share of its rapid speed that a rotary axis must need for a feed to be lowered that far.
_NEEDED: Final = 0.95

#: The distance of two points, each off in three coordinates, is off by so many times the tolerance of a coordinate.
_BOTH_ENDS: Final = 2.0 * 3.0**0.5


@dataclass(frozen=True, slots=True)
class DeviationFault:
    """A CL row at which a declared deviation is out of bounds, or is not what the program does."""

    cl: int
    value: float
    said: Wording


@dataclass(frozen=True, slots=True, eq=False)
class AcceptedDeviations:
    """The expected path with its declared deviations, those that are out of bounds, and how far they go.

    lean    largest angle by which the tool axis leans, degrees, and at how many rows it leans
    slowed  lowest of the lowered feeds, and how many rows are lowered
    """

    expected: ExpectedPath
    axis: tuple[DeviationFault, ...]
    feed: tuple[DeviationFault, ...]
    lean: tuple[float, int]
    slowed: tuple[float, int]


def accept_deviations(expected: ExpectedPath, machine: Machine) -> AcceptedDeviations:
    """Put the declared deviations into the expected path."""
    sections = list(expected.sections)
    off_axis, off_feed = list[DeviationFault](), list[DeviationFault]()
    lean, leaned, slowest, slowed = 0.0, 0, np.inf, 0
    for number, section in enumerate(expected.sections):
        declared = section.tolerances.deviations
        if declared is None:
            continue
        moves = section.operation.moves
        axis, feed = moves.axis.copy(), moves.feed.copy()
        axis[declared.leaned_rows] = _declared_axes(declared, machine)
        feed[declared.slowed_rows] = declared.slowed_feed
        feed[declared.reached_rows] = declared.reached_feed
        leans = degrees_apart(axis[declared.leaned_rows], moves.axis[declared.leaned_rows])
        off_axis += _excessive_leans(section, declared, leans)
        off_feed += _feeds_not_lowered(section, declared)
        off_feed += _feeds_not_reached(section, declared)
        lean, leaned = max(lean, float(leans.max(initial=0.0))), leaned + len(leans)
        slowest = min(slowest, float(declared.slowed_feed.min(initial=np.inf)))
        slowed += len(declared.slowed_rows)
        operation = replace(section.operation, moves=replace(moves, axis=axis, feed=feed))
        sections[number] = replace(section, operation=operation)
    return AcceptedDeviations(
        expected.with_sections(sections), tuple(off_axis), tuple(off_feed), (lean, leaned), (slowest, slowed)
    )


def _declared_axes(declared: Deviations, machine: Machine) -> Floats:
    """Tool axes at the declared rotary positions, (k, 3)."""
    joints = np.zeros((len(declared.leaned_rows), 5))
    joints[:, list(machine.rotary)] = declared.leaned_rotary
    return forward(machine, joints)[1]


def _excessive_leans(section: Section, declared: Deviations, leans: Floats) -> Iterator[DeviationFault]:
    for k in np.flatnonzero(~(leans <= declared.max_lean + _NOISE)).tolist():
        said = Wording("axis", "leans_too_far", lean=leans[k], most=declared.max_lean)
        yield DeviationFault(section.first + int(declared.leaned_rows[k]), float(leans[k]), said)


def _feeds_not_lowered(section: Section, declared: Deviations) -> Iterator[DeviationFault]:
    own = section.operation.moves.feed[declared.slowed_rows]
    for k in np.flatnonzero(~((declared.slowed_feed > 0.0) & (declared.slowed_feed <= own))).tolist():
        feed = float(declared.slowed_feed[k])
        said = Wording("feed", "not_lowered", feed=feed)
        yield DeviationFault(section.first + int(declared.slowed_rows[k]), feed, said)


def _feeds_not_reached(section: Section, declared: Deviations) -> Iterator[DeviationFault]:
    """Yield declared feeds at rows that have none to be reached: rapids, and feeds per revolution."""
    moves, rows = section.operation.moves, declared.reached_rows
    other = (moves.kind[rows] == Kind.RAPID) | moves.per_rev[rows] | ~(declared.reached_feed > 0.0)
    for k in np.flatnonzero(other).tolist():
        feed = float(declared.reached_feed[k])
        yield DeviationFault(section.first + int(rows[k]), feed, Wording("feed", "not_reached", feed=feed))


def misplaced_lean_positions(run: Run, expected: ExpectedPath, matching: Matching) -> list[DeviationFault]:
    """Rows whose rotary axes are not where they were declared to be; whole turns of endless ones do not count."""
    faults = []
    columns, by_vector = list(run.machine.rotary), oriented_by_vector(run)
    for section, declared, nc, cl in _declared_chunks(expected, matching):
        here, k = _indices_among(cl - section.first, declared.leaned_rows)
        if not len(here):
            continue
        off = run.positions(nc[here]).joints[:, columns] - declared.leaned_rotary[k]
        for r, column in enumerate(columns):
            if run.machine.axes[column].endless:
                off[:, r] -= 360.0 * np.rint(off[:, r] / 360.0)
        worst = np.where(by_vector[nc[here]], 0.0, np.abs(off).max(axis=1))
        for bad in np.flatnonzero(~(worst <= section.tolerances.angle)).tolist():
            said = Wording("axis", "not_as_declared", off=worst[bad])
            faults.append(DeviationFault(int(cl[here[bad]]), float(worst[bad]), said))
    return faults


def needlessly_lowered_feeds(run: Run, expected: ExpectedPath, matching: Matching) -> list[DeviationFault]:
    """Rows whose feed was lowered farther than the rotary axes need.

    Not judged are lines that replace an arc, which share a feed, and distances within rounding.
    """
    faults = []
    rotary = list(run.machine.rotary)
    rapid = np.array([run.machine.axes[column].rapid or np.inf for column in rotary])
    for section, declared, nc, cl in _declared_chunks(expected, matching):
        here, k = _indices_among(cl - section.first, declared.slowed_rows)
        no_arc = expected.kind(cl[here]) != Kind.ARC
        here, k = here[no_arc], k[no_arc]
        # Intermediate points lead there as well: the distance counts from the CL point before.
        first = nc[here] - 1 - matching.intermediate_counts(cl[here])
        here, k, first = here[first >= 0], k[first >= 0], first[first >= 0]
        if not len(here):
            continue
        now, before = run.positions(nc[here]), run.positions(first)
        # Both ends are rounded when they are printed: this is the most that the axes may need.
        turned = np.abs(now.joints - before.joints)[:, rotary] + 2.0 * section.tolerances.angle
        length = np.linalg.norm(now.tip - before.tip, axis=1) - _BOTH_ENDS * section.tolerances.tip
        feed = declared.slowed_feed[k] * np.where(expected.per_rev(cl[here]), run.state.rpm.at(nc[here]), 1.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (turned / rapid).max(axis=1) * feed / length
        for bad in np.flatnonzero(~(share >= _NEEDED) & (length > 0.0)).tolist():
            lowered = float(declared.slowed_feed[k[bad]])
            said = Wording("feed", "lowered_too_far", feed=lowered, share=100.0 * share[bad])
            faults.append(DeviationFault(int(cl[here[bad]]), lowered, said))
    return faults


def _declared_chunks(expected: ExpectedPath, matching: Matching) -> Iterator[tuple[Section, Deviations, Ints, Ints]]:
    """Sections with declared deviations, and the rows of run and CL files of their pairs, chunk by chunk."""
    for section in expected.sections:
        declared = section.tolerances.deviations
        if declared is not None:
            for nc, cl in matching.pair_chunks(*matching.pair_range(section.first, section.end)):
                yield section, declared, nc, cl


def _indices_among(rows: Ints, increasing: Ints) -> tuple[Ints, Ints]:
    """Which of ``rows`` are among increasing ones, as indices into both."""
    if not len(increasing):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    k = np.minimum(np.searchsorted(increasing, rows), len(increasing) - 1)
    here = np.flatnonzero(increasing[k] == rows)
    return here, k[here]
