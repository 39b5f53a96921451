"""What a program must have said before the tool moves at the part, because no position can be stated without it."""

from collections.abc import Callable

from trunnion.messages import Wording


class Preconditions:
    """The preconditions that are not met; true while there are any, so that plain blocks are not scanned."""

    def __init__(self, note_at: Callable[[Wording, int], None]) -> None:
        self._note_at = note_at
        self._unmet: dict[str, tuple[Wording, int]] = {}
        self._reported: set[str] = set()

    def __bool__(self) -> bool:
        return bool(self._unmet)

    def require(self, key: str, fault: Wording, line: int = 0) -> None:
        """From now on the tool must not move; ``fault`` is what a motion does wrong. It is reported once until met.

        It is reported at the motion, or at the first ``line`` before it that requires it.
        """
        if key not in self._reported and not (line and key in self._unmet):
            self._unmet[key] = fault, line

    def meet(self, key: str) -> None:
        """Note that the program has said what was required."""
        self._unmet.pop(key, None)
        self._reported.discard(key)

    def report_motion(self) -> None:
        """Report everything that is not met when the tool moves at the part."""
        for fault, line in self._unmet.values():
            self._note_at(fault, line)
        self._reported.update(self._unmet)
        self._unmet.clear()
