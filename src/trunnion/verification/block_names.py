"""What a programmer calls a block."""

from trunnion.messages import Wording
from trunnion.model.run import Run


def block_name(number: int, line: int) -> Wording:
    """Return the name of a block: ``N120``, or its line where it has no number (-1)."""
    return Wording("all", "block", number=number) if number >= 0 else Wording("all", "line", line=line)


def block_name_of(run: Run, row: int) -> Wording:
    """Return the name of the block of a row."""
    return block_name(run.block_numbers[row], run.lines[row])
