"""``trunnion diff``: what two NC programs make the tool do, not how they say it."""

from trunnion.cli.results import show
from trunnion.cli.wording import spoken
from trunnion.jobs.job import Given
from trunnion.jobs.verify.comparing import diff


def run(given: Given) -> int:
    """Compare two programs; 0 if they do the same, 1 if not."""
    first, second = given.files
    found = diff(first, second, **given.arguments())
    show(given, lambda: found, found.lines(spoken()))
    return 0 if found.same else 1
