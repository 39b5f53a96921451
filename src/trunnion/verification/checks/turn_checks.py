"""Rotary positioning and tilted planes in a safe order: retract, plane off, turn, plane on, approach.

Rotary axes that are positioned without TCP take the part, or the tool, away from the position that the program refers
to. So they may turn only while the tool is retracted, and in no plane that they would invalidate; and no plane may be
on where the tool is changed or the program ends. It does not matter who wrote the blocks, nor on which side the rotary
axes are.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from trunnion.messages import Wording
from trunnion.model.programmed_words import ROTARY_WORDS
from trunnion.model.run import Run, RunEvent
from trunnion.records import dataclass
from trunnion.verification.alone.cuts import cuts_of
from trunnion.verification.alone.left_open import turned_without_plane
from trunnion.verification.checks.rotary_moves_at_part import STILL, rotary_moves_at_part, turn_flags
from trunnion.verification.context import ComparedContext, Context, Faults
from trunnion.verification.kinematics.positioning_moves import only_positions_rotary_axes
from trunnion.verification.results import Check, Place


@dataclass(frozen=True, slots=True, eq=False)
class _PlaneChange:
    """An event after which a tilted plane is on or off.

    shifted   frames shift the zero without rotating it
    source    the event that switched on what is on, for messages
    level     the plane that is on is that of the work offset (angles of 0): programs end planes so, too
    follows   the rotary axes: they may turn while it is on, and it is not judged at the end, where a third of the
              programs of other CAM systems leave it on (PLANE of Klartext). Otherwise a plane holds for one rotary
              position.
    """

    event: RunEvent
    on: bool
    shifted: bool
    source: RunEvent
    level: bool = False
    follows: bool = False


def check_turns(context: Context) -> Check:
    """Rotary axes turn away from the part and in no plane; planes are off at tool changes and at the end."""
    changes = _plane_changes(context.run)
    turns = rotary_moves_at_part(context)
    places = [*turns.places, *_turns_in_a_plane(context, changes), *_planes_left_on(context, changes)]
    places += _other_swivel_data(context)
    unplaced = _turned_without_plane(context) if isinstance(context, ComparedContext) else Faults()
    found = Faults(sorted([*places, *unplaced.places], key=lambda place: place.nc_line), len(places) + unplaced.count)
    on = sum(change.on for change in changes)
    good = Wording("turns", "with_planes", turns=turns.said(), planes=on) if on else turns.said()
    check = found.check("turns", good)
    alone = () if isinstance(context, ComparedContext) else tuple(turned_without_plane(context, cuts_of(context.run)))
    return replace(check, missing=alone)


def _plane_changes(run: Run) -> list[_PlaneChange]:
    """Return what CYCLE800, G68.2, PLANE and frame words switch on and off."""
    found: list[_PlaneChange] = []
    tilt: RunEvent | None = None
    frame: RunEvent | None = None
    rotated = level = follows = False
    for event in run.events:
        if event.kind in ("cycle800", "tilt", "plane"):
            # G53.1 turns the axes to the plane that is on.
            if event.value != "G53.1":
                tilt, level = event if _tilts(event) else None, False
            frame, rotated, follows = None, False, event.kind == "plane"
        elif event.kind == "level":
            level = tilt is not None
        elif event.kind == "frame":
            word = str(event.value)
            turns = "ROT" in word
            frame = frame if rotated and not turns and word.startswith("A") else event if word else None
            rotated = turns or (rotated and word.startswith("A"))
        else:
            continue
        on = tilt is not None or rotated
        source = frame if tilt is None or level else tilt
        only_level = level and not rotated
        found.append(_PlaneChange(event, on, frame is not None and not rotated, source or event, only_level, follows))
    return found


def _tilts(event: RunEvent) -> bool:
    """Whether the event of a plane switches one on."""
    if event.kind == "cycle800":
        return bool(event.value) and str(event.value).split(",")[1:2] != ['"0"']
    return bool(event.value) and not str(event.value).startswith("RESET")


def _turns_in_a_plane(context: Context, changes: list[_PlaneChange]) -> Iterator[Place]:
    """Rotary axes that turn without TCP in a plane, which holds for one rotary position only."""
    run = context.run
    for k, change in enumerate(changes):
        if not change.on or change.follows:
            continue
        event = change.event
        first = max(event.before_row, 1)
        end = changes[k + 1].event.before_row if k + 1 < len(changes) else len(run)
        rows = first + np.flatnonzero((run.programmed[first:end] & int(ROTARY_WORDS)) != 0)
        rows = rows[~run.state.tcp.at(rows)]
        for row in rows[turn_flags(run, rows)].tolist():
            same_block = run.lines[row] == event.line and run.state.file[row] == event.file
            if not (same_block and row == event.before_row):
                yield context.place(row, 0.0, Wording("turns", "in_plane"))


def _turned_without_plane(context: ComparedContext) -> Faults:
    """Work under turned rotary axes with neither TCP nor a plane: where it is depends on the workpiece zero.

    Only where the zero is known can the tip be compared at all. Otherwise a missing plane would not be noticed
    wherever the zero is taken to lie on the rotary axes.
    """
    run = context.run
    found = Faults()
    if run.machine.workpiece_zero is not None:
        return found
    said = Wording("turns", "no_plane")
    for nc, cl in context.matching.pair_chunks():
        turned = ~run.state.xyz_is_tip.at(nc)
        if not turned.any():  # with TCP, as most are
            continue
        # Whole turns leave everything where it was.
        turned &= (np.abs(run.rotary[nc] - 360.0 * np.rint(run.rotary[nc] / 360.0)) > STILL).any(axis=1)
        turned &= ~only_positions_rotary_axes(run, nc)  # on the way from plane to plane
        places = (context.place_with_cl(int(nc[k]), 0.0, said, int(cl[k])) for k in np.flatnonzero(turned))
        found.add_rows(int(turned.sum()), places)
    return found


def _planes_left_on(context: Context, changes: list[_PlaneChange]) -> Iterator[Place]:
    """Tool changes and ends of the program in a plane or with a shifted zero."""
    by_event = {id(change.event): change for change in changes}
    last: _PlaneChange | None = None
    for event in context.run.events:
        last = by_event.get(id(event), last)
        if event.kind not in ("tool_change", "end") or last is None or (last.follows and event.kind == "end"):
            continue
        tilted = last.on and not last.level
        if tilted or last.shifted:
            change, end = ("change_in_plane", "end_in_plane") if tilted else ("change_in_frame", "end_in_frame")
            said = Wording("turns", change if event.kind == "tool_change" else end, line=last.source.line)
            yield context.place_of_event(event, 0.0, said)


def _other_swivel_data(context: Context) -> Iterator[Place]:
    """Planes by another swivel data set than the settings give: it may be of another head or table."""
    known = context.settings.swivel_data
    if not known or not isinstance(context, ComparedContext):
        return
    for event in context.run.events:
        name = str(event.value).split(",")[1:2] if event.kind == "cycle800" else []
        if name and name[0] not in ("", '"0"', *known):
            said = Wording("turns", "other_swivel_data", has=name[0], wanted=tuple(known))
            yield context.place_of_event(event, 0.0, said)
