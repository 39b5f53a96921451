"""The process of a command: how it is ended from outside, and messages that nobody reads any more."""

import io
import os
import signal
import sys
from contextlib import suppress
from types import FrameType
from typing import Any, Final

#: Signals besides Ctrl-C that end a command: of ``kill`` and ``docker stop``, of a terminal or a window that is closed.
_ENDING: Final = ("SIGTERM", "SIGHUP", "SIGBREAK")


class Ended(KeyboardInterrupt):
    """The process is asked to end: it removes what it has half written, as after Ctrl-C.

    signal   the number of the signal
    """

    def __init__(self, number: int) -> None:
        super().__init__()
        self.signal = number


def end_cleanly() -> None:
    """Have signals that would end the process at once end its command instead; those that are ignored stay so."""
    for name in _ENDING:
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _end)


def _end(number: int, _frame: FrameType | None) -> None:
    raise Ended(number)


class _Unread(io.RawIOBase):
    """A file whose reader may go away: what comes after that is dropped."""

    def __init__(self, descriptor: int) -> None:
        super().__init__()
        self._descriptor = descriptor
        self._is_read = True

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._descriptor

    def write(self, data: Any, /) -> int:
        piece = bytes(data)
        while self._is_read and piece:
            try:
                piece = piece[os.write(self._descriptor, piece) :]
            except OSError:
                self._is_read = False
        return len(bytes(data))


def let_messages_go() -> None:
    """Have messages on stderr whose reader has gone away, as ``head`` has, end no command: they are dropped."""
    with suppress(OSError, ValueError, AttributeError):  # there may be no stderr at all
        if sys.stderr.isatty():  # a console takes text, not bytes, and does not go away
            return
        raw = io.BufferedWriter(_Unread(sys.stderr.fileno()))
        sys.stderr = io.TextIOWrapper(raw, encoding="utf-8", errors="replace", line_buffering=True)
