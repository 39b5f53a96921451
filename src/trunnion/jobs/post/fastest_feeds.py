"""Feeds per block that the machine can follow (setting ``feed=fastest``).

In:     a program with the greatest feeds that it may have, and its run.
Out:    the same program with the feeds that the axes reach there, declared as such.

A program that was read back is timed, as only that has the tolerances, stops and modes of its templates. The proof
times the program with the lower feeds anew.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.words import NumberFormat
from trunnion.errors import InputError, Problem, setting_problem, warning
from trunnion.jobs.post.expected_values import expectation
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.feed_path import NO_ROTATION
from trunnion.model.motion import Motion
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind, Phase, Toolpath
from trunnion.output.program import Program
from trunnion.planning import PlanOptions
from trunnion.timing import HARDLY_MOVES
from trunnion.verification import reachable_feeds

#: A feed that is reached but for this share is reached.
_REACHED: Final = 1e-6

#: Digits of a feed that is lowered: fewer blocks then need an F of their own, and it costs 1 % at most.
_DIGITS: Final = 3


def with_reached_feeds(
    program: Program, run: Run | None, toolpaths: Sequence[Toolpath], options: PlanOptions
) -> Program:
    """Return the program with the feeds that the axes reach.

    program  with the greatest feeds
    run      of that program; None: no reader knows the control

    Raises ``InputError`` if nothing can read the program back.
    """
    if run is None:
        raise InputError(
            setting_problem("feed", Wording("CTL920", "nothing_times_feeds", control=program.control.name))
        )
    expected = expectation(program, options)
    reached = reachable_feeds(run, toolpaths, expected.tolerances, expected.settings)
    own = [operation.moves.feed for path in toolpaths for operation in path.operations if len(operation.moves)]
    groups: list[list[Motion]] = []
    for motion in program.motions:
        if motion.starts_operation:
            groups.append([])
        groups[-1].append(motion)
    motions: list[Motion] = []
    for group, (feeds, kept), cl_feeds in zip(groups, reached, own, strict=True):
        slower = [_with_feeds(program, motion, np.where(kept, np.nan, feeds), cl_feeds) for motion in group]
        motions += [_declared(slower, cl_feeds, kept), *slower[1:]]
    return replace(program, motions=motions)


def _with_feeds(program: Program, motion: Motion, reached: Floats, cl_feeds: Floats) -> Motion:
    """Return a motion with what is ``reached`` at the rows of its CL file, (n,), where that is less than its feeds.

    Where it is not known, or to be kept, and where the tip rests, the feed is no higher than that of the CL file.
    """
    moves, splines = motion.operation.moves, motion.operation.splines
    number_format = program.control.number_formats(motion.three_axis)["feed"]
    rows, at = _rows_at_feed(motion)
    found, own = np.full(len(moves), np.nan), np.full(len(moves), np.nan)
    found[at], own[at] = reached[rows], cl_feeds[rows]
    for k in range(len(splines)):  # a spline has one feed
        first, last, _ = splines[k]
        found[first : last + 1] = found[last]
    stays = np.isnan(found) | _tip_rests(motion)
    lower = ~stays & (found < moves.feed * (1.0 - _REACHED))
    feed = moves.feed.copy()
    feed[lower] = np.minimum(rounded_down(found[lower], number_format), feed[lower])
    limited = stays & (moves.phase == Phase.CUT)
    feed[limited] = np.fmin(feed[limited], own[limited])
    _lower_rewinds(motion, feed, number_format)
    if rapid := program.effective_setting("rapid_feed"):  # a line at this feed is a rapid
        feed[(feed < moves.feed) & (np.abs(feed - float(rapid)) < number_format.digit)] -= number_format.digit
    return replace(motion, operation=replace(motion.operation, moves=replace(moves, feed=feed)))


def _tip_rests(motion: Motion) -> Flags:
    """Rows that turn rotary axes while the tip hardly moves, (n,): the feed of the others is none of theirs."""
    turned = np.abs(np.diff(motion.rotary, axis=0)).max(axis=1, initial=0.0)
    travel = np.linalg.norm(np.diff(motion.operation.moves.tip, axis=0), axis=1)
    rests = np.zeros(len(motion.rotary), np.bool_)
    rests[1:] = (turned > NO_ROTATION) & (travel < HARDLY_MOVES)
    rests[motion.operation.arcs.row] = False
    return rests


def _lower_rewinds(motion: Motion, feed: Floats, number_format: NumberFormat) -> None:
    """Lower the feeds of rewinds, which are shares of that of the cut behind them, as much as this one."""
    moves, cl_rows = motion.operation.moves, motion.cl_rows
    assert cl_rows is not None
    rows = np.flatnonzero((cl_rows < 0) & (moves.kind != Kind.RAPID) & ~moves.per_rev)
    after = np.flatnonzero(cl_rows >= 0)
    rows = rows[rows < after[-1]] if len(after) else rows[:0]
    cut = after[np.searchsorted(after, rows)]
    lower = feed[cut] < moves.feed[cut]
    rows, cut = rows[lower], cut[lower]
    feed[rows] = np.minimum(rounded_down(feed[rows] * feed[cut] / moves.feed[cut], number_format), feed[rows])


def _rows_at_feed(motion: Motion) -> tuple[Ints, Ints]:
    """Return the CL rows of the rows that have a feed per minute, and these rows."""
    assert motion.cl_rows is not None
    moves = motion.operation.moves
    at = np.flatnonzero((motion.cl_rows >= 0) & (moves.kind != Kind.RAPID) & ~moves.per_rev)
    return motion.cl_rows[at], at


def _declared(motions: Sequence[Motion], cl_feeds: Floats, kept: Flags) -> Motion:
    """Return the first motion of an operation, with a declaration of the feeds in all of them.

    Declared are those that are not the CL file's, and those that are kept although axes do not reach them.
    """
    feeds, declared = cl_feeds.copy(), np.zeros(len(cl_feeds), np.bool_)
    for motion in motions:
        rows, at = _rows_at_feed(motion)
        feed, rests = motion.operation.moves.feed, _tip_rests(motion)[at]
        for some in (rests, ~rests):  # a row that moves the tip has the feed of its point
            feeds[rows[some]] = feed[at[some]]
        declared[rows] = True
    rows = np.flatnonzero(declared & ((feeds != cl_feeds) | kept) & ~np.isnan(feeds))
    deviations = replace(motions[0].deviations, reached_rows=rows, reached_feed=feeds[rows])
    return replace(motions[0], deviations=deviations)


def rounded_down(feed: Floats, number_format: NumberFormat) -> Floats:
    """Return feeds (k,) rounded down to three digits, or to the last that is printed; no lower than the least feed."""
    scale = 10.0**number_format.decimals / number_format.unit
    count = np.floor(feed * scale * (1.0 + 1e-12)).astype(np.int64)
    left_out = np.maximum(np.floor(np.log10(np.maximum(count, 1))).astype(np.int64) + 1 - _DIGITS, 0)
    count -= count % 10**left_out
    least = max(int(np.ceil(number_format.least * scale * (1.0 - 1e-12))), 1)
    return number_format.values(np.maximum(count, least))


def raised_feeds(program: Program, toolpaths: Sequence[Toolpath]) -> list[Problem]:
    """Return a warning of blocks that are faster than the CL file says, as a feed limit may make them."""
    own = [operation.moves.feed for path in toolpaths for operation in path.operations if len(operation.moves)]
    number, count, greatest = -1, 0, 1.0
    for motion in program.motions:
        number += motion.starts_operation
        rows, at = _rows_at_feed(motion)
        share = motion.operation.moves.feed[at] / own[number][rows]
        share = share[share > 1.0 + _REACHED]
        count, greatest = count + len(share), max(greatest, float(share.max(initial=1.0)))
    if not count:
        return []
    return [warning(toolpaths[0].file, 0, Wording("PLN435", "faster_than_cl_file", count=count, greatest=greatest))]


def unlimited_axes(machine: Machine) -> list[Problem]:
    """Return a warning for a machine of which not all is known that limits feeds."""
    names = [axis.name for axis in machine.own_axes if axis.acceleration is None]
    if not names:
        return []
    return [warning(machine.key, 0, Wording("PLN425", "accelerations_not_stated", axes=tuple(names)))]
