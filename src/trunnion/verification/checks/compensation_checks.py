"""Cutter radius compensation of a program against CUTCOM in the CL files."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.compensation.offsets import Fault
from trunnion.compensation.stretches import RegisterValue, Stretch
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.verification.checks.driven_path import DrivenPath, driven_path
from trunnion.verification.checks.matched_rows import first_wrong_pair
from trunnion.verification.context import ComparedContext, ExpectedValues, check_from_places
from trunnion.verification.expected.states import compensation_states
from trunnion.verification.results import Check, Place

#: An offset or a distance that is smaller is none, mm.
_SAME: Final = 1e-3

#: What the control makes of a path on which the tool does not fit.
_FAULTS: Final = {
    Fault.TIGHT: "tight", Fault.ON_CIRCLE: "on_circle", Fault.SHORT_ENTRY: "short_entry",
    Fault.NO_CONTOUR: "no_contour",
}  # fmt: skip
_SIDES: Final = {1: "left", -1: "right", 0: "off"}


def check_compensation(context: ComparedContext) -> Check:
    """Return the side and the register at every CL point, and no compensation on the way home."""
    run, matching = context.run, context.matching
    side = run.state.compensation
    states = compensation_states(context.expected)
    asked = {state.value.side for state in states} - {0}
    if not asked and set(side.distinct().tolist()) <= {0}:
        return Check("compensation", True, Wording("compensation", "none_asked"))
    places: list[Place] = []
    for state in states:
        pairs = matching.pair_range(state.first, state.end)
        side_wanted = state.value.side
        bad = first_wrong_pair(matching, *pairs, partial(_is_on_other_side, run, side_wanted))
        if bad is not None:
            row, cl = bad
            has, wanted = _side(int(side[row])), _side(side_wanted)
            said = Wording("compensation", "other_side", has=has, wanted=wanted)
            places.append(context.place_with_cl(row, 0.0, said, cl))
        register = state.value.register
        bad = first_wrong_pair(matching, *pairs, partial(_takes_other_radius, run, register)) if register else None
        if bad is not None:
            row, cl = bad
            radius = int(run.state.radius[row])
            said = Wording("compensation", "no_register", wanted=register)
            if radius:
                said = Wording("compensation", "other_register", has=radius, wanted=register)
            more = radius - register + context.settings.radius_offset
            said = context.settings.repeated(said, "radius_offset", more) if radius and more > 0 else said
            places.append(context.place_with_cl(row, 0.0, said, cl))
    home = run.state.machine_frame.rows_with(True)
    still_on = home[side.at(home) != 0]
    if len(still_on):
        places.append(context.place(int(still_on[0]), 0.0, Wording("compensation", "on_way_home")))
    driven = driven_path(context)
    places += _alarms(context, driven)
    if not places:
        places += _beside(context, driven)
    missing = driven.missing(context)
    sides = tuple(map(_side, sorted(asked or {0})))
    good = Wording("compensation", "sides" if missing else "sides_and_centre", sides=sides)
    check = check_from_places("compensation", sorted(places, key=lambda p: p.nc_line), good)
    return replace(check, missing=missing)


def _side(side: int) -> Wording:
    return Wording("compensation", _SIDES[side])


def _alarms(context: ComparedContext, driven: DrivenPath) -> Iterator[Place]:
    """Yield where the control stops with an alarm, or cuts into what it should leave."""
    for row, fault in driven.centre.faults:
        if fault in _FAULTS:
            yield context.place(row, 0.0, Wording("compensation", _FAULTS[fault]))


def _beside(context: ComparedContext, driven: DrivenPath) -> Iterator[Place]:
    """Yield the first motion of each stretch whose tool centre goes elsewhere than the CL file has it.

    What the settings let the program add to the radius (DR) is meant to be there, but for what makes a centre line of a
    contour.
    """
    for each in driven.stretches:
        if each.offset is None or each.wanted is None:
            continue
        off = each.offset - each.wanted
        if min(abs(off - added) for added in _meant(context.settings, each.wanted)) <= _SAME:
            continue
        if each.wanted:
            pair = context.matching.nc.count_before(each.stretch.first)
            row, cl = int(context.matching.nc[pair]), int(context.matching.cl[pair])
            said = Wording("compensation", "contour", offset=each.offset, radius=each.wanted)
            yield context.place_with_cl(row, abs(off), said, cl)
        else:
            yield from _off_centre_line(context, driven, each.stretch, each.offset)


def _meant(settings: ExpectedValues, wanted: float) -> set[float]:
    """Return what the program may add to the radius, mm."""
    meant = {0.0}
    if wanted or settings.register_holds is RegisterValue.DIFFERENCE:
        meant |= {value for word in ("DR", "TOFFR") for value in settings.tool_deltas.get(word, ())}
    return {value for value in meant if not wanted or value + wanted > _SAME}


def _off_centre_line(context: ComparedContext, driven: DrivenPath, stretch: Stretch, offset: float) -> Iterator[Place]:
    """Yield the first motion of a stretch that goes beside the points of the tool's centre."""
    centre, matching = driven.centre, context.matching
    pairs = matching.nc.count_before(stretch.first), matching.nc.count_before(stretch.end)
    if driven.is_unsure(stretch) and pairs[0] < pairs[1]:
        row, point = int(matching.nc[pairs[0]]), int(matching.cl[pairs[0]])
        said = Wording("compensation", "beside_elements", offset=offset)  # however it goes round corners
        yield context.place_with_cl(row, abs(offset), said, point)
        return
    for nc, cl in matching.pair_chunks(*pairs):
        tip = centre.run.positions(centre.row_of[nc]).tip
        off = np.linalg.norm(tip - context.expected.tip(cl), axis=1)
        far = np.flatnonzero(off > _SAME)
        if len(far):
            row, worst = int(nc[far[0]]), float(off.max())
            said = Wording("compensation", "centre_line", offset=offset, off=worst)
            yield context.place_with_cl(row, worst, said, int(cl[far[0]]))
            return


def _takes_other_radius(run: Run, register: int, nc: Ints) -> Flags:
    radius = run.state.radius.at(nc)
    return np.asarray((run.state.compensation.at(nc) != 0) & (radius >= 0) & (radius != register))


def _is_on_other_side(run: Run, side: int, nc: Ints) -> Flags:
    return np.asarray(run.state.compensation.at(nc) != side)
