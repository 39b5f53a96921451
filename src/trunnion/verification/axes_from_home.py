"""Axes that a program cuts with before it has stated where they are: the machine is taken to stand at home.

In:     a run.
Out:    the first such cut, with its axes.
"""

from typing import Final

import numpy as np

from trunnion.messages import Wording, phrase
from trunnion.model.run import ProgrammedWord, Run
from trunnion.model.toolpath import Kind
from trunnion.verification.block_names import block_name_of

#: The words that state the linear axes X, Y and Z and the two rotary axes; a vector states both of these.
AXIS_WORDS: Final = (
    ProgrammedWord.X, ProgrammedWord.Y, ProgrammedWord.Z, ProgrammedWord.FIRST | ProgrammedWord.VECTOR,
    ProgrammedWord.SECOND | ProgrammedWord.VECTOR,
)  # fmt: skip

_LINEAR: Final = ProgrammedWord.X | ProgrammedWord.Y | ProgrammedWord.Z
_ROTARY: Final = ProgrammedWord.FIRST | ProgrammedWord.SECOND | ProgrammedWord.VECTOR


def axis_names(run: Run) -> tuple[str, ...]:
    """Return the names of the axes of ``AXIS_WORDS``."""
    return ("X", "Y", "Z", *(run.machine.axes[column].name for column in run.machine.own_rotary))


def axes_from_home(run: Run) -> Wording | None:
    """Return which axes the first cut takes to be at home, in each meaning of a program; None: it has stated all."""
    runs = (run, *(each.run for each in run.skipped))
    return next((found for each in runs if (found := _first_cut(each))), None)


def _first_cut(run: Run) -> Wording | None:
    turns_alone = ((run.programmed & int(_ROTARY)) != 0) & ((run.programmed & int(_LINEAR)) == 0)
    cuts = (run.kind != Kind.RAPID) & ~turns_alone  # the rows of a cycle have no words of axes
    cuts &= ~run.state.machine_frame.part(0, len(run))
    found = np.flatnonzero(cuts)[:1].tolist()
    if not found:
        return None
    stated = int(np.bitwise_or.reduce(run.programmed[: found[0] + 1]))
    names = [name for name, words in zip(axis_names(run), AXIS_WORDS, strict=False) if not stated & int(words)]
    return phrase("axes_at_home", axes=tuple(sorted(names)), block=block_name_of(run, found[0])) if names else None
