"""How a program is run."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

#: Blocks that a program may execute besides going once through its files.
DEFAULT_STEP_LIMIT: Final = 50_000


@dataclass(frozen=True, slots=True, eq=False)
class RunOptions:
    """The options of ``trunnion.readers.run_program``, which documents them."""

    subprograms: tuple[Path, ...] = ()
    step_limit: int = DEFAULT_STEP_LIMIT
    skip: bool = False
    shortest: bool | None = None
    encoding: str = ""


#: Without subprograms, as the control does it.
DEFAULT_OPTIONS: Final = RunOptions()
