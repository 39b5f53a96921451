"""Work on both sides of a hand-over: while one part is looked at, the next one is worked out on another core.

Only for work that is mostly machine code or NumPy: the interpreter itself runs in one thread at a time.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import zip_longest
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")

#: Parts from which on a second thread is worth its start.
_MIN_ITEMS = 2


def prefetch(work: Callable[[Item], Result], items: Sequence[Item]) -> Iterator[Result]:
    """Results of ``work`` for all parts, in their order; ``work`` is never more than one part ahead.

    An error in ``work`` is raised where its result is asked for.
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
