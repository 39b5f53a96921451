"""Where a program compensates the radius, and by how much: what its register holds, and what the program adds."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from enum import StrEnum
from itertools import pairwise
from typing import Final

import numpy as np

from trunnion.arrays import distinct
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.tool_additions import tool_additions
from trunnion.records import dataclass

#: Words that add to the radius by which the control compensates.
ADDED_RADII: Final = frozenset({"DR", "TOFFR", "TOFFLR"})


class RegisterValue(StrEnum):
    """What the registers of the radius hold, or the tool table: nobody has said it, a difference, or the radius."""

    UNKNOWN = "unknown"
    DIFFERENCE = "difference"
    RADIUS = "radius"


@dataclass(frozen=True, slots=True)
class Stretch:
    """Rows ``first`` to ``end`` (exclusive) under compensation: its side, 1 left of the path, -1 right.

    plane  the row of ``Run.compensation_planes``; -1: across the tool, in space
    style  as ``ModalState.compensation_style`` has it
    """

    first: int
    end: int
    side: int
    plane: int
    style: int


#: Words of compensation in a plane, and the variants of what readers say of them.
_WORDS: Final = frozenset({"G41", "G42", "G41.1", "G42.1", "RL", "RR"})
_FINDINGS: Final = frozenset({"radius_compensation", "not_simulated"})

#: Gives the radius of the tool of a row, mm; None where nobody knows it.
RadiusOf = Callable[[int], float | None]


def compensated_stretches(run: Run) -> Iterator[Stretch]:
    """Yield where radius compensation is on, each time as long as side, plane and style stay."""
    state = run.state
    if set(state.compensation.distinct().tolist()) <= {0}:
        return
    columns = (state.compensation, state.compensation_plane, state.compensation_style, state.machine_frame)
    bounds = distinct(np.concatenate([np.zeros(1, np.int64), *(column.rows for column in columns)]))
    before: Stretch | None = None
    for first, end in zip(bounds.tolist(), [*bounds[1:].tolist(), len(run)], strict=True):
        if first >= len(run) or not state.compensation[first] or state.machine_frame[first]:
            continue
        plane = int(state.compensation_plane[first])
        own = Stretch(first, min(end, len(run)), int(state.compensation[first]), plane, state.compensation_style[first])
        if before is not None and before.end == own.first and _of(before) == _of(own):
            own = Stretch(before.first, own.end, *_of(own))
        elif before is not None:
            yield before
        before = own
    if before is not None:
        yield before


def _of(stretch: Stretch) -> tuple[int, int, int]:
    return stretch.side, stretch.plane, stretch.style


def is_of_compensation(wording: Wording) -> bool:
    """Whether a reader's warning says that it reads the path as programmed, which ``run_of_centre`` answers."""
    return wording.variant in _FINDINGS and wording.parameter("word") in _WORDS


def offsets_of(run: Run, holds: RegisterValue, radius_of: RadiusOf) -> tuple[tuple[Stretch, float | None], ...]:
    """Return how far the control goes beside the programmed path of each stretch, mm; None where nobody knows it.

    Where the program adds another value within a stretch, it is more than one.
    """
    stretches = list(compensated_stretches(run))
    additions = [each for each in tool_additions(run) if each.name in ADDED_RADII] if stretches else []
    changes = {row for each in additions for row in (each.first, each.end)}
    found = list[tuple[Stretch, float | None]]()
    for stretch in stretches:
        bounds = sorted({stretch.first, stretch.end, *(row for row in changes if stretch.first < row < stretch.end)})
        for first, end in pairwise(bounds):
            base = _base(run, first, holds, radius_of)
            added = sum(each.value for each in additions if each.first <= first < each.end)
            found.append((replace(stretch, first=first, end=end), None if base is None else base + added))
    return tuple(found)


def _base(run: Run, row: int, holds: RegisterValue, radius_of: RadiusOf) -> float | None:
    """Return what the register holds for a row, mm."""
    stated = float(run.state.stated_radius[row])
    if not math.isnan(stated):
        return stated
    if run.state.radius[row] == 0 or (run.state.edge[row] == 0 and not run.uses_length_numbers):
        return 0.0
    if holds is RegisterValue.RADIUS:
        return radius_of(row)
    return 0.0 if holds is RegisterValue.DIFFERENCE else None
