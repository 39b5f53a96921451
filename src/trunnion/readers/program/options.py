"""How a program is run."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class RunOptions:
    """How a program is run.

    subprograms  the files that it may call, by their names. No others are looked for: calling a missing one is an error
                 among ``Run.diagnostics``
    step_limit   blocks that loops and calls may execute, besides once through each file
    skip         leave out blocks that begin with ``/``: all of them, or those of some levels. False: none, and the run
                 has what the program does with the switches on besides (``Run.skipped``)
    shortest     how endless rotary axes reach plain words: True by the shorter way, False within the displayed turn,
                 None as the control does it. Axes whose output has all turns take the number as it is, except with True
    encoding     of names and texts, as Python calls it; empty: what is likeliest for each line. None: what the
                 control's definition says its programs are written in, or else empty. A byte order mark decides before
                 all of them
    """

    subprograms: Sequence[Path] = ()
    step_limit: int = 50_000
    skip: bool | frozenset[int] = False
    shortest: bool | None = None
    encoding: str | None = None

    def skips(self, level: int) -> bool:
        """Whether blocks of a level of block skip are left out."""
        return self.skip if isinstance(self.skip, bool) else level in self.skip


#: Without subprograms, as the control does it.
DEFAULT_OPTIONS: Final = RunOptions()
