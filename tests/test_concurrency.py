"""Work in a second thread that the first one does not wait for when it is interrupted."""

import _thread
import signal
from threading import Event

import pytest

from trunnion.concurrency import interruptible


def test_a_result_and_an_error_come_through() -> None:
    assert interruptible(lambda: 3) == 3
    with pytest.raises(ZeroDivisionError):
        interruptible(lambda: 1 // 0)


def test_an_interrupt_does_not_wait_for_the_work() -> None:
    over, ended = Event(), Event()

    def work() -> None:
        _thread.interrupt_main()
        over.wait(60.0)
        ended.set()

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background ignores it
    try:
        with pytest.raises(KeyboardInterrupt):
            interruptible(work)
        assert not ended.is_set()
    finally:
        over.set()
        signal.signal(signal.SIGINT, before)
