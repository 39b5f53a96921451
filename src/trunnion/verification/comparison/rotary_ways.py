"""How far rotary axes travel between the points of two programs for one machine.

In:     two runs for the same machine, and rows of both that go to the same point, in their order.
Out:    at which of them a rotary axis has come another way since the point before: a turn more, or the other way round.

The same tool axis may stand at another angle of the rotary axes, and they may swing out and back before it. Neither
shows in the poses. Where an endless axis turns at rapid without TCP, whole turns make no difference: the tool is away
from the part, and many controls leave them out. A cut that takes them back shows.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Floats, Ints
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

#: Ways that differ by no more are the same, degrees: near a pole the last digits of a tool axis turn a rotary axis.
_WAY: Final = 1.0


class RotaryWays:
    """Follows the rotary axes of both programs; ``follow`` takes the points that both reach, in their order."""

    def __init__(self, one: Run, two: Run) -> None:
        self._names = [one.machine.axes[column].name for column in one.machine.rotary]
        self._angles = _Angles(one), _Angles(two)
        self._before: Floats | None = self._apart(np.array([-1]), np.array([-1]))

    def forget(self) -> None:
        """Begin again with the next point: the programs have gone other ways that are noted already."""
        self._before = None

    def follow(self, a: Ints, b: Ints) -> Iterator[tuple[int, Wording]]:
        """Yield at which of the rows ``a`` and ``b``, (k,) each, the ways to them differ, and what differs."""
        if not len(a):
            return
        apart = self._apart(a, b)
        first = apart[:1] if self._before is None else self._before
        self._before = apart[-1:]
        steps = np.abs(np.diff(np.concatenate((first, apart)), axis=0))
        for k in np.flatnonzero((steps > _WAY).any(axis=1)).tolist():
            axis = int(np.argmax(steps[k])) % len(self._names)
            yield k, Wording("comparison", "other_way", axis=self._names[axis], degrees=steps[k].max())

    def _apart(self, a: Ints, b: Ints) -> Floats:
        """How far the angles, and the ways to them, are apart in both programs, (k, 4)."""
        return self._angles[0].at(a) - self._angles[1].at(b)


class _Angles:
    """How far the rotary axes have turned since the start of the program."""

    def __init__(self, run: Run) -> None:
        columns = list(run.machine.rotary)
        turned = np.diff(np.concatenate((run.start[None, columns], run.rotary)), axis=0)
        away = (run.kind == Kind.RAPID) & ~run.state.tcp.column()
        for k, column in enumerate(columns):
            if run.machine.axes[column].endless:
                turned[away, k] = (turned[away, k] + 180.0) % 360.0 - 180.0
        steps = np.concatenate((turned, np.abs(turned)), axis=1)
        self._both = np.concatenate((np.zeros((1, steps.shape[1])), np.cumsum(steps, axis=0)))

    def at(self, rows: Ints) -> Floats:
        """Return how far the axes have turned up to the end of rows, degrees, with and without sign, (k, 4).

        Row -1 is the start of the program.
        """
        return np.asarray(self._both[rows + 1])
