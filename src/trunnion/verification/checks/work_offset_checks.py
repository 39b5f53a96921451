"""The work offset of a program."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from trunnion.messages import Wording, phrase
from trunnion.model.programmed_words import ROTARY_WORDS
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind
from trunnion.verification.context import ComparedContext, Context, Faults, check_from_places
from trunnion.verification.kinematics.positioning_moves import first_workpiece_position, rotary_positioning_flags
from trunnion.verification.results import Check, Place
from trunnion.verification.row_ranges import CHUNK, RowRanges, chunk_bounds


def check_work_offset(context: Context) -> Check:
    """One work offset for each operation, and none that the control has cleared before the tool works."""
    check, lost = _check_selected(context), list(_lost_offsets(context))
    if not lost:
        return check
    places = [*([] if check.passed else check.places), *lost]
    return check_from_places("offset", places, None)


def _lost_offsets(context: Context) -> Iterator[Place]:
    """Where a word clears the work offset, and the tool works before it is selected again."""
    run = context.run
    events = [event for event in run.events if event.kind == "offset"]
    ends = [*(event.before_row for event in events[1:]), len(run)]
    for event, end in zip(events, ends, strict=True) if events else ():
        row = first_workpiece_position(run, event.before_row, end) if isinstance(event.value, str) else None
        if row is not None:
            name = _name(context, int(run.state.work_offset[row]))
            said = Wording("offset", "lost", word=event.value, offset=name, block=context.block_name(row))
            yield context.place_of_event(event, 0.0, said)


def _check_selected(context: Context) -> Check:
    """With a CL file the work offset of the settings wherever the tool works, or the same one if they name none.

    Without a CL file, rows with no work offset and TCP off may lead to or from the work. A program of which nothing is
    known may use several, one after the other: it must not change them in a cut, nor work without one.
    """
    if not isinstance(context, ComparedContext) and context.settings.work_offset is None:
        return _check_changes(context, _workpiece_frame_rows(context.run))
    stretches = list(_stretches(context))
    if not stretches:
        return Check("offset", True, Wording("offset", "nothing_moves"))
    used = context.run.state.work_offset
    compared = isinstance(context, ComparedContext)
    found = Faults()
    for rows, wanted in stretches:
        for start in range(0, len(rows), CHUNK):
            part = rows.rows(start, start + CHUNK)
            here = used.at(part)
            if (here == wanted).all():
                continue
            wrong = (
                here != wanted if compared else (here != wanted) & ~((here == 0) & ~context.run.state.follows_at(part))
            )
            at = (
                (int(row), {"has": _name(context, used[int(row)]), "wanted": _name(context, wanted)})
                for row in part[wrong]
            )
            places = (context.place(row, 0.0, Wording("offset", "other", **names)) for row, names in at)
            found.add_rows(int(wrong.sum()), places)
    if compared:
        found.add(*_turned_in_others(context, stretches))
    known = list(dict.fromkeys(wanted for _, wanted in stretches))
    others = set(used.distinct().tolist()) - {0, *known}
    if others and not found.count:
        row = min(int(used.rows_with(code)[0]) for code in others)
        found.add(context.place(row, 0.0, Wording("offset", "of_another", offset=_name(context, used[row]))))
    names = tuple(_name(context, code) for code in known)
    good = Wording("offset", "several", offsets=names)
    return found.check("offset", Wording("offset", "throughout", offset=names[0]) if len(names) == 1 else good)


def _turned_in_others(context: Context, stretches: Sequence[tuple[RowRanges, int]]) -> Iterator[Place]:
    """Where rotary axes are positioned in another work offset than that of the motion that they are positioned for.

    The rotary axes of a work offset count too. A program that selects its only one later is as those that ran.
    """
    run = context.run
    turns = RowRanges.from_flags(
        (start, rotary_positioning_flags(run, start, end) & ~run.state.machine_frame.part(start, end))
        for start, end in chunk_bounds(len(run))
    )
    before = 0
    for rows, wanted in stretches:
        begin, inside, end = (turns.count_before(row) for row in (before, rows[0], rows[-1]))
        again = 0  # rotary axes that turn once more before the motion
        for k in range(end - 1, begin - 1, -1):
            row = turns[k]
            axes = int(run.programmed[row]) & int(ROTARY_WORDS)
            code = int(run.state.work_offset[row])
            if code not in (0, wanted) and axes & ~again:
                said = Wording("offset", "turns_in_other", has=_name(context, code), wanted=_name(context, wanted))
                yield context.place(row, 0.0, said)
            again = again | axes if k < inside else 0
        before = rows[-1] + 1


def _check_changes(context: Context, rows: RowRanges) -> Check:
    """Return the work offsets that a program chooses by itself."""
    run = context.run
    if not len(rows):
        return Check("offset", True, Wording("offset", "nothing_moves"))
    used = run.state.work_offset
    codes: list[int] = []
    places: list[Place] = []
    last = -1
    for start in range(0, len(rows), CHUNK):
        part = rows.rows(start, start + CHUNK)
        here = used.at(part)
        for k in np.flatnonzero(np.diff(here, prepend=last)).tolist():
            row, code = int(part[k]), int(here[k])
            if codes and codes[-1] and run.kind[row] != Kind.RAPID:
                offsets = {"before": _name(context, codes[-1]), "offset": _name(context, code)}
                places.append(context.place(row, 0.0, Wording("offset", "changes_in_cut", **offsets)))
            elif code == 0 and run.state.follows_at(np.array([row]))[0] and used.distinct().any():
                places.append(context.place(row, 0.0, Wording("offset", "works_in_none")))
            codes.append(code)
        last = int(here[-1])
    names = tuple(dict.fromkeys(_name(context, code) for code in codes if code)) or (_name(context, 0),)
    if len(names) == 1:
        return check_from_places("offset", places, Wording("offset", "throughout", offset=names[0]))
    check = check_from_places("offset", places, Wording("offset", "chosen", offsets=names))
    return replace(check, missing=(phrase("offsets_chosen", names=tuple(sorted(map(str, names)))),))


def _stretches(context: Context) -> Iterator[tuple[RowRanges, int]]:
    """Rows with the work offset that they should have: those of each operation, or all without CL files."""
    used = context.run.state.work_offset
    if not isinstance(context, ComparedContext):
        rows, wanted = _workpiece_frame_rows(context.run), context.settings.work_offset
        if len(rows) and wanted is not None:
            yield rows, wanted
        return
    matching = context.matching
    if not len(matching.nc):
        return
    for section in context.expected.sections:
        own = section.settings.work_offset
        rows = RowRanges.from_ranges(matching.nc.ranges(*matching.pair_range(section.first, section.end)))
        if len(rows):
            yield rows, used[matching.nc[0]] if own is None else own


def _workpiece_frame_rows(run: Run) -> RowRanges:
    """Rows that are not in the machine frame."""
    frame = run.state.machine_frame
    return RowRanges.from_flags((start, ~frame.part(start, end)) for start, end in chunk_bounds(len(run)))


def _name(context: Context, code: int) -> Wording | str:
    """Return a work offset as programs of this control call it."""
    return context.run.work_offset_name(code) if code else Wording("offset", "none")
