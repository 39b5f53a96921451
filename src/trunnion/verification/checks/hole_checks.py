"""The holes of a program against the cycles of the CL files."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.messages import Wording, phrase
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.verification.checks.drill_motions import HoleFault
from trunnion.verification.checks.hole_faults import drill_motions, hole_faults
from trunnion.verification.checks.peck_faults import odd_lifts
from trunnion.verification.checks.tool_checks import length_fault, tool_fault
from trunnion.verification.context import ComparedContext, Faults
from trunnion.verification.expected.holes import Hole
from trunnion.verification.expected.spindle_and_tool import names_tool
from trunnion.verification.matching.hole_approaches import clearance_between_holes
from trunnion.verification.matching.hole_matching import MatchedHole, match_holes
from trunnion.verification.matching.pairs import Matching
from trunnion.verification.results import Check, Place

#: A way from hole to hole is level, or along the axis, when it is off by no more than this, mm.
_SLANT: Final = 0.05

#: The tool axis stands still when no component changes by more than this.
_SAME_AXIS: Final = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class _Drilled:
    """A hole of the CL file, and the rows that drill it."""

    hole: Hole
    match: MatchedHole


def check_holes(context: ComparedContext) -> Check:
    """Every hole of the CL file is drilled as its cycle asks, in its turn between the points; and no other holes."""
    run, expected = context.run, context.expected
    matches = match_holes(run, expected)
    by_index = {match.index: match for match in matches}
    dwells = _dwells_by_row(run)
    work = {each.first: each.work for each in run.spindle_holes}
    found = Faults()
    before: _Drilled | None = None
    for index, hole in enumerate(expected.holes):
        match = by_index.get(index)
        if match is None:
            found.add(Place(context.last_line, -1, 0.0, Wording("holes", "nothing_drills"), hole.file, hole.line))
            continue
        hole = _as_it_may_feed(context, hole)
        drilled = _Drilled(hole, match)
        faults = list(hole_faults(run, hole, match, dwells, work, _clearance_on_the_way(context, before, drilled)))
        faults += _faults_around(context, drilled)
        faults += _slanted_rapids(context, before, drilled)
        before = drilled
        for fault in faults:
            at = context.place(fault.row, fault.value, fault.said)
            found.add(replace(at, cl_file=hole.file, cl_line=hole.line))
    found.add(*_floating_threads(context, by_index))
    for match in (match for match in matches if match.index >= len(expected.holes)):
        found.add(context.place(match.first, 0.0, Wording("holes", "no_more")))
    good = Wording("holes", "good", count=len(matches)) if matches else Wording("holes", "none_asked")
    if by_motion := sum(match.by_motion for match in matches):
        good = Wording("holes", "some_by_motion", count=len(matches), by_motion=by_motion)
    check = found.check("holes", good)
    values = tuple(_unasked_values(context, by_index))
    return replace(check, missing=(phrase("unasked_values", values=values),)) if values else check


def _unasked_values(context: ComparedContext, matches: Mapping[int, MatchedHole]) -> Iterator[Wording]:
    """Yield what no CL file says of pecks and ``post`` writes otherwise: how far the tool lifts, where it feeds on."""
    run = context.run
    rows = dict[str, int]()
    for event in run.events:
        if event.kind == "cycle_value":
            rows.setdefault(str(event.value), min(event.before_row, len(run) - 1))
    for value, row in rows.items():
        yield phrase("unasked_value", value=value, block=context.block_name(row))
    lifts = dict[float, int]()
    for index, hole in enumerate(context.expected.holes):
        if (match := matches.get(index)) is None or not match.by_motion:
            continue
        for row, lift in odd_lifts(hole, drill_motions(run, hole, match)):
            lifts.setdefault(round(lift, 3), row)
    for lift, row in lifts.items():
        yield phrase("unasked_lift", lift=lift, block=context.block_name(row))


def _floating_threads(context: ComparedContext, matches: Mapping[int, MatchedHole]) -> Iterator[Place]:
    """Threads for a tap that is held rigidly, in a series of holes that no word for that begins."""
    code = context.settings.rigid_tap
    if code is None:
        return
    words = [event.before_row for event in context.run.events if event.kind == "m" and event.value == code]
    before, rigid = 0, False
    for index, match in sorted(matches.items()):
        if index >= len(context.expected.holes):
            continue
        hole = context.expected.holes[index]
        if any(before <= row <= match.first + 1 for row in words):
            rigid = True
        elif match.first > before:
            rigid = False
        if hole.cycle.mode[:1] == ("TAP",) and not (hole.cycle.floating or rigid or match.by_motion):
            place = context.place(match.first, 0.0, Wording("holes", "chuck", code=code))
            yield replace(place, cl_file=hole.file, cl_line=hole.line)
        before = match.end


def _dwells_by_row(run: Run) -> dict[int, list[float]]:
    """Dwells before each row, in seconds, or spindle revolutions if negative."""
    dwells: dict[int, list[float]] = {}
    for event in run.events:
        if event.kind == "dwell" and isinstance(event.value, float):
            dwells.setdefault(event.before_row, []).append(event.value)
    return dwells


def _as_it_may_feed(context: ComparedContext, hole: Hole) -> Hole:
    """Return a hole whose cycle has the feed that stands for rapids with the next lower one, which programs write."""
    settings = context.settings
    if settings.below_rapid_feed is None or settings.rapid_feed is None or hole.cycle.feed != settings.rapid_feed:
        return hole
    return replace(hole, feed_tolerance=max(hole.feed_tolerance, settings.rapid_feed - settings.below_rapid_feed))


def _clearance_on_the_way(context: ComparedContext, before: _Drilled | None, now: _Drilled) -> float | None:
    """As ``clearance_between_holes``, if the tool goes from hole to hole without a CL point between them."""
    if before is None or _has_pair_between(context.matching, before.match.end, now.match.first):
        return None
    return clearance_between_holes(context.run, before.hole, before.match, now.hole, now.match)


def _slanted_rapids(context: ComparedContext, before: _Drilled | None, now: _Drilled) -> Iterator[HoleFault]:
    """Yield a rapid that goes sideways and down at once from one hole to the next, which motions of the program drill.

    The CL file wants the tool at RTRCTO until it stands above the next hole: clamps may be between them.
    """
    if before is None or not now.match.by_motion:
        return
    if _has_pair_between(context.matching, before.match.end, now.match.first):
        return
    rows = np.arange(before.match.end, now.match.first + 1)
    if not len(rows) or context.run.state.machine_frame.at(rows).any():
        return  # from home the tool comes down as to a first hole
    positions = context.run.positions(np.append(before.match.end - 1, rows))
    steps, axis = np.diff(positions.tip, axis=0), now.hole.axis
    rise = steps @ axis
    aside = np.linalg.norm(steps - rise[:, None] * axis, axis=1)
    still = np.abs(np.diff(positions.axis, axis=0)).max(axis=1) <= _SAME_AXIS
    slanted = still & (rise < -_SLANT) & (aside > _SLANT)
    for k in np.flatnonzero(slanted)[:1].tolist():
        side, down = float(aside[k]), -float(rise[k])
        yield HoleFault(int(rows[k]), side, Wording("holes", "slanted", aside=side, down=down))


def _has_pair_between(matching: Matching, first: int, last: int) -> bool:
    return matching.nc.count_before(last + 1) > matching.nc.count_before(first)


def _faults_around(context: ComparedContext, drilled: _Drilled) -> Iterator[HoleFault]:
    """Yield a wrong tool or tool length, and a hole that is drilled out of its turn."""
    run, matching = context.run, context.matching
    hole, row = drilled.hole, drilled.match.first
    names = hole.tool_names
    has = run.tools[run.state.tool[row]]
    if names and not names_tool(has, names):
        yield HoleFault(row, 0.0, tool_fault(has, names))
    numbers = hole.length_numbers if run.uses_length_numbers else ()
    if numbers and (number := int(run.state.edge[row])) not in numbers:
        yield HoleFault(row, 0.0, length_fault(number, numbers))
    k = matching.cl.count_before(hole.row)
    first = row + drilled.match.shares_first_row
    end = drilled.match.end - drilled.match.shares_last_row
    if (k and matching.nc[k - 1] >= first) or (k < len(matching.nc) and matching.nc[k] < end):
        yield HoleFault(row, 0.0, Wording("holes", "out_of_turn"))
