"""Work in a second thread: one result ahead of its use, or so that Ctrl-C need not wait for it.

Prefetching helps only work that is mostly compiled code or NumPy, because Python itself runs in one thread at a time.
Without it, the post of a million points takes a sixth longer (2.53 to 2.98 s on the machine where this was measured).
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import zip_longest
from threading import Thread
from typing import Final, TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")

#: With fewer items, a second thread is not worth its start.
_MIN_ITEMS = 2

#: So often a wait for a second thread looks for signals, s: a wait without end hears of none on Windows.
_LISTENING: Final = 0.5


def prefetch(work: Callable[[Item], Result], items: Sequence[Item]) -> Iterator[Result]:
    """Yield the results of ``work`` for all items in order, computing at most one item ahead.

    work   computes the result of an item, in a second thread
    items  none of them is None

    Raises whatever ``work`` raises, when its result is due.
    """
    if len(items) < _MIN_ITEMS:
        yield from map(work, items)
        return
    with ThreadPoolExecutor(1) as executor:
        pending = executor.submit(work, items[0])
        for _, following in zip_longest(items, items[1:]):
            ready = pending.result()
            if following is not None:
                pending = executor.submit(work, following)
            yield ready


def interruptible(work: Callable[[], Result]) -> Result:
    """Return the result of work in compiled code, which hears of no signal itself; Ctrl-C does not wait for it.

    Work that is left behind goes on until it ends by itself or the process does: it must have an end, and no effects.

    Raises
    ------
    Exception
        Whatever the work raises.
    """
    done: Future[Result] = Future()

    def run() -> None:
        try:
            done.set_result(work())
        except BaseException as error:  # it is raised again where the result is due
            done.set_exception(error)

    thread = Thread(target=run, daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(_LISTENING)
    return done.result()
