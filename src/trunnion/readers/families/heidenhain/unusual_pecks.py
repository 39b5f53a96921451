"""Values of pecking cycles that no CL file states, where a program has others than the usual ones."""

from collections.abc import Iterator, Mapping
from typing import Final

from trunnion.readers.control.hole_motion import SAME_GAP

#: How far a peck lifts to break chips, and how far above the drilled depth a rapid into the hole ends, usually, mm.
CHIP_BREAK: Final = 0.2
ADVANCED_STOP: Final = 0.2


def unusual_values(number: int, values: Mapping[int, float], unit: float) -> Iterator[str]:
    """Yield values of pecks that no CL file states and that are not those that are usual: ``Q256 2``.

    How far the tool lifts to break chips, how far above the drilled depth it feeds on, and the factor of the speed at
    which a tap leaves. ``unit``: millimetres of a length.
    """
    usual = {205: {258: ADVANCED_STOP, 259: ADVANCED_STOP, 256: CHIP_BREAK}, 203: {256: CHIP_BREAK}}.get(number, {})
    for parameter, wanted in usual.items():
        breaks = parameter != 256 or number == 203 or values.get(257, 0.0) > 0.0
        if breaks and abs(values.get(parameter, 0.0) * unit - wanted) > SAME_GAP:
            yield f"Q{parameter} {values.get(parameter, 0.0):g}"
    if number == 209:
        yield from (f"Q{each} {values[each]:g}" for each in (256, 403) if values.get(each, 1.0) not in (0.0, 1.0))
