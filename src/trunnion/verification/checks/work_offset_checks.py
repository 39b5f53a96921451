"""The work offset of a program."""

from typing import Final

from trunnion.model.run import Run, offset_name
from trunnion.verification.context import MAX_PLACES, ComparedContext, Context, check_from_places
from trunnion.verification.results import Check, Place
from trunnion.verification.row_ranges import CHUNK, RowRanges, chunk_bounds

_TITLE: Final = "one work offset throughout"


def check_work_offset(context: Context) -> Check:
    """One work offset wherever the tool works: that of the settings, if they name one.

    Without a CL file, rows with no work offset and TCP off may lead to or from the work.
    """
    run, compared = context.run, isinstance(context, ComparedContext)
    used, tcp = run.state.work_offset, run.state.tcp
    rows = context.matching.nc if isinstance(context, ComparedContext) else _workpiece_frame_rows(run)
    if not len(rows):
        return Check("offset", _TITLE, True, "nothing moves")
    should = context.settings.work_offset
    if should is None:
        should = used[rows[0]] if compared else used[rows[-1]]
    places: list[Place] = []
    count = 0
    for start in range(0, len(rows), CHUNK):
        part = rows.rows(start, start + CHUNK)
        here = used.at(part)
        if (here == should).all():
            continue
        wrong = here != should if compared else (here != should) & ~((here == 0) & ~tcp.at(part))
        bad = part[wrong]
        count += len(bad)
        places += [
            context.place(row, 0.0, f"works in {_name(used[row])}, not in {_name(should)}")
            for row in bad[: max(MAX_PLACES - len(places), 0)].tolist()
        ]
    others = set(used.distinct().tolist()) - {0, should}
    if others and not places:
        row = min(int(used.rows_with(code)[0]) for code in others)
        places.append(context.place(row, 0.0, f"{_name(used[row])} is not the offset of this program"))
    return check_from_places("offset", _TITLE, places, f"{_name(should)} throughout", count or None)


def _workpiece_frame_rows(run: Run) -> RowRanges:
    """Rows that are not in the machine frame."""
    frame = run.state.machine_frame
    return RowRanges.from_flags((start, ~frame.part(start, end)) for start, end in chunk_bounds(len(run)))


def _name(code: int) -> str:
    return "no work offset" if code == 0 else offset_name(code)
