"""The list of operations at the head of a program: tool, time, spindle, feeds, and what they cut."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from trunnion.model.motion import Motion
from trunnion.model.toolpath import Kind, SpindleOn
from trunnion.output.coordinates.extents import cut_box
from trunnion.output.program import Program


def operation_texts(program: Program, calls: Sequence[str], times: Sequence[str | None]) -> list[str]:
    """Return three texts or fewer for each operation, lengths and feeds in the unit of the program.

    calls  the tool of each operation as the program calls it
    times  the machining time of each, or what stands for it; None: it is not told
    """
    starts = [k for k, motion in enumerate(program.motions) if motion.starts_operation]
    groups = [program.motions[first:end] for first, end in pairwise([*starts, len(program.motions)])]
    texts, rpm = list[str](), list[float]()
    for number, (motions, call, time) in enumerate(zip(groups, calls, times, strict=True), 1):
        rpm = _speeds(motions) or rpm[-1:]
        facts = [time or "", _range("S", rpm), *_feeds(motions, program.control.unit)]
        box = _box(motions, program.control.unit)
        texts += [f"{number} {motions[0].operation.name} T{call}", ", ".join(filter(None, facts)), box]
    return [text for text in texts if text]


def _speeds(motions: Sequence[Motion]) -> list[float]:
    """Spindle speeds that an operation states, in their order."""
    return [event.rpm for motion in motions for event in motion.operation.events if isinstance(event, SpindleOn)]


def _feeds(motions: Sequence[Motion], unit: float) -> list[str]:
    """Least and greatest feed of the cuts, per minute and per revolution."""
    moves = [motion.operation.moves for motion in motions]
    cuts = np.concatenate([each.kind != Kind.RAPID for each in moves])
    feed, per_rev = (np.concatenate([getattr(each, name) for each in moves]) for name in ("feed", "per_rev"))
    cuts &= np.isfinite(feed)
    found = (("F", feed[cuts & ~per_rev]), ("per revolution F", feed[cuts & per_rev]))
    return [_range(name, (values / unit).tolist()) for name, values in found if len(values)]


def _box(motions: Sequence[Motion], unit: float) -> str:
    """Return what the tip cuts, in the coordinates of the program."""
    box = cut_box(motions)
    if box is None:
        return ""
    decimals = 3 if unit == 1.0 else 4
    low, high = (np.round(corner / unit, decimals) + 0.0 for corner in box)
    return ", ".join(
        f"{name}{first:.8g} to {last:.8g}" if first != last else f"{name}{first:.8g}"
        for name, first, last in zip("XYZ", low.tolist(), high.tolist(), strict=True)
    )


def _range(name: str, values: Sequence[float]) -> str:
    if not values:
        return ""
    low, high = (f"{value:.10g}" for value in (min(values), max(values)))
    return name + (low if low == high else f"{low} to {high}")
