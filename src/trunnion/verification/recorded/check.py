"""The check of a recording: how far the machine was off the program's path, how it went through it, how much of it was
recorded, and how much of its travel the machine used.
"""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.machines import Machine
from trunnion.model.recording import Mark
from trunnion.verification.context import MAX_PLACES, Context
from trunnion.verification.recorded.compared import RecordedComparison
from trunnion.verification.recorded.course import Coverage, Fault, coverage, faults, longest_stand
from trunnion.verification.results import Check, Place
from trunnion.wording import counted

KEY = "recorded"
TITLE = "the machine as it was recorded"

#: Seconds for which a recording that stands at one place is told.
_LONG_STAND: Final = 10.0

#: Axes beyond their limits by less than this are at them, mm or degrees.
_ROUNDING = 1e-4


def check_recorded(context: Context, compared: RecordedComparison) -> Check:
    """Judge a recording; the places are the worst blocks, worst first."""
    at = compared.compared
    if not len(at):
        why = _not_compared(compared) or "it is empty"
        summary = f"no position of {compared.recording.name} is on the path of this program: {why}"
        return Check(KEY, TITLE, False, summary, None, compared.tolerance, "mm")
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
    parts = [
        _named(compared),
        _part(context, found),
        f"tip at most {worst:.4f} mm off the path, tool axis {float(compared.axis_off[at].max()):.4f} degrees",
        f"{counted(len(at), 'position')} in {int((compared.positions > 0).sum())} of {len(context.run)} motions",
        _apart(context, compared),
        _stood(context, compared),
        _not_compared(compared),
        _travel(context, compared),
    ]
    fails = bool(wrong or holes or bad or beyond)
    if fails:
        first = places[0]
        more = len(wrong) + len(holes) + len(bad) + len(beyond) - 1
        text = first.text if first in (*wrong, *holes) else f"{first.block_name}: {first.text}"
        parts.insert(0, text + (f", and {counted(more, 'more place')}" if more else ""))
    return Check(
        KEY, TITLE, not fails, "; ".join(filter(None, parts)), worst, compared.tolerance, "mm",
        tuple(places[:MAX_PLACES]),
    )  # fmt: skip


def _fault_place(context: Context, compared: RecordedComparison, fault: Fault) -> Place:
    row = fault.row if fault.row >= 0 else _row_near(compared, fault.at)
    text = f"{fault.text} (line {fault.at + 2} of {compared.recording.name})"
    return context.place(row, math.nan, f"{context.block_name(row)}: {text}" if fault.row >= 0 else text)


def _row_near(compared: RecordedComparison, at: int) -> int:
    """Return the row of the last position up to a place of the recording."""
    told = compared.row[: at + 1]
    return int(told[told >= 0][-1]) if (told >= 0).any() else 0


def _hole_places(context: Context, found: Coverage) -> list[Place]:
    """Return a place for each part of the program that is missing in the midst of the recording."""
    holes = found.holes
    parts = np.split(holes, np.flatnonzero(np.diff(holes) > 1) + 1) if len(holes) else []
    return [context.place(int(part[0]), math.nan, _missing(context, part)) for part in parts]


def _missing(context: Context, rows: Ints) -> str:
    one, last = context.block_name(int(rows[0])), context.block_name(int(rows[-1]))
    names = one if len(rows) == 1 else f"{one} to {last}, {counted(len(rows), 'motion')},"
    return f"{names} {'was' if len(rows) == 1 else 'were'} not recorded"


def _named(compared: RecordedComparison) -> str:
    return f"the machine calls the program {compared.name}" if compared.name else ""


def _part(context: Context, found: Coverage) -> str:
    """Which part of the program was recorded."""
    if found.share > 0.99995 and not len(found.holes) and not len(found.gaps):
        return "all of the path was recorded"
    share = f"{min(100.0 * found.share, 99.9):.1f} % of the path was recorded"
    whole = f"ONLY {share}, from {context.block_name(found.first)} to {context.block_name(found.last)}"
    gaps = f"; {counted(len(found.gaps), 'motion')} while the connection was broken" if len(found.gaps) else ""
    return f"{whole}{gaps}"


def _stood(context: Context, compared: RecordedComparison) -> str:
    seconds, at = longest_stand(compared)
    if seconds < _LONG_STAND:
        return ""
    return f"it shows one place for {seconds:.0f} s at {context.block_name(int(compared.row[at]))}"


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
    text = f"the machine was {tip_off[k]:.4f} mm off the path"
    if tip_off[k] > compared.tolerance:
        shares = ", ".join(f"{name}{part:+.4f}" for name, part in zip("XYZ", compared.off[k], strict=True))
        text = f"{text} ({shares})"
    text = f"{text}, its tool axis {compared.axis_off[k]:.4f} degrees (line {k + 2} of {compared.recording.name})"
    return context.place(row, float(max(tip_off[k], compared.axis_off[k])), text)


def _apart(context: Context, compared: RecordedComparison) -> str:
    """How far the machine went without being looked at."""
    at = compared.compared
    tips = compared.tips[at]
    if len(at) < 2:
        return ""
    between = at[1:] - at[:-1] - 1 - compared.recording.marked(Mark.GAP)[np.minimum(at[:-1] + 1, len(compared.row) - 1)]
    steps = np.where(between == 0, np.linalg.norm(np.diff(tips, axis=0), axis=1), 0.0)
    k = int(np.argmax(steps))
    block = context.block_name(int(compared.row[at[k + 1]]))
    return f"between positions the tip went up to {steps[k]:.3f} mm unseen ({block})" if steps[k] > 0.0 else ""


def _not_compared(compared: RecordedComparison) -> str:
    """Which positions were not compared."""
    parts = [
        f"{counted(compared.foreign, 'position')} in other programs" if compared.foreign else "",
        f"{counted(compared.outside, 'position')} outside it or where nobody knows the tool"
        if compared.outside
        else "",
        f"{counted(compared.incomplete, 'row')} without all axes" if compared.incomplete else "",
    ]
    told = ", ".join(filter(None, parts))
    return f"not compared: {told}" if told else ""


def _travel(context: Context, compared: RecordedComparison) -> str:
    """Return the axis that came nearest to its limit."""
    texts: dict[float, str] = {}
    for k, low, high in _used(compared, context.run.machine):
        axis = context.run.machine.axes[k]
        room, whole = min(low - axis.low, axis.high - high), axis.high - axis.low
        if context.run.machine.is_placed(k):
            share = room / whole if np.isfinite(whole) else 1.0
            texts.setdefault(share, f"{axis.name} used {low:.3f} to {high:.3f} of {axis.low:g} to {axis.high:g}")
        elif np.isfinite(whole):
            used = high - low
            texts.setdefault((whole - used) / whole, f"{axis.name} used {used:.3f} mm of the {whole:g} of its travel")
    return texts[min(texts)] if texts else ""


def _used(compared: RecordedComparison, machine: Machine) -> Iterator[tuple[int, float, float]]:
    """Axes with limits: column, lowest and highest recorded value."""
    if compared.joints is None:
        return
    for k, axis in enumerate(machine.axes):
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
                text = f"axis {axis.name} used {high - low:.4f} mm, more than its travel of {axis.high - axis.low:g}"
                yield _place_of_value(context, compared, joints[:, k], high, high - low - axis.high + axis.low, text)
            continue
        for value, limit, over in ((low, axis.low, axis.low - low), (high, axis.high, high - axis.high)):
            if over > _ROUNDING:
                text = f"axis {axis.name} stood at {value:.4f}, beyond its limit of {limit:g}"
                yield _place_of_value(context, compared, joints[:, k], value, over, text)


def _place_of_value(
    context: Context, compared: RecordedComparison, column: Floats, value: float, over: float, text: str
) -> Place:
    """Return the place of the first row of the recording with a value."""
    at = int(np.flatnonzero(column == value)[0])
    return context.place(_row_near(compared, at), over, f"{text} (line {at + 2} of {compared.recording.name})")
