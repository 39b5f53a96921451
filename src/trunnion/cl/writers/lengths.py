"""A toolpath in another unit, or back from it: in rounded numbers."""

from dataclasses import replace
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.model.toolpath import CycleOn, Event, From, Operation

INCH: Final = 25.4

#: Decimals of lengths and feeds that were counted in another unit: less than a thirty-millionth of a millimetre.
_DECIMALS: Final = 9

#: Words of CYCLE whose numbers are lengths, or feeds.
_IN_LENGTHS: Final = frozenset({"RAPTO", "FEDTO", "RTRCTO", "CLEAR", "STEP", "CSKDIA", "HOLDIA", "MMPM", "MMPR"})


def in_unit(operation: Operation, unit: float) -> Operation:
    """Return the operation with all lengths and feeds in a unit, mm; words such as MMPM stay, and mean that
    unit then.
    """

    def one(value: float) -> float:
        return round(value / unit, _DECIMALS)

    def all_of(values: Floats) -> Floats:
        return np.asarray(np.round(values / unit, _DECIMALS), np.float64)

    def pair(centre: tuple[float, float] | None) -> tuple[float, float] | None:
        return None if centre is None else (one(centre[0]), one(centre[1]))

    def scaled(event: Event) -> Event:
        if isinstance(event, From):
            x, y, z = (one(value) for value in event.tip)
            return replace(event, tip=(x, y, z))
        if isinstance(event, CycleOn):
            values = ((word, tuple(map(one, given)) if word in _IN_LENGTHS else given) for word, given in event.values)
            return replace(event, values=tuple(values))
        return event

    moves, arcs, tool, frame = operation.moves, operation.arcs, operation.tool, operation.frame
    x, y, z = (one(value) for value in frame.origin)
    return replace(
        operation,
        moves=replace(moves, tip=all_of(moves.tip), feed=all_of(moves.feed)),
        arcs=replace(arcs, centre=all_of(arcs.centre), radius=all_of(arcs.radius)),
        tool=replace(
            tool,
            diameter=one(tool.diameter),
            corner_radius=one(tool.corner_radius),
            length=one(tool.length),
            flute_length=one(tool.flute_length),
            upper_radius=one(tool.upper_radius),
            extension=one(tool.extension),
            set_length=one(tool.set_length),
            corner_centre=pair(tool.corner_centre),
            upper_centre=pair(tool.upper_centre),
        ),
        frame=replace(frame, origin=(x, y, z)),
        events=tuple(map(scaled, operation.events)),
        intol=None if operation.intol is None else one(operation.intol),
        outtol=None if operation.outtol is None else one(operation.outtol),
    )
