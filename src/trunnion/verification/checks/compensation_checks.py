"""Cutter radius compensation of a program against CUTCOM in the CL files."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.compensation.offsets import Fault
from trunnion.compensation.stretches import RegisterValue, Stretch
from trunnion.model.run import Run
from trunnion.verification.checks.driven_path import DrivenPath, driven_path
from trunnion.verification.checks.matched_rows import first_wrong_pair
from trunnion.verification.context import ComparedContext, ExpectedValues, check_from_places
from trunnion.verification.expected.states import compensation_states
from trunnion.verification.results import Check, Place

_TITLE: Final = "radius compensation as the CL file says"

#: An offset or a distance that is smaller is none, mm.
_SAME: Final = 1e-3

#: What the control makes of a path on which the tool does not fit.
_FAULTS: Final = {
    Fault.TIGHT: "the tool does not fit: the control stops with an alarm, or cuts into the part",
    Fault.ON_CIRCLE: "radius compensation begins or ends on a circle: the control stops with an alarm",
    Fault.SHORT_ENTRY: "the line on which compensation begins is no longer than the radius: the control stops",
    Fault.NO_CONTOUR: "radius compensation begins and ends with no motion between: where the tool goes is not known",
}
#: What is wrong where the register holds the other value than the points of the CL file ask for.
_CENTRE_LINE: Final = (
    "the control compensates by {offset:.3f} mm, and the points of the CL file are those of the tool's centre: it goes"
    " up to {off:.3f} mm beside them; the register must hold the difference (radius_register=difference)"
)
#: The same where only this is known: along its elements the tool is beside the path, however it goes round corners.
_BESIDE_ELEMENTS: Final = (
    "the control compensates by {offset:.3f} mm, and the points of the CL file are those of the tool's centre: it goes"
    " that far beside them, whatever it does at corners; the register must hold the difference"
    " (radius_register=difference)"
)
_CONTOUR: Final = (
    "the control compensates by {offset:.3f} mm, and the points of the CL file are those of the contour, which the tool"
    " would cut into: its centre must go {radius:.3f} mm beside them; the register must hold the radius"
    " (radius_register=radius)"
)
_SIDES: Final = {1: "left of the path", -1: "right of the path", 0: "off"}


def check_compensation(context: ComparedContext) -> Check:
    """Return the side and the register at every CL point, and no compensation on the way home."""
    run, matching = context.run, context.matching
    side = run.state.compensation
    states = compensation_states(context.expected)
    asked = {state.value.side for state in states} - {0}
    if not asked and set(side.distinct().tolist()) <= {0}:
        return Check("compensation", _TITLE, True, "the CL file asks for none")
    places: list[Place] = []
    for state in states:
        pairs = matching.pair_range(state.first, state.end)
        side_wanted = state.value.side
        bad = first_wrong_pair(matching, *pairs, partial(_is_on_other_side, run, side_wanted))
        if bad is not None:
            row, cl = bad
            text = f"radius compensation is {_SIDES[int(side[row])]}; the CL file wants it {_SIDES[side_wanted]}"
            places.append(context.place_with_cl(row, 0.0, text, cl))
        register = state.value.register
        bad = first_wrong_pair(matching, *pairs, partial(_takes_other_radius, run, register)) if register else None
        if bad is not None:
            row, cl = bad
            has = run.state.radius[row]
            text = f"radius compensation works {f'with D{has}' if has else 'without D'}; the CL file wants D{register}"
            more = int(has) - register + context.settings.radius_offset
            repeat = context.settings.repeat("radius_offset", more) if has and more > 0 else ""
            places.append(context.place_with_cl(row, 0.0, text + repeat, cl))
    home = run.state.machine_frame.rows_with(True)
    still_on = home[side.at(home) != 0]
    if len(still_on):
        places.append(context.place(int(still_on[0]), 0.0, "moves home with radius compensation on"))
    driven = driven_path(context)
    places += _alarms(context, driven)
    if not places:
        places += _beside(context, driven)
    good = ", ".join(_SIDES[value] for value in sorted(asked)) or "off"
    if not (missing := driven.missing(context)):
        good = f"{good}; the tool centre goes where the CL file has it"
    check = check_from_places("compensation", _TITLE, sorted(places, key=lambda p: p.nc_line), good)
    return replace(check, missing=missing)


def _alarms(context: ComparedContext, driven: DrivenPath) -> Iterator[Place]:
    """Yield where the control stops with an alarm, or cuts into what it should leave."""
    for row, fault in driven.centre.faults:
        if fault in _FAULTS:
            yield context.place(row, 0.0, _FAULTS[fault])


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
            yield context.place_with_cl(row, abs(off), _CONTOUR.format(offset=each.offset, radius=each.wanted), cl)
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
        yield context.place_with_cl(row, abs(offset), _BESIDE_ELEMENTS.format(offset=offset), point)
        return
    for nc, cl in matching.pair_chunks(*pairs):
        tip = centre.run.positions(centre.row_of[nc]).tip
        off = np.linalg.norm(tip - context.expected.tip(cl), axis=1)
        far = np.flatnonzero(off > _SAME)
        if len(far):
            row, worst = int(nc[far[0]]), float(off.max())
            yield context.place_with_cl(row, worst, _CENTRE_LINE.format(offset=offset, off=worst), int(cl[far[0]]))
            return


def _takes_other_radius(run: Run, register: int, nc: Ints) -> Flags:
    radius = run.state.radius.at(nc)
    return np.asarray((run.state.compensation.at(nc) != 0) & (radius >= 0) & (radius != register))


def _is_on_other_side(run: Run, side: int, nc: Ints) -> Flags:
    return np.asarray(run.state.compensation.at(nc) != side)
