"""``trunnion post`` without its proof, for the benchmark: ``python unproven.py CL MACHINE NC``.

Reads, plans and writes as the command does, and does not read its program back. No command of Trunnion does that.
"""

import os
import sys
from concurrent.futures import ThreadPoolExecutor

from trunnion.cli import at_full_speed


def main() -> None:
    """Run from the command line."""
    at_full_speed()
    from trunnion.cli.cl_files import toolpaths

    source, name, target = sys.argv[1:]
    with ThreadPoolExecutor(1) as aside:
        coming = toolpaths([source], None, False, aside)
        # As the command does, all else is imported while the file is read.
        from trunnion.cli.post import planned_program
        from trunnion.controls import load_control
        from trunnion.files import whole
        from trunnion.machines import load_machine
        from trunnion.output.program_writer import write_program
        from trunnion.planning import Wishes

        machine = load_machine(name)
        control = load_control(machine.control)
        wishes = Wishes(manners=control.manners({}))
        program, _ = planned_program([next(coming)], machine, control, {}, False, wishes)
        with whole(target) as sink:
            write_program(program, sink)
    os._exit(0)  # as the command ends


if __name__ == "__main__":
    main()
