"""Blocks that the operator may skip (``/``), and the OPSKIP of the CL file in which they stand.

In:     the run, of which every such block is an event, and the CL file.
Out:    the blocks without which the program would do something else than the CL file says; the levels of block skip
        that each OPSKIP has in the program; and those of which no block may be skipped.
"""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from trunnion.messages import Wording
from trunnion.model.run import RunEvent
from trunnion.model.toolpath import Kind
from trunnion.verification.context import ComparedContext
from trunnion.verification.expected.skipped import SkippedStretch, skipped_stretches
from trunnion.verification.matching.hole_matching import MatchedHole, match_holes
from trunnion.verification.results import Place


def skip_faults(context: ComparedContext) -> Iterator[Place]:
    """Yield the blocks with ``/`` that stand neither at nor between points or holes of an OPSKIP."""
    for event, stretches in _skipped_blocks(context):
        if not stretches:
            yield context.place_of_event(event, 0.0, Wording("stops", "skip_not_asked"))


def stretch_levels(context: ComparedContext) -> tuple[frozenset[int], ...]:
    """Return the levels of the blocks that stand in each OPSKIP, counted through all operations.

    A block without a motion between two of them belongs to the one that has its level, and else to both.
    """
    blocks = [
        (int(event.value), stretches)
        for event, stretches in _skipped_blocks(context)
        if isinstance(event.value, int | float)
    ]
    count = sum(len(list(skipped_stretches(section.operation))) for section in context.expected.sections)
    levels = [{level for level, stretches in blocks if stretches == [k]} for k in range(count)]
    for level, stretches in blocks:
        if not any(level in levels[k] for k in stretches):
            for k in stretches:
                levels[k].add(level)
    return tuple(map(frozenset, levels))


def lost_skips(context: ComparedContext, levels: Sequence[frozenset[int]]) -> dict[int, Place]:
    """Return the OPSKIP of which no block may be skipped, by their numbers: where the first of its blocks should be.

    levels  those that each has in the program
    """
    lost = {}
    for section, stretches in zip(context.expected.sections, _numbered(context), strict=True):
        for number, stretch in stretches:
            if not levels[number]:
                row = min(section.first + stretch.begin, section.end - 1)
                place = context.place_of_missing(row, Wording("stops", "skip_lost"))
                lost[number] = replace(place, cl_file=section.file, cl_line=stretch.first_line)
    return lost


def _skipped_blocks(context: ComparedContext) -> Iterator[tuple[RunEvent, list[int]]]:
    """Yield the blocks with ``/``, each with the numbers of the OPSKIP at, or between, whose points or holes it is."""
    events = [event for event in context.run.events if event.kind == "block_skip"]
    if not events:
        return
    of_sections = _numbered(context)
    regions, cl = _regions(context, of_sections), context.matching.cl
    holes = list(_holes(context))
    for event in events:
        pair = context.matching.nc.count_before(event.before_row)
        first = int(cl[pair - 1]) if pair else 0
        last = int(cl[pair]) if pair < len(cl) else len(context.expected)
        moves = event.before_row < len(context.run) and int(context.run.lines[event.before_row]) == event.line
        of_point = [k for k, (begin, end) in regions.items() if moves and pair < len(cl) and begin <= last < end]
        goes_there = pair < len(cl) and int(context.matching.nc[pair]) == event.before_row
        at = (_hole_below(context, holes, event.before_row), _hole_at(context, holes, event.before_row))
        found = (_stretch_of_hole(context, of_sections, hole.index) for hole in at if hole is not None)
        of_hole = next((stretches for stretches in found if stretches), [])
        own = of_point if goes_there and of_point else of_hole or of_point
        if own:
            yield event, own
            continue
        yield event, [k for k, (begin, end) in regions.items() if begin <= last and first + moves < end]


def _numbered(context: ComparedContext) -> list[list[tuple[int, SkippedStretch]]]:
    """Return the OPSKIP of each operation with their numbers, which go through all operations."""
    found, number = [], 0
    for section in context.expected.sections:
        stretches = list(skipped_stretches(section.operation))
        found.append(list(enumerate(stretches, number)))
        number += len(stretches)
    return found


def _regions(
    context: ComparedContext, of_sections: Sequence[Sequence[tuple[int, SkippedStretch]]]
) -> dict[int, tuple[int, int]]:
    """Return the points of the CL file that may be skipped, by OPSKIP: the first, and the one after the last."""
    return {
        number: (section.first + stretch.begin, section.first + stretch.end)
        for section, stretches in zip(context.expected.sections, of_sections, strict=True)
        for number, stretch in stretches
    }


def _holes(context: ComparedContext) -> Iterator[MatchedHole]:
    """Yield the rows of the holes that the CL file has."""
    return (each for each in match_holes(context.run, context.expected) if each.index < len(context.expected.holes))


def _hole_at(context: ComparedContext, holes: Sequence[MatchedHole], row: int) -> MatchedHole | None:
    """Return the hole at which a row is, or to which it leads from the hole before, with no CL point between them."""
    hole = next((hole for hole in holes if row < hole.end), None)
    count = context.matching.nc.count_before
    return hole if hole is not None and (hole.first <= row or count(row) == count(hole.first)) else None


def _hole_below(context: ComparedContext, holes: Sequence[MatchedHole], row: int) -> MatchedHole | None:
    """Return the hole that the tool has left, and above which it goes on at rapid up to a row and in it."""
    hole = next((hole for hole in reversed(holes) if hole.end <= row), None)
    if hole is None or row >= len(context.run):
        return None
    expected, rows = context.expected.holes[hole.index], np.arange(hole.end, row + 1)
    offset = context.run.tip[rows] - expected.tip
    height = offset @ expected.axis
    aside = float(np.abs(offset - height[:, None] * expected.axis).max())
    rises = bool((np.diff(height, prepend=-np.inf) > 0.0).all() and (context.run.kind[rows] == Kind.RAPID).all())
    return hole if rises and aside <= 2.0 * expected.tip_tolerance else None


def _stretch_of_hole(
    context: ComparedContext, of_sections: Sequence[Sequence[tuple[int, SkippedStretch]]], index: int
) -> list[int]:
    """Return the OPSKIP in which the statement of a hole stands, none where it is in none: holes are no rows."""
    line = context.expected.holes[index].line
    section = bisect_right(context.expected.hole_ends, index)
    return [number for number, each in of_sections[section] if each.first_line < line < each.end_line]
