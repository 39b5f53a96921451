"""What no program should do, whatever it is for: faults of modal state."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.messages import Wording, phrase
from trunnion.model.programmed_words import POSITION_WORDS, names_no_axis
from trunnion.model.run import ProgrammedWord
from trunnion.model.toolpath import Kind
from trunnion.verification.alone.cuts import cuts_of
from trunnion.verification.alone.left_open import absurd_feeds, left_open
from trunnion.verification.alone.lengths import wrong_lengths
from trunnion.verification.basis import TOOL_LENGTH, ZERO, missing_of
from trunnion.verification.checks.approach_faults import approaches_through_part
from trunnion.verification.checks.approach_order import not_in_turn
from trunnion.verification.checks.compensation_faults import compensated_askew, compensated_blind
from trunnion.verification.checks.lengths_at_part import lengths_lost_at_part
from trunnion.verification.checks.low_rapids import low_rapids, rapids_at_unknown_heights, skipped_retracts
from trunnion.verification.checks.smoothing_faults import unset_tolerances, wide_tolerances
from trunnion.verification.context import MAX_PLACES, ComparedContext, Context, check_from_places
from trunnion.verification.event_words import event_word
from trunnion.verification.kinematics.unknown_cuts import cuts_from_unknown_places
from trunnion.verification.kinematics.working_planes import unused_planes
from trunnion.verification.results import Check, Coverage, Place
from trunnion.verification.row_ranges import chunk_bounds
from trunnion.verification.spindle_words import TURNING, both_senses, started_behind_cuts

_FAULTS: Final = ("no_feed", "spindle_off", "no_time", "hole_at_rapid")

#: Smaller rotary motion, degrees, is none.
_STILL: Final = 1e-3

#: After TCP is switched on, rapids are looked at for so many rows at most.
_ROWS_AFTER_TCP: Final = 16


def check_modal_state(context: Context) -> Check:
    """Motion without feed or spindle, TCP on where it must be off, rapids below the retract height, no end."""
    run = context.run
    places = _without_feed_or_spindle(context)
    places += _tcp_left_on(context)
    places += _turned_under_tcp(context)
    places += low_rapids(context)
    places += skipped_retracts(context)
    places += approaches_through_part(context)
    places += not_in_turn(context)
    places += wide_tolerances(context)
    places += _without_units(context)
    places += _cuts_from_unknown_places(context)
    places += lengths_lost_at_part(context)
    places += compensated_askew(context)
    places += compensated_blind(context)
    planes, cuts = list(unused_planes(run)), cuts_of(run)
    if isinstance(context, ComparedContext):
        places += [context.place(row, 0.0, Wording("modal", "unused_plane", word=word)) for row, word in planes]
        planes = []
    else:
        places += [*wrong_lengths(context, cuts), *absurd_feeds(context, cuts)]
    if not any(event.kind == "end" for event in run.events):
        last = max(context.last_line, run.lines[-1] if len(run) else 1)
        places.append(Place(last, -1, 0.0, Wording("modal", "no_end")))
    places += _changed_while_turning(context)
    places += _odd_spindle_words(context)
    places.sort(key=lambda place: place.nc_line)
    # With a CL file, the check "spindle" has the spindle.
    good = "good_feed" if isinstance(context, ComparedContext) else "good_feed_and_spindle"
    check = check_from_places("modal", places, Wording("modal", good))
    unasked = tuple(phrase("unasked_plane", word=word, block=context.block_name(row)) for row, word in planes)
    if isinstance(context, ComparedContext):
        unasked += tuple(unset_tolerances(context))
    else:
        unasked += tuple(left_open(context, cuts))
    check = replace(check, missing=unasked)
    if not len(rows := rapids_at_unknown_heights(context)):
        return check
    why = phrase("left_height_unknown")
    left_out = tuple(context.place(row, 0.0, why) for row in rows[:MAX_PLACES].tolist())
    coverage = Coverage(len(run) - len(rows), len(run), left_out)
    return replace(check, missing=(*unasked, *missing_of((ZERO, TOOL_LENGTH), run)), coverage=coverage)


def _cuts_from_unknown_places(context: Context) -> Iterator[Place]:
    """Yield the first cut at a height, or beside a line, that no block states."""
    rows = cuts_from_unknown_places(context.run)
    if len(rows):
        yield context.place(int(rows[0]), 0.0, Wording("modal", "from_machine"))


def _without_units(context: Context) -> Iterator[Place]:
    """Yield the first motion, if the program never said before whether its lengths are millimetres or inches."""
    row = context.run.first_without_units
    if row is not None:
        yield context.place(row, 0.0, Wording("modal", "no_units"))


def _changed_while_turning(context: Context) -> Iterator[Place]:
    """Tool changes while the spindle turns, according to the events up to the row before which they happen."""
    events = sorted(context.run.events, key=lambda event: event.before_row)  # stable
    turning = False
    for event in events:
        if event.kind == "spindle":
            turning = event.value in TURNING
        elif event.kind == "tool_change" and turning and 0 < event.before_row <= len(context.run):
            yield context.place_of_event(event, 0.0, Wording("modal", "change_while_turning"))


def _odd_spindle_words(context: Context) -> Iterator[Place]:
    """Yield blocks with both senses of the spindle, and the start of a spindle that nothing needs and nothing stops."""
    for before, event in both_senses(context.run):
        said = Wording("modal", "both_senses", first=event_word(before.value), second=event_word(event.value))
        yield context.place_of_event(event, 0.0, said)
    if (start := started_behind_cuts(context.run)) is not None:
        yield context.place_of_event(start, 0.0, Wording("modal", "started_behind_cuts"))


def _without_feed_or_spindle(context: Context) -> list[Place]:
    """Return the first row of each fault."""
    run = context.run
    places: list[Place] = []
    found = dict.fromkeys(_FAULTS, False)
    for start, end in chunk_bounds(len(run)):
        at_feed = run.kind[start:end] != Kind.RAPID
        faults = {"no_feed": at_feed & ~(run.state.feed.part(start, end) > 0.0)}
        inverse_time = run.state.feed_mode.part(start, end) == 93
        programmed = run.programmed[start:end]
        # Motions without a block of their own, as those of cycles, have their feed from elsewhere.
        faults["no_time"] = at_feed & inverse_time & (programmed != 0) & ((programmed & int(ProgrammedWord.FEED)) == 0)
        # A CL file tells where the spindle turns; some tools do not.
        if not isinstance(context, ComparedContext):
            off = (run.state.spindle.part(start, end) == 0) | (run.state.rpm.part(start, end) <= 0.0)
            faults["spindle_off"] = at_feed & off & ~run.state.machine_frame.part(start, end)
            # A CL file tells the feeds of holes, too.
            of_rapids = run.state.feed.part(start, end) == context.settings.rapid_feed
            lines = run.kind[start:end] == Kind.LINEAR
            faults["hole_at_rapid"] = lines & names_no_axis(programmed) & of_rapids
        for fault, rows in faults.items():
            if not found[fault] and rows.any():
                found[fault] = True
                places.append(context.place(start + int(np.argmax(rows)), 0.0, Wording("modal", fault)))
    return places


def _tcp_left_on(context: Context) -> Iterator[Place]:
    """Machine positions, tool changes and ends of program with TCP on; retracts are along the tool axis, at its tip."""
    run = context.run
    frame = run.state.machine_frame.rows_with(True)
    retracts = [event.before_row for event in run.events if event.kind == "retract"]
    wrong = frame[run.state.tcp.at(frame) & ~np.isin(frame, retracts)]
    if len(wrong):
        yield context.place(int(wrong[0]), 0.0, Wording("modal", "machine_with_tcp"))
    for event in run.events:
        if event.tcp and event.kind in ("tool_change", "end"):
            what = "change_with_tcp" if event.kind == "tool_change" else "end_with_tcp"
            yield context.place_of_event(event, 0.0, Wording("modal", what))


def _turned_under_tcp(context: Context) -> Iterator[Place]:
    """Rapids that swing rotary axes right after TCP, or M114, was switched on: they were not positioned before it."""
    run = context.run
    for first in sorted({*run.state.tcp.rows_changing_to(True), *run.state.at_ends.rows_changing_to(True)}):
        end = min(first + _ROWS_AFTER_TCP, len(run))
        joints = run.chunk(first, end).joints[:, list(run.machine.rotary)]
        turns = np.abs(np.diff(joints, axis=0)).max(axis=1)
        for row in range(first, end):
            if run.kind[row] != Kind.RAPID or not (run.state.tcp[row] or run.state.at_ends[row]):
                break
            turned = float(turns[row - first])
            if turned > _STILL and not run.state.machine_frame[row]:
                yield context.place(
                    row, turned, Wording("modal", "swings", angle=turned, word="TCP" if run.state.tcp[row] else "M114")
                )
            if run.programmed[row] & int(POSITION_WORDS):
                break
