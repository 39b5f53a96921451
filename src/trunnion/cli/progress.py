"""A progress bar on a terminal when work takes longer than a second; in a pipe nothing, or a line now and then."""

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import copy_context

from trunnion.cli.wording import in_words, said
from trunnion.messages import word_said
from trunnion.wording import format_duration


@contextmanager
def progress(what: str, total: int, unit: str, *, delay: float = 1) -> Iterator[Callable[[int], None]]:
    """Yield a function that takes how much more has been done; the bar comes after some seconds."""
    if not sys.stderr.isatty():
        yield lambda more: None
        return
    from tqdm import tqdm  # imported late: it takes as long as posting a small file

    what, unit = _said(what), _said(unit)

    with tqdm(total=total, unit=unit, unit_scale=True, desc=what, delay=delay, leave=False) as bar:

        def advance(more: int) -> None:
            bar.update(more)

        yield advance


@contextmanager
def progress_lines(what: str, total: int, unit: str, *, every: float = 30.0) -> Iterator[Callable[[int], None]]:
    """Yield the same, and print to stderr how much has been done whenever so many seconds have gone by."""
    done, started, is_over = 0, time.monotonic(), threading.Event()
    what, unit = _said(what), _said(unit)
    words = copy_context()  # of another thread

    def advance(more: int) -> None:
        nonlocal done
        done += more

    def line_after(passed: str) -> str:
        return said("progress", what=what, done=done, total=total, unit=unit, passed=passed)

    def watch() -> None:
        while not is_over.wait(every):
            passed = format_duration(time.monotonic() - started)
            print(words.run(line_after, passed), file=sys.stderr, flush=True)

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield advance
    finally:
        is_over.set()
        watcher.join()


def _said(name: str) -> str:
    """Return the name of a stage or a unit in the language of the command, with what stands before it."""
    before, mark, word = name.rpartition(": ")
    return f"{before}{mark}{word.replace(word.strip(), in_words(word_said(word.strip())))}" if word.strip() else name
