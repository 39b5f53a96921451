"""The kernels that most calls of the library need, in the order in which they need them (``jit.compile_ahead``)."""

from collections.abc import Sequence
from typing import Any, Final

from trunnion import cl, output, planning, readers, verification
from trunnion.jit.ahead import all_kernels

VERIFYING: Final[tuple[Any, ...]] = (*readers.KERNELS, *verification.KERNELS)
CONVERTING: Final[tuple[Any, ...]] = (*readers.KERNELS, *planning.KERNELS, *output.KERNELS, *verification.KERNELS)
POSTING: Final[tuple[Any, ...]] = (*cl.KERNELS, *planning.KERNELS, *output.KERNELS, *VERIFYING)


def needed(work: str) -> Sequence[Any]:
    """Return the kernels that a command needs on any shipped machine (``options.words.PREPARED``).

    What only some programs need, as without TCP or where a pole is crossed, is compiled when they come.
    """
    from trunnion.machines.inverse.solutions import slide_rows, solve_rows
    from trunnion.planning.poses.optimizer import find_cheapest, trace_back
    from trunnion.planning.poses.placement import place_rows

    reading = (*VERIFYING, *all_kernels("readers"), slide_rows)
    if work == "simulate":
        from trunnion.simulation import DESIGN_KERNELS, KERNELS, SURFACE_KERNELS

        found = (*SURFACE_KERNELS, *DESIGN_KERNELS, *reading, *KERNELS)
    elif work == "verify":
        found = reading
    else:
        found = (*POSTING, place_rows, trace_back, solve_rows, find_cheapest, *reading)
    return tuple(dict.fromkeys(found))
