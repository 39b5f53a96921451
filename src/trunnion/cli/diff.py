"""``trunnion diff``: what two NC programs make the tool do, not how they say it."""

import argparse
from pathlib import Path

from trunnion.machines import load_machine


def run(arguments: argparse.Namespace) -> int:
    """Compare two programs; 0 if they do the same, 1 if not."""
    from trunnion.cli.verify import rapid_feed_of
    from trunnion.readers import reader_of, run_program
    from trunnion.verification import compare, restore_rapids

    first = load_machine(arguments.machine)
    second = load_machine(arguments.to_machine) if arguments.to_machine else first
    for machine in (first, second):
        reader_of(machine)
    named = [[Path(file) for file in files] for files in (arguments.subprograms, arguments.to_subprograms)]
    one, two = (
        restore_rapids(run_program(Path(file), machine, subprograms=subprograms), rapid_feed_of(machine))
        for file, machine, subprograms in zip(arguments.files, (first, second), named, strict=True)
    )
    found = compare(one, two, arguments.tolerance, path=arguments.path)
    print(*found.lines(), sep="\n")
    return 0 if found.same else 1
