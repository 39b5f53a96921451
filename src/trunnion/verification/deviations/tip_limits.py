"""How far the tip may leave the lines of the CL file in cuts without TCP, where nobody asks for a tolerance.

Units: mm.
"""

import math
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.model.toolpath import Operation, Phase
from trunnion.verification.expected.path import ExpectedPath

#: What a program is divided to where nobody asks for another tolerance, mm.
DIVIDED_TO: Final = 0.005

#: The most of a line that no tolerance of the CL file covers: farther off it is a fault, mm.
MOST_UNSTATED: Final = 0.05

#: Phases in which the tool does not touch the part.
FREE_PHASES: Final = (Phase.RAPID, Phase.APPROACH, Phase.DEPARTURE, Phase.TRAVERSE)


def stated_tolerance(operation: Operation) -> float | None:
    """Return INTOL and OUTTOL together, mm, and no less than what programs are divided to; None: neither is stated."""
    if operation.intol is None and operation.outtol is None:
        return None
    return max((operation.intol or 0.0) + (operation.outtol or 0.0), DIVIDED_TO)


def tip_limits(expected: ExpectedPath | None, cl: Ints) -> tuple[Floats, Floats]:
    """Return how far the tip may leave the lines to CL rows, -1 for none, (k,): what is no fault, and what is known to
    be none. Both are infinite where nothing is cut.
    """
    allowed, known = np.full(len(cl), math.inf), np.full(len(cl), math.inf)
    for section in expected.sections if expected is not None else ():
        here = np.flatnonzero((cl >= section.first) & (cl < section.end))
        cuts = here[~np.isin(section.operation.moves.phase[cl[here] - section.first], FREE_PHASES)]
        stated = stated_tolerance(section.operation)
        allowed[cuts] = MOST_UNSTATED if stated is None else stated
        known[cuts] = DIVIDED_TO if stated is None else stated
    return allowed, known
