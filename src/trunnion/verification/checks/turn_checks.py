"""Turns and planes in a safe order: retract, plane off, turn, plane on, approach.

Rotary axes that are placed without TCP take the part, or the tool, out of the place that the program speaks of. So they
turn only while the tool is drawn back, and in no plane that they would make untrue; and no plane is left on where the
tool changes or the program ends. Who wrote the blocks does not matter, nor which side the rotary axes move.
"""

from dataclasses import dataclass

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.model.run import ProgrammedWord, Run, RunEvent
from trunnion.model.toolpath import Kind
from trunnion.verification.context import MAX_PLACES, Context, check_from_places
from trunnion.verification.matching.path_matching import CHUNK, POSITION_WORDS, only_positions_rotary_axes
from trunnion.verification.results import Check, Place

#: Rotary motion below this, degrees, is none.
_TURNED = 1e-3

#: Home is met within this, mm.
_HOME = 1e-6

_TURNS = ProgrammedWord.FIRST | ProgrammedWord.SECOND


def turns(context: Context) -> Check:
    """Rotary axes turn away from the part and in no plane; planes are off where tools change and programs end."""
    planes = _planes(context.run)
    places = (
        _at_the_part(context) + _in_a_plane(context, planes) + _left_on(context, planes) + _without_a_plane(context)
    )
    places.sort(key=lambda place: place.nc_line)
    on = sum(plane.on for plane in planes)
    good = "rotary axes turn away from the part" + (
        f"; {on} tilted planes, each off before the next turn" if on else ""
    )
    return check_from_places("turns", "turns and planes in a safe order", places, good)


@dataclass(frozen=True, slots=True)
class _Plane:
    """From a happening on, a tilted plane is on or off; ``shifted``: frames move the zero without turning it."""

    event: RunEvent
    on: bool
    shifted: bool


def _planes(run: Run) -> list[_Plane]:
    """What CYCLE800, G68.2 and the frame words of a program switch on and off."""
    found: list[_Plane] = []
    swivelled = turned = shifted = False
    for event in run.events:
        if event.kind == "cycle800":
            values = str(event.value).split(",")
            swivelled = bool(event.value) and values[1:2] != ['"0"']
            turned = shifted = False
        elif event.kind == "tilt":
            swivelled, turned, shifted = bool(event.value), False, False
        elif event.kind == "frame":
            word = str(event.value)
            adds = word.startswith("A")
            turned = "ROT" in word or (turned and adds)
            shifted = word != "" and (not turned or adds)
        else:
            continue
        found.append(_Plane(event, swivelled or turned, shifted))
    return found


def _placing(run: Run) -> Ints:
    """Rows that do nothing but turn rotary axes at rapid, TCP off, in the workpiece's frame."""
    state = run.state
    found = []
    for start in range(0, len(run), CHUNK):
        end = min(start + CHUNK, len(run))
        bits = run.programmed[start:end]
        here = ((bits & int(POSITION_WORDS)) == 0) & ((bits & int(_TURNS)) != 0) & (run.kind[start:end] == Kind.RAPID)
        here &= ~state.tcp.part(start, end) & ~state.machine_frame.part(start, end)
        found.append(start + np.flatnonzero(here))
    return np.concatenate(found) if found else np.zeros(0, np.int64)


def _turning(run: Run, rows: Ints) -> Flags:
    """Which rows, none of them the first, move a rotary axis."""
    columns = list(run.machine.rotary)
    before, after = run.positions(rows - 1).joints[:, columns], run.positions(rows).joints[:, columns]
    return np.asarray((np.abs(after - before) > _TURNED).any(axis=1))


def _at_the_part(context: Context) -> list[Place]:
    """Turns for which the tool was not drawn back: to the home of the slide along the spindle, or by a word for it.

    The CL file itself may have drawn it back, if it turns the tool axis at rapid there. A program that never goes home
    has positions of its own, which nobody can judge without a CL file.
    """
    run, machine = context.run, context.run.machine
    along = max(machine.linear, key=lambda k: abs(np.dot(machine.axes[k].direction, machine.spindle_direction)))
    home = float(machine.home[along])
    retracts = np.array([event.before_row for event in run.events if event.kind == "retract"], np.int64)
    frame = run.state.machine_frame.rows_with(True)
    frame = frame[~np.isin(frame, retracts)]
    goes_home = len(frame) > 0 and bool((np.abs(run.positions(frame).joints[:, along] - home) <= _HOME).any())
    if not goes_home and not (len(retracts) and context.matching is not None):
        return []
    placing = _placing(run)
    rows = placing[placing > 0]
    rows = rows[_turning(run, rows)]
    every = set(placing.tolist())
    places = []
    for row in rows.tolist():
        before = row - 1
        while before in every:
            before -= 1
        if before < 0 or _drawn_back(run, retracts, before, row) or _asked_for(context, before):
            continue
        slide = float(run.positions(np.array([before])).joints[0, along])
        if not run.state.machine_frame[before] or abs(slide - home) > _HOME:
            name = machine.axes[along].name
            text = f"turns a rotary axis while the tool is at the part: go home in {name} first"
            places.append(context.place(row, 0.0, text))
    return places[:MAX_PLACES]


def _drawn_back(run: Run, retracts: Ints, before: int, row: int) -> bool:
    """Whether a word for it has drawn the tool back between two rows; where that is a motion, it is ``before``."""
    first = before if run.state.machine_frame[before] else before + 1
    return bool(((retracts >= first) & (retracts <= row)).any())


def _asked_for(context: Context, row: int) -> bool:
    """Whether a row answers to a CL point at rapid, from which the CL file goes on at rapid under another tool axis."""
    expected, matching = context.expected, context.matching
    if expected is None or matching is None or row not in matching.nc:
        return False
    cl = matching.cl[matching.nc.before(row)]
    if cl + 1 >= expected.section_at(cl).end:
        return False
    here, there = expected.point(cl), expected.point(cl + 1)
    return here.kind is Kind.RAPID and there.kind is Kind.RAPID and bool((here.axis != there.axis).any())


def _in_a_plane(context: Context, planes: list[_Plane]) -> list[Place]:
    """Rotary axes that are turned without TCP in a plane, which holds for one rotary position only."""
    run = context.run
    places = []
    for k, plane in enumerate(planes):
        if not plane.on:
            continue
        first = max(plane.event.before_row, 1)
        end = planes[k + 1].event.before_row if k + 1 < len(planes) else len(run)
        rows = first + np.flatnonzero((run.programmed[first:end] & int(_TURNS)) != 0)
        rows = rows[~run.state.tcp.at(rows)]
        for row in rows[_turning(run, rows)].tolist():
            own = run.lines[row] == plane.event.line and run.state.file[row] == plane.event.file
            if not (own and row == plane.event.before_row):
                text = "turns a rotary axis in a tilted plane: switch the plane off first"
                places.append(context.place(row, 0.0, text))
    return places[:MAX_PLACES]


def _without_a_plane(context: Context) -> list[Place]:
    """Work under turned rotary axes with neither TCP nor a plane: where it is depends on the workpiece zero.

    Only where the zero is known can the tip be compared at all; otherwise a plane that was never switched on would not
    be missed wherever the zero is taken to lie on the rotary axes.
    """
    run, matching = context.run, context.matching
    if matching is None or run.machine.workpiece_zero is not None:
        return []
    places: list[Place] = []
    for nc, cl in matching.pair_chunks():
        turned = ~run.state.xyz_is_tip.at(nc)
        if not turned.any():  # with TCP, as most are
            continue
        # Whole turns stand everything where it stood.
        turned &= (np.abs(run.rotary[nc] - 360.0 * np.rint(run.rotary[nc] / 360.0)) > _TURNED).any(axis=1)
        turned &= ~only_positions_rotary_axes(run, nc)  # on the way from plane to plane
        for k in np.flatnonzero(turned)[: MAX_PLACES - len(places)].tolist():
            text = "works under turned rotary axes with TCP off and in no plane: say where the workpiece zero is (zero)"
            places.append(context.place(int(nc[k]), 0.0, text, int(cl[k])))
    return places


def _left_on(context: Context, planes: list[_Plane]) -> list[Place]:
    """Changes of the tool, and ends of the program, in a plane or with the zero shifted."""
    places = []
    order = {id(event): n for n, event in enumerate(context.run.events)}
    for event in context.run.events:
        if event.kind not in ("tool_change", "end"):
            continue
        last = next((plane for plane in reversed(planes) if order[id(plane.event)] < order[id(event)]), None)
        if last is not None and (last.on or last.shifted):
            what = "changes the tool" if event.kind == "tool_change" else "ends the program"
            state = "in a tilted plane" if last.on else "with a frame on"
            places.append(context.at(event, 0.0, f"{what} {state}, which was switched on in line {last.event.line}"))
    return places[:MAX_PLACES]
