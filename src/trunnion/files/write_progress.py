"""The progress of a file that is being written, for a thread that reads it at the same time."""

from threading import Condition


class WritingStoppedError(Exception):
    """The file that a thread reads while it is written will not be finished."""


class WriteProgress:
    """How much of a file has been written, for a thread that reads it at the same time."""

    def __init__(self) -> None:
        self._changed = Condition()
        self._size = self._expected_size = 0
        self._finished = self._stopped = False

    def advance(self, size: int, expected_size: int = 0) -> None:
        """Report that ``size`` bytes can be read, and how many there will be at the end by extrapolation."""
        with self._changed:
            self._size, self._expected_size = size, expected_size
            self._changed.notify_all()

    def finish(self) -> None:
        """Report that nothing more will be written."""
        with self._changed:
            self._finished = True
            self._changed.notify_all()

    def stop(self) -> None:
        """Report that the file will not be finished: whoever waits for it gets a ``WritingStoppedError``."""
        with self._changed:
            self._stopped = self._finished = True
            self._changed.notify_all()

    def wait_for(self, size: int) -> bool:
        """Wait until ``size`` bytes can be read; return False if writing has finished, with whatever size.

        Raises ``WritingStoppedError`` if the file will not be finished.
        """
        with self._changed:
            self._changed.wait_for(lambda: self._finished or self._size >= size)
            if self._stopped:
                raise WritingStoppedError
            return not self._finished

    def wait_until_finished(self) -> None:
        """Wait until nothing more will be written; errors as ``wait_for`` raises them."""
        with self._changed:
            self._changed.wait_for(lambda: self._finished)
            if self._stopped:
                raise WritingStoppedError

    @property
    def expected_size(self) -> int:
        """Expected number of bytes at the end, at least the present one."""
        with self._changed:
            return max(self._size, self._expected_size)
