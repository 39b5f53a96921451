"""``trunnion post`` without its proof, for the benchmark: ``python unproven.py CL MACHINE NC``.

Reads, plans and writes as the command does, and does not read its program back. No command of Trunnion does that.
"""

import os
import sys
from concurrent.futures import ThreadPoolExecutor

from trunnion.cli import configure_process


def main() -> None:
    """Run from the command line."""
    configure_process()
    from trunnion.cl.read import AS_IT_SAYS
    from trunnion.cli.cl_files import begin_reading

    source, name, target = sys.argv[1:]
    with ThreadPoolExecutor(1) as executor:
        coming = begin_reading([source], AS_IT_SAYS, executor)
        # As the command does, all else is imported while the file is read.
        from trunnion.files import atomic_file
        from trunnion.jobs.post.planning import plan_program
        from trunnion.jobs.post.post_job import prepare
        from trunnion.machines import load_machine
        from trunnion.output.program_writer import write_program

        program = plan_program(next(coming), prepare(load_machine(name)))[0]
        with atomic_file(target) as sink:
            write_program(program, sink)
    os._exit(0)  # as the command ends


if __name__ == "__main__":
    main()
