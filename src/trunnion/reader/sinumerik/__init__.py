"""Reader of Sinumerik 840D programs: the language, and a control that executes it."""

from pathlib import Path

from trunnion.machine import Machine
from trunnion.reader.run import Run
from trunnion.reader.sinumerik.interpreter import STEPS, Interpreter


def run_program(
    path: Path | str,
    machine: Machine,
    *,
    step_limit: int = STEPS,
    skip: bool = False,
    shortest: bool | None = None,
) -> Run:
    """Read a Sinumerik program and run it on a machine.

    Parameters
    ----------
    path
        The program. Subprograms are looked for in its folder, nowhere else.
    machine
        Three slides X, Y and Z, two rotary axes. Every tool has the length of ``machine.tool_length``, or 0: the tip
        is then where the control takes it to be.
    step_limit
        Blocks that loops and calls may execute, besides once through each file.
    skip
        Leave out blocks that begin with ``/``.
    shortest
        How endless rotary axes reach plain words: True the shorter way, False inside the turn displayed; None the
        shorter way while TRAORI is on. Axes whose values are written as they wind take the number as it is.

    Raises
    ------
    InputError
        If the file cannot be read, does not end, or is nested wrongly or too deeply. What is only not understood is
        in ``Run.findings``.
    """
    return Interpreter(Path(path), machine, step_limit=step_limit, skip=skip, shortest=shortest).run()
