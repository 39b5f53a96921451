"""The comments that mark the phases of motion."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.model.toolpath import Phase

#: The keys of phase comments in a definition.
_PHASE_KEYS: Final = {
    Phase.RAPID: "rapid",
    Phase.APPROACH: "approach",
    Phase.ENGAGE: "engage",
    Phase.CUT: "cut",
    Phase.STEPOVER: "stepover",
    Phase.RETRACT: "retract",
    Phase.DEPARTURE: "departure",
    Phase.TRAVERSE: "traverse",
}


def phase_comments(comments: Mapping[str, str]) -> tuple[Ints, list[str]]:
    """Return an index of each ``Phase`` into the comments of a definition, -1 for none, (9,) int64; and these."""
    texts = [comments.get(_PHASE_KEYS.get(phase, ""), "") for phase in Phase]
    lines = list(dict.fromkeys(text for text in texts if text))
    return np.array([lines.index(text) if text else -1 for text in texts], np.int64), lines
