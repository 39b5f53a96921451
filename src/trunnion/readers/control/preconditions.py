"""What a program must have said before the tool moves at the part, because no position can be stated without it."""

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.event_recorder import Note


class Preconditions:
    """The preconditions that are not met; true while there are any, so that plain blocks are not scanned."""

    def __init__(self, note: Note) -> None:
        self._note = note
        self._unmet: dict[str, Wording] = {}
        self._reported: set[str] = set()

    def __bool__(self) -> bool:
        return bool(self._unmet)

    def require(self, key: str, fault: Wording) -> None:
        """From now on the tool must not move; ``fault`` is what a motion does wrong. It is reported once until met."""
        if key not in self._reported:
            self._unmet[key] = fault

    def meet(self, key: str) -> None:
        """Note that the program has said what was required."""
        self._unmet.pop(key, None)
        self._reported.discard(key)

    def report_motion(self) -> None:
        """Report everything that is not met when the tool moves at the part."""
        for fault in self._unmet.values():
            self._note(fault, Severity.ERROR)
        self._reported.update(self._unmet)
        self._unmet.clear()
