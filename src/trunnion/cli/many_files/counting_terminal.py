"""A terminal that shows from the start how far work on many files is."""

import sys
from collections.abc import Callable
from contextlib import AbstractContextManager

from trunnion.cli.progress import progress, progress_lines
from trunnion.cli.terminal import Terminal


class CountingTerminal(Terminal):
    """Shows from the start how many files are done."""

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        """Show a bar, or print a line now and then."""
        return progress(stage, total, unit, delay=0) if sys.stderr.isatty() else progress_lines(stage, total, unit)
