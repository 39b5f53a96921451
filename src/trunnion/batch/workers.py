"""What all workers tell of a file alike."""

from trunnion.batch.task import DEFINITIONS, FILES
from trunnion.errors import Problem
from trunnion.wording import format_duration


def shown(name: str) -> str:
    """A logical name as messages have it."""
    return name.removeprefix(FILES).removeprefix(DEFINITIONS)


def died(file: str, why: str) -> Problem:
    """The problem of a file whose worker has died."""
    cure = "run the batch again with fewer workers, or this file alone"
    return Problem(shown(file), 0, why, cure, code="BAT310")


def timed_out(file: str, seconds: float) -> Problem:
    """The problem of a file that took too long."""
    what = f"took longer than {format_duration(seconds)}"
    return Problem(shown(file), 0, what, "give it more time with --timeout, or work on it alone", code="BAT350")
