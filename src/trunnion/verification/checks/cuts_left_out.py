"""Cuts that a program does not make although it comes to both their ends: it leaves the path between them.

In:     a program with the motions that go to CL points.
Out:    places at which it goes away from a point, and at a feed straight on to the next.

Motions home, turns of rotary axes and words that retract the tool go to no CL point, so the ends alone do not show
them. They do no harm where the tool comes back to the point that it has left, goes on at rapid, or begins an operation.
"""

from collections.abc import Collection, Iterator

import numpy as np

from trunnion.arrays import Flags
from trunnion.messages import Wording
from trunnion.model.programmed_words import POSITION_WORDS
from trunnion.model.run import RunEvent
from trunnion.model.toolpath import Kind
from trunnion.verification.context import ComparedContext
from trunnion.verification.kinematics.machine_positions import MachinePositions
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.results import Place
from trunnion.wording import position


def cuts_left_out(context: ComparedContext, told: Collection[int]) -> Iterator[Place]:
    """Yield where the program leaves the path in a cut and does not come back to where it left it.

    told  rows that are faults themselves, or lead safely past blocks that may be skipped
    """
    run = context.run
    gaps = np.flatnonzero(np.diff(_leads_nowhere(context), prepend=False, append=False)).reshape(-1, 2).tolist()
    retracts = {event.before_row: event for event in run.events if event.kind == "retract"}
    inside = {row for first, end in gaps for row in range(first, end + 1)}
    gaps += [[row, row] for row in retracts if row not in inside]
    for first, end in sorted(gaps):
        if first == 0 or end >= len(run) or any(row in told for row in range(first, end)):
            continue
        cl = _cl_row(context, end)
        if cl is None or cl in context.expected.first_rows or context.expected.point(cl).kind is Kind.RAPID:
            continue
        if context.expected.insert_counts.get(cl, 0) >= max(end - first, 1):  # the CL file itself leaves here
            continue
        words = [retracts[row] for row in range(first, end + 1) if row in retracts]
        if not _is_back(context, first, end, words):
            left, wanted = run.positions(np.array([first - 1])).tip[0], context.expected.point(cl).tip
            block, places = context.block_name(end), {"left": position(left), "wanted": position(wanted)}
            said = Wording("order", "cut_left_out", block=block, **places)
            by_word = words and words[0].before_row == first
            place = context.place_of_event(words[0], 0.0, said) if by_word else context.place(first, 0.0, said)
            yield context.at_cl_row(place, cl)


def _leads_nowhere(context: ComparedContext) -> Flags:
    """Return which motions lead to no CL point and drill no hole, (n,) bool."""
    run, matching, expected = context.run, context.matching, context.expected
    found = np.ones(len(run), np.bool_)
    for first, count in matching.nc.ranges(0, len(matching.nc)):
        found[first : first + count] = False
    found[matching.intermediate[0]] = False
    for segments in matching.arc_segments:
        found[segments.nc] = False
    for spline in expected.written_splines:
        found[spline.first : spline.last + 1] = False
    for hole in match_holes(run, expected):
        found[hole.first : hole.end] = False
    return found


def _cl_row(context: ComparedContext, row: int) -> int | None:
    """Return the CL row to which a row leads; None if it leads to a hole."""
    matching = context.matching
    for spline in context.expected.written_splines:
        row = spline.last if spline.first <= row <= spline.last else row
    if row in matching.nc:
        return matching.cl[matching.nc.count_before(row)]
    nc, cl = matching.intermediate
    k = int(np.searchsorted(nc, row))
    if k < len(nc) and nc[k] == row:
        return int(cl[k])
    return next((segments.cl for segments in matching.arc_segments if row in segments.nc), None)


def _is_back(context: ComparedContext, first: int, end: int, retracts: list[RunEvent]) -> bool:
    """Whether the tool is where it was before row ``first`` when row ``end`` begins."""
    run, tolerance = context.run, context.expected.max_tip_tolerance
    stated = run.state.machine_frame.part(first, end)
    stated = ~stated & ((run.programmed[first:end] & int(POSITION_WORDS)) != 0)
    last = max((event.before_row for event in retracts), default=first)
    if retracts and not stated[last - first :].any():  # how far a word goes need not be known
        return False
    machine_positions = MachinePositions.of(run)
    slides = list(run.machine.linear)
    if not machine_positions.known and machine_positions.at(np.array([end - 1]))[0, slides].any():
        return False
    tip = run.positions(np.array([first - 1, end - 1])).tip
    return bool((np.abs(tip[1] - tip[0]) <= 4.0 * tolerance + 1e-6).all())  # both are rounded, and tilted
