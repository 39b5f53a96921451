"""The phases of a path, from the comments that name them in a program."""

from collections.abc import Collection, Sequence

import numpy as np

from trunnion.arrays import Codes, Ints
from trunnion.controls.definition import Control
from trunnion.conversion.program_events import ProgramEvent
from trunnion.conversion.unsupported import Warnings
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind, Phase

_PHASE_BY_NAME = {
    "rapid": Phase.RAPID,
    "approach": Phase.APPROACH,
    "engage": Phase.ENGAGE,
    "cut": Phase.CUT,
    "stepover": Phase.STEPOVER,
    "retract": Phase.RETRACT,
    "departure": Phase.DEPARTURE,
    "traverse": Phase.TRAVERSE,
}


class PhaseComments:
    """The comments that name phases on a control.

    phase_of   comment in capitals -> phase; if several phases share a comment, the first of them
    """

    def __init__(self, control: Control, has_headers: bool) -> None:
        """``has_headers``: the program has the headers of the control, so that its comments can be trusted."""
        self.phase_of: dict[str, Phase] = {}
        for name, phase in _PHASE_BY_NAME.items():
            if comment := control.phases.get(name, "").strip("; *()"):
                self.phase_of.setdefault(comment.upper(), phase)
        self._trusted = has_headers and bool(self.phase_of)
        self._rapids_unnamed = self._trusted and not control.phases.get("rapid")

    def column(
        self, events: Sequence[ProgramEvent], run: Run, rows: Ints, template_lines: Collection[int], warn: Warnings
    ) -> Codes:
        """(n,) uint8: the phase of each of the ``rows`` (n,).

        Without comments that can be trusted, rapids are one phase and all else is cutting.
        """
        phase = np.full(len(rows), Phase.INITIAL, np.uint8)
        if not self._trusted:
            phase[:] = np.where(run.kind[rows] == Kind.RAPID, Phase.RAPID, Phase.CUT)
        comment_at: dict[int, ProgramEvent] = {}
        without_motion: list[ProgramEvent] = []
        for event in events:
            if event.text.upper() in self.phase_of and event.line not in template_lines:
                begin = int(np.searchsorted(rows, event.row))
                without_motion += [comment_at[begin]] if begin in comment_at else []
                comment_at[begin] = event
                phase[begin:] = self.phase_of[event.text.upper()]
        if self._rapids_unnamed:
            phase[(phase == Phase.CUT) & (run.kind[rows] == Kind.RAPID)] = Phase.RAPID
        without_motion += [comment_at[len(rows)]] if len(rows) in comment_at else []
        for event in without_motion:
            warn(event.line, Wording("CNV174", "no_motion_follows_not", event=repr(event.text)))
        return phase
