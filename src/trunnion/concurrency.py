"""Work on both sides of a hand-over: while one part is looked at, the next one is worked out on another core.

Only for work that is mostly machine code or NumPy: the interpreter itself runs in one thread at a time.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import zip_longest
from typing import TypeVar

Part = TypeVar("Part")
Result = TypeVar("Result")

#: Parts from which on a second thread is worth its start.
_WORTH_A_THREAD = 2


def one_ahead(work: Callable[[Part], Result], parts: Sequence[Part]) -> Iterator[Result]:
    """Results of ``work`` for all parts, in their order; ``work`` is never more than one part ahead.

    An error in ``work`` is raised where its result is asked for.
    """
    if len(parts) < _WORTH_A_THREAD:
        yield from map(work, parts)
        return
    with ThreadPoolExecutor(1) as aside:
        coming = aside.submit(work, parts[0])
        for _, after in zip_longest(parts, parts[1:]):
            ready = coming.result()
            if after is not None:
                coming = aside.submit(work, after)
            yield ready
