"""Where the time of a machining step goes, and which setting would give the time that was published for it.

In:     a step with its operations as toolpaths, and the seconds of the rows that run them.
Out:    ``StepTimes``: minutes of cuts, of leads and links, of rapids and the rest, in the mean of the operations.

An estimate of the setting: all that a step does it does once for each pass, and the number of passes goes with one over
the distance between them. So a step whose passes are k times as many takes k times as long. Of a helix all but its turn
on one level goes with one over the step down.
"""

import math
from collections.abc import Sequence
from typing import Annotated, Final

import numpy as np

from trunnion.arrays import Flags
from trunnion.impeller.steps import MachiningStep, StepKind
from trunnion.model.toolpath import Kind, Operation, Phase
from trunnion.records import dataclass
from trunnion.results import Figure
from trunnion.verification import Verification
from trunnion.verification.results import OperationRows, durations

#: Times that differ by less than this share are not explained.
_ALIKE: Final = 0.25

#: A motion within which Z changes by less is on one level, mm.
_LEVEL: Final = 1e-6

#: Steps whose passes lie beside each other: a distance for one, so that it can be changed for another time.
_BESIDE: Final = (StepKind.HUB_FINISH, StepKind.BLADE_FINISH, StepKind.ROOT_BLEND)


@dataclass(frozen=True, slots=True)
class StepTimes:
    """Of one operation of a step, in the mean.

    cuts      minutes at the feed of cuts
    leads     minutes at the feed of leads: into the cut, out of it, and from pass to pass
    rest      minutes at rapid, of tool change and ways home, and of waits
    cut       length of the cuts, mm
    level     length of those along which Z stays, as on the last turn of a helix, mm
    passes    stretches of cuts, between which the tool leaves the part
    """

    cuts: Annotated[float, Figure("cut_minutes", decimals=6)]
    leads: Annotated[float, Figure("lead_minutes", decimals=6)]
    rest: Annotated[float, Figure("other_minutes", decimals=6)]
    cut: Annotated[float, Figure(unit="mm", decimals=3)]
    level: Annotated[float, Figure(unit="mm", decimals=3)]
    passes: int

    @property
    def minutes(self) -> float:
        """All of them."""
        return self.cuts + self.leads + self.rest


@dataclass(frozen=True, slots=True)
class OtherSetting:
    """What would give the published time.

    key      of the step in its file
    value    of the key, mm
    minutes  that the operation would take then
    passes   of each operation; 0 of a helix
    """

    key: str
    value: float
    minutes: float
    passes: int = 0


def step_times(
    feed: float, operations: Sequence[Operation], rows: Sequence[OperationRows], verification: Verification
) -> StepTimes:
    """Return where the time of operations goes, each of which runs in some rows of a verified program.

    ``feed`` is that of their cuts, mm/min.
    """
    seconds, _ = durations(verification)
    found = np.zeros(5)
    passes = 0
    for operation, own in zip(operations, rows, strict=True):
        part = slice(own.first, own.end)
        time, line = seconds[part], verification.cl_line[part]
        moves, cut = operation.moves, _cuts(operation, feed)
        lead = (moves.kind != Kind.RAPID) & ~cut
        times = [float(time[np.isin(line, moves.line[which])].sum()) for which in (cut, lead)]
        steps = np.diff(moves.tip, axis=0)[cut[1:]]
        lengths = np.linalg.norm(steps, axis=1)
        level = float(lengths[np.abs(steps[:, 2]) < _LEVEL].sum())
        found += (*times, float(time.sum()) - sum(times), float(lengths.sum()), level)
        passes += int((cut[1:] & ~cut[:-1]).sum() + cut[0])
    cuts, leads, rest, length, level = (found / len(operations)).tolist()
    return StepTimes(cuts / 60.0, leads / 60.0, rest / 60.0, length, level, round(passes / len(operations)))


def _cuts(operation: Operation, feed: float) -> Flags:
    """Return the rows that cut, (n,) bool."""
    moves = operation.moves
    return np.asarray((moves.kind != Kind.RAPID) & (moves.phase == Phase.CUT) & (np.abs(moves.feed - feed) < 1e-6))


def setting_for_published(step: MachiningStep, times: StepTimes) -> OtherSetting | None:
    """Return the key of the step, and its value, that would give the published time.

    None where nothing is published, the time is near it, or the step has no such key.
    """
    published = step.published_minutes
    if not published or abs(published / times.minutes - 1.0) <= _ALIKE:
        return None
    if step.kind is StepKind.STOCK_ROUGHING:
        return _step_down(step.step_down, published, times)
    if step.kind not in _BESIDE or not step.stepover.distance or times.passes < 2:
        return None
    passes = max(2, round(times.passes * published / times.minutes))
    stepover = step.stepover.distance * (times.passes - 1) / (passes - 1)
    # Not below it, or there would be one pass more.
    value = math.ceil(1000.0 * stepover - 1e-6) / 1000.0
    return OtherSetting("stepover_mm", value, times.minutes * passes / times.passes, passes)


def _step_down(present: float, published: float, times: StepTimes) -> OtherSetting | None:
    """Return the step down of a helix that takes the published minutes; None if what is no helix takes them already."""
    descent = times.cuts * (1.0 - times.level / times.cut) if times.cut else 0.0
    left = published - (times.minutes - descent)
    return OtherSetting("step_down_mm", round(present * descent / left, 2), published) if left > 0.0 < descent else None
