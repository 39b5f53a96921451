"""``trunnion diff``: what two NC programs make the tool do, not how they say it."""

import argparse

from trunnion.cli.results import print_result
from trunnion.jobs.verify.comparing import diff
from trunnion.wording import one_line


def run(arguments: argparse.Namespace) -> int:
    """Compare two programs; 0 if they do the same, 1 if not."""
    first, second = arguments.files
    found = diff(
        first,
        second,
        machine=arguments.machine,
        to_machine=arguments.to_machine or None,
        subprograms=arguments.subprograms,
        to_subprograms=arguments.to_subprograms,
        tolerance=arguments.tolerance,
        path=arguments.path,
    )
    print_result(*map(one_line, found.lines()))
    return 0 if found.same else 1
