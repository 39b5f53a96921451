"""Rotary positioning and tilted planes in a safe order: retract, plane off, turn, plane on, approach.

Rotary axes that are positioned without TCP take the part, or the tool, away from the position that the program refers
to. So they may turn only while the tool is retracted, and in no plane that they would invalidate; and no plane may be
on where the tool is changed or the program ends. It does not matter who wrote the blocks, nor on which side the rotary
axes are.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.model.run import Run, RunEvent
from trunnion.model.toolpath import Kind
from trunnion.verification.checks.home_checks import HOME_TOLERANCE
from trunnion.verification.context import MAX_PLACES, ComparedContext, Context, check_from_places
from trunnion.verification.kinematics.positioning_moves import (
    ROTARY_WORDS,
    only_positions_rotary_axes,
    rotary_positioning_flags,
)
from trunnion.verification.results import Check, Place
from trunnion.verification.row_ranges import chunk_bounds

#: Smaller rotary motion, degrees, is none.
_STILL: Final = 1e-3


@dataclass(frozen=True, slots=True)
class _PlaneChange:
    """An event after which a tilted plane is on or off; ``shifted``: frames shift the zero without rotating it."""

    event: RunEvent
    on: bool
    shifted: bool


def check_turns(context: Context) -> Check:
    """Rotary axes turn away from the part and in no plane; planes are off at tool changes and at the end."""
    changes = _plane_changes(context.run)
    places = _turns_at_the_part(context) + _turns_in_a_plane(context, changes)
    places += list(_planes_left_on(context, changes))[:MAX_PLACES]
    places += _turned_without_plane(context) if isinstance(context, ComparedContext) else []
    places.sort(key=lambda place: place.nc_line)
    on = sum(change.on for change in changes)
    good = "rotary axes turn away from the part" + (
        f"; {on} tilted planes, each off before the next turn" if on else ""
    )
    return check_from_places("turns", "turns and planes in a safe order", places, good)


def _plane_changes(run: Run) -> list[_PlaneChange]:
    """What CYCLE800, G68.2 and frame words switch on and off."""
    found: list[_PlaneChange] = []
    tilted = rotated = shifted = False
    for event in run.events:
        if event.kind == "cycle800":
            values = str(event.value).split(",")
            tilted = bool(event.value) and values[1:2] != ['"0"']
            rotated = shifted = False
        elif event.kind == "tilt":
            tilted, rotated, shifted = bool(event.value), False, False
        elif event.kind == "frame":
            word = str(event.value)
            adds = word.startswith("A")
            rotated = "ROT" in word or (rotated and adds)
            shifted = word != "" and (not rotated or adds)
        else:
            continue
        found.append(_PlaneChange(event, tilted or rotated, shifted))
    return found


def _positioning_rows(run: Run) -> Ints:
    """Rows in the workpiece frame that only position rotary axes, at rapid with TCP off."""
    found = [np.zeros(0, np.int64)]
    for start, end in chunk_bounds(len(run)):
        here = rotary_positioning_flags(run, start, end) & ~run.state.machine_frame.part(start, end)
        found.append(start + np.flatnonzero(here))
    return np.concatenate(found)


def _turn_flags(run: Run, rows: Ints) -> Flags:
    """Which rows, not counting the first of the run, move a rotary axis, (k,) bool."""
    columns = list(run.machine.rotary)
    before, after = run.positions(rows - 1).joints[:, columns], run.positions(rows).joints[:, columns]
    return np.asarray((np.abs(after - before) > _STILL).any(axis=1))


def _turns_at_the_part(context: Context) -> list[Place]:
    """Turns for which the tool was not retracted: to the home of the slide along the spindle, or by a word for it.

    The CL file itself may have retracted the tool, if it turns the tool axis at rapid there. A program that never goes
    home has positions of its own, which are not judged without a CL file.
    """
    run, machine = context.run, context.run.machine
    along = max(machine.linear, key=lambda k: abs(np.dot(machine.axes[k].direction, machine.spindle_direction)))
    home = float(machine.home[along])
    retracts = np.array([event.before_row for event in run.events if event.kind == "retract"], np.int64)
    frame = run.state.machine_frame.rows_with(True)
    frame = frame[~np.isin(frame, retracts)]
    goes_home = len(frame) > 0 and bool((np.abs(run.positions(frame).joints[:, along] - home) <= HOME_TOLERANCE).any())
    if not goes_home and not (len(retracts) and isinstance(context, ComparedContext)):
        return []
    positioning = _positioning_rows(run)
    rows = positioning[positioning > 0]
    rows = rows[_turn_flags(run, rows)]
    every = set(positioning.tolist())
    places = []
    for row in rows.tolist():
        before = row - 1
        while before in every:
            before -= 1
        if before < 0 or _is_retracted(run, retracts, before, row) or _is_turn_of_cl_file(context, before):
            continue
        slide = float(run.positions(np.array([before])).joints[0, along])
        if not run.state.machine_frame[before] or abs(slide - home) > HOME_TOLERANCE:
            name = machine.axes[along].name
            text = f"turns a rotary axis while the tool is at the part: go home in {name} first"
            places.append(context.place(row, 0.0, text))
    return places[:MAX_PLACES]


def _is_retracted(run: Run, retracts: Ints, before: int, row: int) -> bool:
    """Whether a word has retracted the tool between two rows; if that word is a motion, it is ``before``."""
    first = before if run.state.machine_frame[before] else before + 1
    return bool(((retracts >= first) & (retracts <= row)).any())


def _is_turn_of_cl_file(context: Context, row: int) -> bool:
    """Whether a row goes to a CL point at rapid from which the CL file goes on at rapid with another tool axis."""
    if not isinstance(context, ComparedContext) or row not in context.matching.nc:
        return False
    expected, matching = context.expected, context.matching
    cl = matching.cl[matching.nc.count_before(row)]
    if cl + 1 >= expected.section_at(cl).end:
        return False
    point, following = expected.point(cl), expected.point(cl + 1)
    at_rapid = point.kind is Kind.RAPID and following.kind is Kind.RAPID
    return at_rapid and bool((point.axis != following.axis).any())


def _turns_in_a_plane(context: Context, changes: list[_PlaneChange]) -> list[Place]:
    """Rotary axes that turn without TCP in a plane, which holds for one rotary position only."""
    run = context.run
    places = []
    for k, change in enumerate(changes):
        if not change.on:
            continue
        event = change.event
        first = max(event.before_row, 1)
        end = changes[k + 1].event.before_row if k + 1 < len(changes) else len(run)
        rows = first + np.flatnonzero((run.programmed[first:end] & int(ROTARY_WORDS)) != 0)
        rows = rows[~run.state.tcp.at(rows)]
        for row in rows[_turn_flags(run, rows)].tolist():
            same_block = run.lines[row] == event.line and run.state.file[row] == event.file
            if not (same_block and row == event.before_row):
                text = "turns a rotary axis in a tilted plane: switch the plane off first"
                places.append(context.place(row, 0.0, text))
    return places[:MAX_PLACES]


def _turned_without_plane(context: ComparedContext) -> list[Place]:
    """Work under turned rotary axes with neither TCP nor a plane: where it is depends on the workpiece zero.

    Only where the zero is known can the tip be compared at all. Otherwise a missing plane would not be noticed
    wherever the zero is taken to lie on the rotary axes.
    """
    run = context.run
    if run.machine.workpiece_zero is not None:
        return []
    places: list[Place] = []
    for nc, cl in context.matching.pair_chunks():
        turned = ~run.state.xyz_is_tip.at(nc)
        if not turned.any():  # with TCP, as most are
            continue
        # Whole turns leave everything where it was.
        turned &= (np.abs(run.rotary[nc] - 360.0 * np.rint(run.rotary[nc] / 360.0)) > _STILL).any(axis=1)
        turned &= ~only_positions_rotary_axes(run, nc)  # on the way from plane to plane
        for k in np.flatnonzero(turned)[: MAX_PLACES - len(places)].tolist():
            text = "works under turned rotary axes with TCP off and in no plane: say where the workpiece zero is (zero)"
            places.append(context.place_with_cl(int(nc[k]), 0.0, text, int(cl[k])))
    return places


def _planes_left_on(context: Context, changes: list[_PlaneChange]) -> Iterator[Place]:
    """Tool changes and ends of the program in a plane or with a shifted zero."""
    order = {id(event): n for n, event in enumerate(context.run.events)}
    for event in context.run.events:
        if event.kind not in ("tool_change", "end"):
            continue
        last = next((change for change in reversed(changes) if order[id(change.event)] < order[id(event)]), None)
        if last is not None and (last.on or last.shifted):
            what = "changes the tool" if event.kind == "tool_change" else "ends the program"
            state = "in a tilted plane" if last.on else "with a frame on"
            text = f"{what} {state}, which was switched on in line {last.event.line}"
            yield context.place_of_event(event, 0.0, text)
