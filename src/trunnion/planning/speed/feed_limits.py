"""The stage that limits speeds: feeds are lowered where a rotary axis would have to be too fast, if the user asks.

If not, the decision log says where an axis would be too fast, and what would help.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import kinematic_parameters
from trunnion.messages import Wording, phrase
from trunnion.model.deviations import Deviations
from trunnion.model.motion import Decision, DecisionTopic, PoleStrategy
from trunnion.model.toolpath import Operation
from trunnion.planning.poses.selection import PlannedPoses
from trunnion.planning.request import PreparedOperation
from trunnion.planning.retracts.rewind import Rewind
from trunnion.planning.speed.rotary_speed import OffPartTurns, find_fastest_row, lower_feeds
from trunnion.records import dataclass

#: Stretches of rows that are named one by one.
_NAMED: Final = 20

#: The lean from which a sufficient one is looked for where none is set, degrees.
_LEAST_LEAN: Final = 0.01


@dataclass(frozen=True, slots=True, eq=False)
class FeedResult:
    """An operation with its feeds after this stage; ``deviations`` with the rows whose feed is lower."""

    operation: Operation
    deviations: Deviations
    log: tuple[Decision, ...]


def limit_feeds(
    prepared: PreparedOperation, poses: PlannedPoses, rewinds: Sequence[Rewind], deviations: Deviations
) -> FeedResult:
    """Lower feeds as the options ask.

    prepared    with the tool axes that the machine will have
    rewinds     those that will be inserted: the rotary axes turn off the part there
    deviations  those so far
    """
    operation = prepared.operation
    off_part = OffPartTurns(
        np.array([rewind.row for rewind in rewinds], np.int64),
        np.array([rewind.after for rewind in rewinds]).reshape(-1, 2),
    )
    if not prepared.request.options.lower_feed:
        return FeedResult(operation, deviations, tuple(_speed_decisions(prepared, poses, off_part)))
    source = prepared.source_rows
    moves, rows = lower_feeds(prepared.request.machine, operation, poses.rotary, off_part, source)
    cl_rows, last = np.unique(source[rows], return_index=True)
    slowed = replace(operation, moves=moves)
    log = [*_feed_decisions(prepared, rows, moves.feed)]
    log += _speed_decisions(prepared.with_operation(slowed), poses, off_part)
    return FeedResult(slowed, replace(deviations, slowed_rows=cl_rows, slowed_feed=moves.feed[rows[last]]), tuple(log))


def _feed_decisions(prepared: PreparedOperation, rows: Ints, feed: Floats) -> Iterator[Decision]:
    """One decision for each unbroken stretch of ``rows`` with a lower feed."""
    stretches: Sequence[Ints] = np.split(rows, np.flatnonzero(np.diff(rows) != 1) + 1) if len(rows) else []
    moves = prepared.operation.moves
    for stretch in stretches[:_NAMED]:
        least = stretch[np.argmin(feed[stretch])]
        said = Wording(
            "decision", "feed_lowered", before=moves.feed[least], after=feed[least], first=moves.line[stretch[0]],
            last=moves.line[stretch[-1]],
        )  # fmt: skip
        yield prepared.decision(int(stretch[0]), DecisionTopic.FEED, said)
    if len(stretches) > _NAMED:
        said = Wording("decision", "feeds_lowered", count=len(stretches) - _NAMED)
        yield prepared.decision(int(stretches[-1][0]), DecisionTopic.FEED, said)


def _speed_decisions(prepared: PreparedOperation, poses: PlannedPoses, off_part: OffPartTurns) -> Iterator[Decision]:
    """Where a rotary axis would have to be faster than it can, and what helps; only if an option asks for either."""
    machine, operation, options = prepared.request.machine, prepared.operation, prepared.request.options
    if not (options.explain or options.lower_feed or options.pole_strategy is not PoleStrategy.OFF):
        return
    # Few posts ask for either.
    from trunnion.planning.pole.handling import sufficient_setting
    from trunnion.planning.pole.lean_limits import degrees_off_pole

    worst = find_fastest_row(machine, operation, poses.rotary, off_part)
    if not worst.count:
        return
    axis = machine.axes[machine.rotary[worst.axis]]
    off = float(degrees_off_pole(kinematic_parameters(machine), operation.moves.axis[worst.row : worst.row + 1])[0])
    effect = phrase("feed_fastest_lowers" if options.fastest_feed else "control_slows_down")
    if options.pole_strategy is not PoleStrategy.OFF:
        cure: Wording | str = "" if options.fastest_feed else phrase("set_lower_feed")
    elif options.explain and not options.lower_feed:
        cure = sufficient_setting(prepared, poses, _LEAST_LEAN)
    else:
        cure = phrase("pole_lean_helps" if options.fastest_feed else "pole_lean_or_lower_feed_helps")
    said = Wording(
        "decision", "too_fast", axis=axis.name, share=100.0 * worst.share, rapid=axis.rapid, off=off,
        count=worst.count, effect=phrase("effect_and_cure", effect=effect, cure=cure) if cure else effect,
    )  # fmt: skip
    yield prepared.decision(worst.row, DecisionTopic.SPEED, said)
