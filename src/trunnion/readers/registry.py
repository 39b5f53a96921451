"""Which reader reads the programs of a machine."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from trunnion.errors import InputError, Problem
from trunnion.families import FAMILIES, load_reader
from trunnion.files import WriteProgress
from trunnion.machines import Machine
from trunnion.model.run import Run
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.interpreter import DEFAULT_STEP_LIMIT
from trunnion.readers.program.settings import family_of


def run_program(
    path: Path | str,
    machine: Machine,
    *,
    subprograms: Sequence[Path] = (),
    family: str | None = None,
    step_limit: int = DEFAULT_STEP_LIMIT,
    skip: bool = False,
    shortest: bool | None = None,
    write_progress: WriteProgress | None = None,
) -> Run:
    """Read a program and run it on a machine.

    Parameters
    ----------
    path
        The program.
    subprograms
        The files that it may call, by their names. No others are looked for: a call of one that is not here is an error
        among ``Run.findings``.
    machine
        Three slides X, Y and Z, two rotary axes. Every tool has the length of ``machine.tool_length``, or 0: the
        tip is then where the control takes it to be.
    family
        The control whose language it is, a key of ``FAMILIES``; None: as the machine's definition has it.
    step_limit
        Blocks that loops and calls may execute, besides once through each file.
    skip
        Leave out blocks that begin with ``/``.
    shortest
        How endless rotary axes reach plain words: True the shorter way, False inside the turn displayed; None as the
        control does. Axes whose values are written as they wind take the number as it is, but for True.
    growing
        How far the program's file has come, if it is still being written: it is run as far as it is there, and the
        rest is waited for. None: it is complete. What comes out is the same.

    Raises
    ------
    InputError
        If a file cannot be read, does not end, or is nested wrongly or too deeply, or if no reader knows the
        control. What is only not understood is in ``Run.findings``.
    """
    reader = reader_of(machine, family)
    interpreter = reader.interpreter(
        Path(path), machine, subprograms=tuple(subprograms), step_limit=step_limit, skip=skip, shortest=shortest
    )
    return replace(interpreter.run(write_progress), uses_length_numbers=reader.uses_length_numbers)


def reader_of(machine: Machine, family: str | None = None) -> FamilyReader:
    """Return the reader of a family, by default that of the machine's control.

    Raises
    ------
    InputError
        If there is no reader for its programs yet.
    """
    name = family_of(machine) if family is None else family
    if not _has_reader(name):
        what = f"its control is a {name}, whose programs cannot be read yet"
        raise InputError(
            Problem(machine.key, 0, what, f"name a machine with one of {', '.join(filter(_has_reader, FAMILIES))}")
        )
    reader: FamilyReader = load_reader(name)
    return reader


def can_read(machine: Machine) -> bool:
    """Whether there is a reader for the programs of a machine."""
    return _has_reader(family_of(machine))


def _has_reader(family: str) -> bool:
    return family in FAMILIES and FAMILIES[family].reader is not None
