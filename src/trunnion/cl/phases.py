"""Phases of motion from the colours in which the CAM system paints a path (PAINT/COLOR)."""

from collections.abc import Sequence

from trunnion.arrays import Codes, Ints
from trunnion.model.toolpath import Phase

_RAPID_COLOUR = 186
#: Slow motion above the part: approach, departure or traverse, as the neighbouring stretches decide.
_TRAVERSE_COLOUR = 211

#: The path colours of NX.
COLOUR_PHASES = {
    _RAPID_COLOUR: Phase.RAPID,
    42: Phase.ENGAGE,
    31: Phase.CUT,
    36: Phase.STEPOVER,
    37: Phase.RETRACT,
    _TRAVERSE_COLOUR: Phase.APPROACH,
}


def fill_phases(phase: Codes, rapids: Ints, colours: Sequence[tuple[int, int]]) -> None:
    """Write the phase of each row.

    Colour 211 only says that the tool moves slowly above the part. The first such stretch after cutting leaves the
    part, the last one before anything else comes up to it, and those in between cross over.

    phase    (n,) uint8, written
    rapids   rows of rapid moves
    colours  (row, colour) of each PAINT/COLOR; a repeated colour begins a new stretch
    """
    n = len(phase)
    phase[:] = Phase.CUT
    phase[rapids] = Phase.RAPID
    stretches = _colour_stretches(colours, n)
    if not stretches:
        return
    phase[: stretches[0][0]] = Phase.INITIAL
    before: Phase | None = None
    traverses = 0
    for index, (begin, stop, colour) in enumerate(stretches):
        following = stretches[index + 1][2] if index + 1 < len(stretches) else None
        traverses = traverses + 1 if colour == _TRAVERSE_COLOUR else 0
        if colour == _TRAVERSE_COLOUR:
            now = _traverse_phase(before, traverses, following)
        elif colour == _RAPID_COLOUR and begin == 0:
            now = Phase.INITIAL
        else:
            now = COLOUR_PHASES[colour]
        phase[begin:stop] = now
        before = now


def _colour_stretches(colours: Sequence[tuple[int, int]], n: int) -> list[tuple[int, int, int]]:
    """Begin, stop and colour of each stretch with rows; an unknown colour continues the stretch before it."""
    stretches: list[tuple[int, int, int]] = []
    known = [(row, colour) for row, colour in colours if colour in COLOUR_PHASES]
    for index, (row, colour) in enumerate(known):
        stop = known[index + 1][0] if index + 1 < len(known) else n
        if row < stop:
            stretches.append((row, stop, colour))
    return stretches


def _traverse_phase(before: Phase | None, count: int, following: int | None) -> Phase:
    """Phase of the ``count``-th stretch of colour 211 in a row, after a stretch of phase ``before``."""
    if count == 1 and before not in (None, Phase.INITIAL, Phase.RAPID):
        return Phase.DEPARTURE
    return Phase.TRAVERSE if following == _TRAVERSE_COLOUR else Phase.APPROACH
