"""The check of a recording: how far the machine was off the program's path, how it went through it, how much of it was
recorded, and how much of its travel the machine used.
"""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.recording import Mark
from trunnion.verification.context import MAX_PLACES, Context, Faults
from trunnion.verification.recorded.compared import RecordedComparison
from trunnion.verification.recorded.course import Coverage, Fault, coverage, faults, longest_stand
from trunnion.verification.results import Check, Place

KEY = "recorded"

#: Seconds for which a recording that stands at one place is told.
_LONG_STAND: Final = 10.0

#: Axes beyond their limits by less than this are at them, mm or degrees.
_ROUNDING = 1e-4


def check_recorded(context: Context, compared: RecordedComparison) -> Check:
    """Judge a recording; the places are the worst blocks, worst first."""
    at = compared.compared
    if not len(at):
        why = _not_compared(compared) or Wording("recorded", "empty")
        nothing = Wording("recorded", "nothing_on_path", recording=compared.recording.name, why=why)
        return Check(KEY, False, nothing, None, compared.tolerance, "mm")
    run = context.run
    wrong = [_fault_place(context, compared, fault) for fault in faults(run, compared)]
    found = coverage(run, compared)
    holes = _hole_places(context, found)
    beyond = list(_beyond_travel(context, compared))
    bad = _bad_rows(compared)
    rows = bad or _worst_rows(compared)[:1]
    off = [_place(context, compared, row) for row in rows[:MAX_PLACES]]
    places = [*wrong, *beyond, *off, *holes] if bad else [*wrong, *beyond, *holes, *off]
    worst = float(compared.tip_off[at].max())
    seen = {"seen": int((compared.positions > 0).sum()), "motions": len(context.run)}
    parts = [
        Wording("recorded", "calls_program", name=compared.name) if compared.name else None,
        _part(context, found),
        Wording("recorded", "at_most", off=worst, angle=compared.axis_off[at].max()),
        Wording("recorded", "positions", count=len(at), **seen),
        _apart(context, compared),
        _stood(context, compared),
        _not_compared(compared),
        _travel(context, compared),
    ]
    fails = bool(wrong or holes or bad or beyond)
    if fails:
        count = len(wrong) + len(holes) + len(bad) + len(beyond)
        first = places[0].wording if places[0] in (*wrong, *holes) else Faults(places, 1).answer()
        parts.insert(0, first.within("and_more_places", count=count - 1) if count > 1 else first)
    answer = Wording("recorded", "answer", parts=tuple(filter(None, parts)))
    return Check(KEY, not fails, answer, worst, compared.tolerance, "mm", tuple(places[:MAX_PLACES]))


def _fault_place(context: Context, compared: RecordedComparison, fault: Fault) -> Place:
    row = fault.row if fault.row >= 0 else _row_near(compared, fault.at)
    found = {"fault": fault.said, **_line(compared, fault.at)}
    said = Wording("recorded", "fault", **found)
    if fault.row >= 0:
        said = Wording("recorded", "fault_in_block", **found, block=context.block_name(row))
    return context.place(row, math.nan, said)


def _line(compared: RecordedComparison, at: int) -> dict[str, object]:
    """Return the line of a row of the recording, which has a heading, and its name."""
    return {"line": at + 2, "recording": compared.recording.name}


def _row_near(compared: RecordedComparison, at: int) -> int:
    """Return the row of the last position up to a place of the recording."""
    told = compared.row[: at + 1]
    return int(told[told >= 0][-1]) if (told >= 0).any() else 0


def _hole_places(context: Context, found: Coverage) -> list[Place]:
    """Return a place for each part of the program that is missing in the midst of the recording."""
    holes = found.holes
    parts = np.split(holes, np.flatnonzero(np.diff(holes) > 1) + 1) if len(holes) else []
    return [context.place(int(part[0]), math.nan, _missing(context, part)) for part in parts]


def _missing(context: Context, rows: Ints) -> Wording:
    first, last = context.block_name(int(rows[0])), context.block_name(int(rows[-1]))
    if len(rows) == 1:
        return Wording("recorded", "block_missing", block=first)
    return Wording("recorded", "blocks_missing", first=first, last=last, count=len(rows))


def _part(context: Context, found: Coverage) -> Wording:
    """Which part of the program was recorded."""
    if found.share > 0.99995 and not len(found.holes) and not len(found.gaps):
        return Wording("recorded", "all_recorded")
    ends = {"first": context.block_name(found.first), "last": context.block_name(found.last)}
    share = min(100.0 * found.share, 99.9)
    if not len(found.gaps):
        return Wording("recorded", "only_part", share=share, **ends)
    return Wording("recorded", "only_part_with_gaps", share=share, count=len(found.gaps), **ends)


def _stood(context: Context, compared: RecordedComparison) -> Wording | None:
    seconds, at = longest_stand(compared)
    if seconds < _LONG_STAND:
        return None
    return Wording("recorded", "stood", seconds=seconds, block=context.block_name(int(compared.row[at])))


def _bad_rows(compared: RecordedComparison) -> list[int]:
    """Rows in which the machine was too far off, the worst first."""
    return [row for row in _worst_rows(compared) if np.nanmax(compared.worst[row]) > compared.tolerance]


def _worst_rows(compared: RecordedComparison) -> list[int]:
    rows = np.flatnonzero(compared.positions > 0)
    measure = compared.worst[rows].max(axis=1)
    found: list[int] = rows[np.argsort(-measure, kind="stable")].tolist()
    return found


def _place(context: Context, compared: RecordedComparison, row: int) -> Place:
    """Return the place of a row, with its worst position."""
    of_row = np.flatnonzero(compared.row == row)
    tip_off = compared.tip_off
    k = int(of_row[np.argmax(np.maximum(tip_off[of_row], compared.axis_off[of_row]))])
    found = {"off": tip_off[k], "angle": compared.axis_off[k], **_line(compared, k)}
    said = Wording("recorded", "off_path", **found)
    if tip_off[k] > compared.tolerance:
        shares = tuple(f"{name}{part:+.4f}" for name, part in zip("XYZ", compared.off[k], strict=True))
        said = Wording("recorded", "far_off_path", **found, shares=shares)
    return context.place(row, float(max(tip_off[k], compared.axis_off[k])), said)


def _apart(context: Context, compared: RecordedComparison) -> Wording | None:
    """How far the machine went without being looked at."""
    at = compared.compared
    tips = compared.tips[at]
    if len(at) < 2:
        return None
    between = at[1:] - at[:-1] - 1 - compared.recording.marked(Mark.GAP)[np.minimum(at[:-1] + 1, len(compared.row) - 1)]
    steps = np.where(between == 0, np.linalg.norm(np.diff(tips, axis=0), axis=1), 0.0)
    k = int(np.argmax(steps))
    block = context.block_name(int(compared.row[at[k + 1]]))
    return Wording("recorded", "unseen", step=steps[k], block=block) if steps[k] > 0.0 else None


def _not_compared(compared: RecordedComparison) -> Wording | None:
    """Which positions were not compared."""
    counts = {"in_other_programs": compared.foreign, "outside": compared.outside, "incomplete": compared.incomplete}
    parts = tuple(Wording("recorded", variant, count=count) for variant, count in counts.items() if count)
    return Wording("recorded", "not_compared", parts=parts) if parts else None


def _travel(context: Context, compared: RecordedComparison) -> Wording | None:
    """Return the axis that came nearest to its limit."""
    said: dict[float, Wording] = {}
    for k, low, high in _used(compared, context.run.machine):
        axis = context.run.machine.axes[k]
        room, whole = min(low - axis.low, axis.high - high), axis.high - axis.low
        if context.run.machine.is_placed(k):
            share = room / whole if np.isfinite(whole) else 1.0
            used = {"low": low, "high": high, "least": axis.low, "most": axis.high}
            said.setdefault(share, Wording("recorded", "used_range", axis=axis.name, **used))
        elif np.isfinite(whole):
            share = (whole - (high - low)) / whole
            said.setdefault(share, Wording("recorded", "used_travel", axis=axis.name, used=high - low, travel=whole))
    return said[min(said)] if said else None


def _used(compared: RecordedComparison, machine: Machine) -> Iterator[tuple[int, float, float]]:
    """Axes with limits: column, lowest and highest recorded value."""
    if compared.joints is None:
        return
    for k, axis in machine.own_columns:
        values = compared.joints[:, k][np.isfinite(compared.joints[:, k])]
        if axis.has_limits and len(values):
            yield k, float(values.min()), float(values.max())


def _beyond_travel(context: Context, compared: RecordedComparison) -> Iterator[Place]:
    machine = context.run.machine
    for k, low, high in _used(compared, machine):
        axis, joints = machine.axes[k], compared.joints
        assert joints is not None
        if not machine.is_placed(k):
            if high - low > axis.high - axis.low + _ROUNDING:
                at, travel = _row_of_value(joints[:, k], high), axis.high - axis.low
                used = {"axis": axis.name, "used": high - low, "travel": travel}
                said = Wording("recorded", "beyond_travel", **used, **_line(compared, at))
                yield context.place(_row_near(compared, at), high - low - travel, said)
            continue
        for value, limit, over in ((low, axis.low, axis.low - low), (high, axis.high, high - axis.high)):
            if over > _ROUNDING:
                at, stood = _row_of_value(joints[:, k], value), {"at": value, "limit": limit}
                said = Wording("recorded", "beyond_limit", axis=axis.name, **stood, **_line(compared, at))
                yield context.place(_row_near(compared, at), over, said)


def _row_of_value(column: Floats, value: float) -> int:
    """Return the first row of the recording with a value."""
    return int(np.flatnonzero(column == value)[0])
