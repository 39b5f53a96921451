"""``trunnion post`` without its proof, for the benchmark: ``python unproven.py CL MACHINE NC``.

Reads, plans and writes as the command does, and does not read its program back. No command of Trunnion does that.
"""

import gc
import os
import sys
from pathlib import Path

from trunnion.cl import read_cl
from trunnion.cli.post import planned_program
from trunnion.control import load_control, write_program
from trunnion.files import whole
from trunnion.machine import load_machine
from trunnion.plan import Wishes


def main() -> None:
    """Run from the command line."""
    gc.disable()
    source, name, target = sys.argv[1:]
    machine = load_machine(name)
    control = load_control(machine.control)
    toolpath = read_cl(Path(source))
    program, _ = planned_program([toolpath], machine, control, {}, False, Wishes(manners=control.manners({})))
    with whole(target) as sink:
        write_program(program, sink)
    os._exit(0)  # as the command ends


if __name__ == "__main__":
    main()
