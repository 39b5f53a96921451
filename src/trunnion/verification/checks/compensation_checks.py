"""Cutter radius compensation of a program against CUTCOM in the CL files."""

from functools import partial
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.model.run import Run
from trunnion.verification.checks.matched_rows import first_wrong_pair
from trunnion.verification.context import ComparedContext, check_from_places
from trunnion.verification.expected.states import compensation_states
from trunnion.verification.results import Check, Place

_TITLE: Final = "radius compensation as the CL file says"
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
            places.append(context.place_with_cl(row, 0.0, text, cl))
    home = run.state.machine_frame.rows_with(True)
    still_on = home[side.at(home) != 0]
    if len(still_on):
        places.append(context.place(int(still_on[0]), 0.0, "moves home with radius compensation on"))
    good = ", ".join(_SIDES[value] for value in sorted(asked))
    return check_from_places("compensation", _TITLE, sorted(places, key=lambda p: p.nc_line), good or "off")


def _takes_other_radius(run: Run, register: int, nc: Ints) -> Flags:
    radius = run.state.radius.at(nc)
    return np.asarray((run.state.compensation.at(nc) != 0) & (radius >= 0) & (radius != register))


def _is_on_other_side(run: Run, side: int, nc: Ints) -> Flags:
    return np.asarray(run.state.compensation.at(nc) != side)
