"""Events of two programs that the machine waits at or acts upon, at their places in the path.

In:     the rows of a run in which its tool moves.
Out:    which events come before each of these motions, and after the last one.
"""

from typing import Final

import numpy as np

from trunnion.arrays import Ints
from trunnion.model.run import Run, RunEvent

#: What every control has, and messages call it.
_OF_ALL: Final = {"stop": "stop", "optional_stop": "optional stop", "dwell": "dwell"}

#: Words of the machine's builder: they mean the same on the same machine only.
_OF_MACHINE: Final = {"m": "M", "h": "H", "known": ""}

#: Dwells are the same within this, seconds or revolutions: programs print no more digits.
_DIGITS: Final = 3


class PathEvents:
    """The events of one program by the motion before which they come; that after the last one is ``len(rows)``.

    rows          (n,) the rows in which the tool moves
    same_machine  the other program is for the same machine
    """

    def __init__(self, run: Run, rows: Ints, *, same_machine: bool) -> None:
        names = {**_OF_ALL, **(_OF_MACHINE if same_machine else {})}
        found = [event for event in run.events if event.kind in names]
        at = np.searchsorted(rows, [event.before_row for event in found])
        self._events: dict[int, list[str]] = {}
        for motion, event in zip(at.tolist(), found, strict=True):
            self._events.setdefault(motion, []).append(_words(names[event.kind], event))
        self.motions: Ints = np.unique(at).astype(np.int64)

    def take(self, first: int, end: int) -> list[str]:
        """Return what comes before the motions from ``first`` to ``end`` (exclusive) and has not been taken yet, in
        words.

        Sorted, as the order of what comes at one place makes no difference.
        """
        return sorted(words for motion in self.motions_in(first, end) for words in self._events.pop(motion, ()))

    def motions_in(self, first: int, end: int) -> list[int]:
        """Return the motions from ``first`` to ``end`` (exclusive) that something comes before."""
        low, high = np.searchsorted(self.motions, (first, end)).tolist()
        return [int(motion) for motion in self.motions[low:high]]


def _words(name: str, event: RunEvent) -> str:
    value = event.value
    if event.kind == "dwell" and isinstance(value, int | float):
        amount = round(float(value), _DIGITS)
        return f"{name} of {-amount:g} revolutions" if amount < 0 else f"{name} of {amount:g} s"
    if isinstance(value, int | float):
        return f"{name}{value:g}"
    return name if value is None or not isinstance(value, str) else f"{name} {value}".strip()
