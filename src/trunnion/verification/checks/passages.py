"""Ways above the part: from one operation to the next without going home, and the last leg of a way from home.

A program that stays at its tilt leaves straight up along the tool to a height above all operations, goes across at that
height, and straight down to the first point. From home it comes to such a height over the first point, and goes down.
These motions have no CL point; they are recognized by what they do. Any other motion without a CL point stays a fault.
"""

import math
from collections.abc import Container, Iterator, Sequence

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.messages import Wording
from trunnion.model.programmed_words import ROTARY_WORDS
from trunnion.model.run import ProgrammedWord, RowPositions, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.checks.rotary_moves_at_part import rows_away
from trunnion.verification.context import ComparedContext, Context
from trunnion.verification.kinematics.positioning_moves import (
    approach_rows,
    only_positions_rotary_axes,
    repeats_position,
)
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.matching.pairs import Matching
from trunnion.verification.results import Place

#: Tool axes are the same when no component differs by more than this.
_SAME_AXIS = 1e-6

#: No setting leads lower above all operations, mm.
_LEAST_CLEARANCE = 1.0

#: Motions between two operations at most, without those that repeat a position: up, across.
_MOST_ROWS = 2

_ACROSS = int(ProgrammedWord.X | ProgrammedWord.Y)


def passage_rows(context: ComparedContext) -> set[int]:
    """Return the motions without a CL point that lead from one operation to the next above all of them, or from home
    to a place above all of them from which the next motion goes straight down.
    """
    clearance = context.settings.clearance
    wanted = math.inf if clearance is None else clearance - _near(context)
    return {row for rows, margin in _passages(context) if margin >= wanted for row in rows}


def settings_to_repeat(context: ComparedContext) -> dict[int, dict[str, str]]:
    """Return motions without a CL point that would be lawful if the tool might go on above all operations, each with
    the settings that say so.
    """
    found: dict[int, dict[str, str]] = {}
    for rows, margin in _passages(context):
        told = {"name": "same_tool", "value": "clearance"}
        if margin < _LEAST_CLEARANCE:
            continue
        if margin < context.settings.operation_clearance - _near(context):
            told["operation_clearance"] = f"{math.floor((margin + _near(context)) * 1e3) / 1e3:g}"
        found.update(dict.fromkeys(rows, told))
    return found


def _near(context: ComparedContext) -> float:
    """How far a printed height may be off, mm."""
    return 4.0 * context.expected.max_tip_tolerance + 1e-6


def _passages(context: ComparedContext) -> Iterator[tuple[Sequence[int], float]]:
    """Yield motions without a CL point that lead from one operation to the next, and how far they stay above all CL
    points, mm; endless for a leg from home that needs no setting.
    """
    run, extra = context.run, context.matching.extra
    rows: Ints = np.array(extra, np.int64)
    across = set(approach_rows(run).tolist()) if len(rows) else set()
    for unbroken in np.split(rows, np.flatnonzero(np.diff(rows) != 1) + 1):
        if not len(unbroken) or unbroken[0] == 0 or unbroken[-1] + 1 >= len(run):
            continue
        # A block that repeats its position is no leg of the way.
        arrives = int(unbroken[-1]) + 1
        every = np.append(unbroken, arrives)
        *legs, down = every[~repeats_position(run, every)].tolist() or [arrives]
        if not 0 < len(legs) <= _MOST_ROWS:
            continue
        way = _Way(context, legs[0], down)
        if (len(legs) == 1 or _are_halves(run, legs)) and _comes_from_home(run, legs[0], across):
            # Whatever the settings: above all points a leg is harmless. A plane has first legs of its own.
            if (run.state.follows_at(np.array(legs))[0] or run.state.plane[legs[0]] < 0) and way.comes_down_from(
                context.highest_point(way.axis)
            ):
                yield unbroken.tolist(), math.inf
        elif _begins_operation(context, arrives) and (height := way.height) is not None:
            yield unbroken.tolist(), height - context.highest_point(way.axis)


def _are_halves(run: Run, legs: Sequence[int]) -> bool:
    """Whether two rows go across, one in X and the other in Y, whatever height they state."""
    across = sorted(int(run.programmed[row]) & _ACROSS for row in legs)
    return across == sorted((int(ProgrammedWord.X), int(ProgrammedWord.Y)))


def _comes_from_home(run: Run, row: int, across: Container[int]) -> bool:
    """Whether the tool was at home, or retracted by a word, before a row; in between rotary axes may turn, and it may
    go ``across`` as high as home.
    """
    before = row - 1
    while before >= 0 and (before in across or only_positions_rotary_axes(run, np.array([before]))[0]):
        before -= 1
    by_word = any(event.kind == "retract" and before < event.before_row <= row for event in run.events)
    return before < 0 or by_word or bool(run.state.machine_frame[before])


def without_retract(context: Context) -> Iterator[Place]:
    """Yield the first row of each operation to which the tool comes neither from home nor above all.

    One that never goes home, nor retracts by a word, may stay at the part. Where a definition says which axes a change
    of the tool needs at home, the machine does the rest.
    """
    if not isinstance(context, ComparedContext):
        return
    away = rows_away(context)
    if away is None:
        return
    lawful, to_repeat = passage_rows(context), settings_to_repeat(context)
    changes = [event.before_row for event in context.run.events if event.kind == "tool_change"]
    stated = "tool_change" in context.run.machine.home_at
    for last, first, operation in _bounds(context):
        begin, end = np.searchsorted(away, (last, first), side="right")
        between = range(last + 1, first)
        if end > begin or (stated and any(last < change <= first for change in changes)):
            continue
        if not (between and all(row in lawful for row in between)):
            fault = Wording("home", "goes_on", operation=operation)
            if between and all(row in to_repeat for row in between):
                fault = context.settings.repeated(fault, **to_repeat[between[0]])
            yield context.place(first, 0.0, fault)


def _bounds(context: ComparedContext) -> Iterator[tuple[int, int, str]]:
    """Yield the last row of each operation, the first of the next one with rows, and its name."""
    matching, expected = context.matching, context.expected
    holes = {hole.index: hole for hole in match_holes(context.run, expected)} if expected.holes else {}
    last: int | None = None
    for section, begin, end in zip(expected.sections, (0, *expected.hole_ends), expected.hole_ends, strict=False):
        first_pair, end_pair = matching.pair_range(section.first, section.end)
        rows = [matching.nc[first_pair], matching.nc[end_pair - 1]] if end_pair > first_pair else []
        own = [holes[index] for index in range(begin, end) if index in holes]
        rows += [row for hole in own for row in (hole.first, hole.end - 1)]
        if rows and last is not None:
            yield last, min(rows), section.operation.name
        last = max(rows, default=last)


def _begins_operation(context: ComparedContext, row: int) -> bool:
    """Whether a row goes to the first CL point of an operation that is not the first one."""
    matching: Matching = context.matching
    k = matching.nc.count_before(row)
    if not 0 < k < len(matching.nc) or matching.nc[k] != row:
        return False
    return context.expected.section_at(matching.cl[k]) is not context.expected.section_at(matching.cl[k - 1])


class _Way:
    """Rows ``first`` to ``down``, of which the last one goes to a CL point."""

    def __init__(self, context: ComparedContext, first: int, down: int) -> None:
        run: Run = context.run
        rows = np.arange(first, down + 1)
        self._near = _near(context)
        self._positions: RowPositions = run.positions(np.arange(first - 1, down + 1))
        self.axis: Floats = self._positions.axis[-1]
        turned = np.abs(self._positions.axis[1:] - self.axis).max() > _SAME_AXIS
        words = int(np.bitwise_or.reduce(run.programmed[rows])) & int(ROTARY_WORDS)
        moved = np.ptp(self._positions.joints[1:, list(run.machine.rotary)], axis=0).max() > _SAME_AXIS
        at_rapid = bool((run.kind[rows] == Kind.RAPID).all())
        self._is_free = at_rapid and not turned and not (words and moved) and not run.state.machine_frame.at(rows).any()

    def comes_down_from(self, height: float) -> bool:
        """Whether the last row goes straight down or ends at a height or above, as all before it do."""
        ends_above = bool(self._heights[-1] >= height - self._near)
        return (
            self._is_free
            and (ends_above or self._goes_down())
            and bool(self._heights[1:-1].min() >= height - self._near)
        )

    @property
    def height(self) -> float | None:
        """Where the first row goes straight up and the last one straight down, how high the tool stays in between."""
        up, *_ = self._steps
        aside = float(np.linalg.norm(up - float(up @ self.axis) * self.axis))
        same = np.abs(self._positions.axis[0] - self.axis).max() <= _SAME_AXIS
        starts_up = bool(aside <= self._near and float(up @ self.axis) >= -self._near and same)
        # One row may be all: the operations end and begin over one place, or at the height itself.
        return float(self._heights[1:-1].min()) if self._is_free and self._goes_down() and starts_up else None

    @property
    def _steps(self) -> Floats:
        return np.asarray(np.diff(self._positions.tip, axis=0))

    @property
    def _heights(self) -> Floats:
        return np.asarray(self._positions.tip @ self.axis)

    def _goes_down(self) -> bool:
        step = self._steps[-1]
        along = float(step @ self.axis)
        return along <= self._near and float(np.linalg.norm(step - along * self.axis)) <= self._near
