"""What was agreed upon: rows at which a program is not to be as its CL file has it.

A planner may lean the tool axis near a pole, and lower a feed, so that a rotary axis need not be faster than it can. It
says so row by row. What it says is believed only as far as it goes: the tool axis of the rotary positions that it names
is held against the CL file's, and may be off by the angle that was asked for, no more; a feed may be lower than the CL
file's, but only as low as the rotary axes need it. The program then has to be as was said, within half the last digit,
and everywhere else as the CL file says.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.machines import Machine, forward
from trunnion.model.deviations import Deviations
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.expected.path import ExpectedPath, Section
from trunnion.verification.matching.path_matching import Matching

#: What an angle between tool axes may be more than what was agreed, degrees: rounding here.
_NOISE: Final = 1e-7

#: Share of its rapid speed that a rotary axis must need for a feed to be lowered that far.
_NEEDED: Final = 0.95

#: Two points, each off by one in three coordinates, are farther apart by this at most.
_BOTH_ENDS: Final = 2.0 * 3.0**0.5


@dataclass(frozen=True, slots=True)
class DeviationFault:
    """A CL row at which what was said cannot be, or is not what the program does."""

    cl: int
    value: float
    text: str


@dataclass(frozen=True, slots=True, eq=False)
class AcceptedDeviations:
    """What is wanted now, with what was said that cannot be believed, and how far the rest goes.

    lean    degrees by which the tool axis leans at most, and at how many rows
    slowed  the lowest feed, and at how many rows it is lower
    """

    axis: tuple[DeviationFault, ...] = ()
    feed: tuple[DeviationFault, ...] = ()
    lean: tuple[float, int] = (0.0, 0)
    slowed: tuple[float, int] = (np.inf, 0)


def accept_deviations(expected: ExpectedPath, machine: Machine) -> AcceptedDeviations:
    """Put what was agreed upon into what is wanted."""
    sections, off_axis, off_feed = [], list[DeviationFault](), list[DeviationFault]()
    lean, leaned, slowest, slowed = 0.0, 0, np.inf, 0
    for section in expected.sections:
        deviations = section.tolerances.deviations
        if deviations is None:
            sections.append(section)
            continue
        moves = section.operation.moves
        axis, feed = moves.axis.copy(), moves.feed.copy()
        joints = np.zeros((len(deviations.leaned_rows), 5))
        joints[:, list(machine.rotary)] = deviations.leaned_rotary
        axis[deviations.leaned_rows] = forward(machine, joints)[1]
        away = np.linalg.norm(axis[deviations.leaned_rows] - moves.axis[deviations.leaned_rows], axis=1)
        off = np.degrees(2.0 * np.arcsin(np.minimum(0.5 * away, 1.0)))
        for k in np.flatnonzero(~(off <= deviations.max_lean + _NOISE)).tolist():
            text = (
                f"the tool axis is said to lean by {off[k]:.6f} degrees,"
                f" more than the {deviations.max_lean:g} asked for"
            )
            off_axis.append(DeviationFault(section.first + int(deviations.leaned_rows[k]), float(off[k]), text))
        feed[deviations.slowed_rows] = deviations.slowed_feed
        for k in np.flatnonzero(
            ~((deviations.slowed_feed > 0.0) & (deviations.slowed_feed <= moves.feed[deviations.slowed_rows]))
        ).tolist():
            text = f"a feed of {deviations.slowed_feed[k]:g} is said to be a lower one than the CL file's"
            off_feed.append(
                DeviationFault(section.first + int(deviations.slowed_rows[k]), float(deviations.slowed_feed[k]), text)
            )
        lean, leaned = max(lean, float(off.max(initial=0.0))), leaned + len(off)
        slowest, slowed = (
            min(slowest, float(deviations.slowed_feed.min(initial=np.inf))),
            slowed + len(deviations.slowed_rows),
        )
        sections.append(
            replace(section, operation=replace(section.operation, moves=replace(moves, axis=axis, feed=feed)))
        )
    expected.sections = tuple(sections)
    return AcceptedDeviations(tuple(off_axis), tuple(off_feed), (lean, leaned), (slowest, slowed))


def misplaced_lean_positions(run: Run, expected: ExpectedPath, matching: Matching) -> list[DeviationFault]:
    """Rows whose rotary axes are not where they were said to be; whole turns of endless ones are left out."""
    broken = []
    columns = list(run.machine.rotary)
    for section, deviations in _agreeing(expected):
        for nc, cl in matching.pair_chunks(matching.cl.before(section.first), matching.cl.before(section.end)):
            here, k = _among(cl - section.first, deviations.leaned_rows)
            if not len(here):
                continue
            off = run.positions(nc[here]).joints[:, columns] - deviations.leaned_rotary[k]
            for r, column in enumerate(columns):
                if run.machine.axes[column].endless:
                    off[:, r] -= 360.0 * np.rint(off[:, r] / 360.0)
            by_vector = (run.programmed[nc[here]] & int(ProgrammedWord.VECTOR)) != 0
            worst = np.where(by_vector, 0.0, np.abs(off).max(axis=1))
            for bad in np.flatnonzero(~(worst <= section.tolerances.angle)).tolist():
                text = f"a rotary axis is {worst[bad]:.6f} degrees from where it was said to be near the pole"
                broken.append(DeviationFault(int(cl[here[bad]]), float(worst[bad]), text))
    return broken


def needlessly_lowered_feeds(run: Run, expected: ExpectedPath, matching: Matching) -> list[DeviationFault]:
    """Rows whose feed was lowered farther than the rotary axes need it.

    Lines for arcs share a feed, and ways that rounding may have made are no measure: both are left out.
    """
    broken = []
    rapid = np.array([run.machine.axes[column].rapid or np.inf for column in run.machine.rotary])
    for section, deviations in _agreeing(expected):
        for nc, cl in matching.pair_chunks(matching.cl.before(section.first), matching.cl.before(section.end)):
            here, k = _among(cl - section.first, deviations.slowed_rows)
            here, k = here[expected.kind(cl[here]) != Kind.ARC], k[expected.kind(cl[here]) != Kind.ARC]
            # Points between lead there as well: the way is that from the CL point before.
            first = nc[here] - 1 - matching.leading(cl[here])
            here, k, first = here[first >= 0], k[first >= 0], first[first >= 0]
            if not len(here):
                continue
            now, before = run.positions(nc[here]), run.positions(first)
            # What is printed is rounded at both ends: this is the most that the axes may need.
            turned = np.abs(now.joints - before.joints)[:, list(run.machine.rotary)] + 2.0 * section.tolerances.angle
            length = np.linalg.norm(now.tip - before.tip, axis=1) - _BOTH_ENDS * section.tolerances.tip
            per_rev = expected.per_rev(cl[here])
            rate = deviations.slowed_feed[k] * np.where(per_rev, run.state.rpm.at(nc[here]), 1.0)
            with np.errstate(divide="ignore", invalid="ignore"):
                share = (turned / rapid).max(axis=1) * rate / length
            for bad in np.flatnonzero(~(share >= _NEEDED) & (length > 0.0)).tolist():
                text = (
                    f"the feed is lowered to {deviations.slowed_feed[k[bad]]:g}, and the rotary axes need no more than"
                    f" {100.0 * share[bad]:.0f} % of their rapid speed there"
                )
                broken.append(DeviationFault(int(cl[here[bad]]), float(deviations.slowed_feed[k[bad]]), text))
    return broken


def _agreeing(expected: ExpectedPath) -> list[tuple[Section, Deviations]]:
    return [
        (section, section.tolerances.deviations)
        for section in expected.sections
        if section.tolerances.deviations is not None
    ]


def _among(rows: Ints, growing: Ints) -> tuple[Ints, Ints]:
    """Which of ``rows`` are among growing ones, as indices into both."""
    if not len(growing):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    k = np.minimum(np.searchsorted(growing, rows), len(growing) - 1)
    here = np.flatnonzero(growing[k] == rows)
    return here, k[here]
