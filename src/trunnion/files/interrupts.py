"""Ctrl-C and other signals that end a command wait where they would leave half of something behind."""

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import current_thread, main_thread
from types import FrameType
from typing import Any, Final

#: Signals whose Python handlers may raise an exception at any moment; not every system has all of them.
_SIGNALS: Final = tuple(
    signal.Signals[name] for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK") if name in signal.Signals.__members__
)


@contextmanager
def children_without_interrupts() -> Iterator[None]:
    """Start processes that Ctrl-C leaves alone from their first moment, in blocks that take no time.

    Ctrl-C goes to all processes of a terminal, also to one that is not ready yet to do anything about it. A process
    that ignores it hands that down to those that it starts. This one gets a Ctrl-C of meanwhile when the block ends,
    where the system can hold it back.
    """
    handler = signal.getsignal(signal.SIGINT)
    if current_thread() is not main_thread() or not callable(handler):
        yield
        return
    held = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT}) if hasattr(signal, "pthread_sigmask") else None
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        _let_console_ignore(True)
        yield
    finally:
        _let_console_ignore(False)
        signal.signal(signal.SIGINT, handler)
        if held is not None:
            signal.pthread_sigmask(signal.SIG_SETMASK, held)


def _let_console_ignore(ignores: bool) -> None:
    """Windows hands down no handlers of signals, but whether a process takes the Ctrl-C of its console."""
    if sys.platform == "win32":
        import ctypes

        ctypes.windll.kernel32.SetConsoleCtrlHandler(None, ignores)


@contextmanager
def held_interrupts() -> Iterator[None]:
    """Let Ctrl-C wait until the block has ended, for blocks that take no time.

    The handlers of the process are back when the block ends, and handle then what has come meanwhile. Threads besides
    the main one are never interrupted.
    """
    if current_thread() is not main_thread():
        yield
        return
    came: list[tuple[Callable[..., Any], int, FrameType | None]] = []
    held: dict[signal.Signals, tuple[Callable[..., Any], Callable[..., None]]] = {}
    try:
        for number in _SIGNALS:
            handler = signal.getsignal(number)
            if callable(handler):

                def note(
                    signum: int, frame: FrameType | None, handler: Callable[..., Any] = handler
                ) -> None:  # called in place of the handler
                    came.append((handler, signum, frame))

                held[number] = handler, note
                signal.signal(number, note)
        yield
    finally:
        for number, (handler, note) in held.items():
            if signal.getsignal(number) is note:
                signal.signal(number, handler)
        for handler, signum, frame in came[:1]:
            handler(signum, frame)
