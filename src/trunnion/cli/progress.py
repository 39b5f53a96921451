"""A progress bar on a terminal when work takes longer than a second; nothing in a pipe."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def progress(what: str, total: int, unit: str) -> Iterator[Callable[[int], None]]:
    """Yield a function that takes how much more has been done."""
    if not sys.stderr.isatty():
        yield lambda more: None
        return
    from tqdm import tqdm  # imported late: it takes as long as posting a small file

    with tqdm(total=total, unit=unit, unit_scale=True, desc=what, delay=1, leave=False) as bar:

        def advance(more: int) -> None:
            bar.update(more)

        yield advance
