"""The files that a call reads, none of which it may write over."""

import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from trunnion.controls import control_library
from trunnion.definitions import resolve_extends
from trunnion.files import file_on_disk
from trunnion.jobs.inputs.reading import FilePath, MachineLike, ToolpathLike
from trunnion.machines import BodyFile, Machine
from trunnion.model.toolpath import Toolpath
from trunnion.verification import Verification


def cl_files(cl: ToolpathLike | Iterable[ToolpathLike]) -> list[FilePath]:
    """CL files, as far as they are known before any is read: an iterator is left alone."""
    if isinstance(cl, str | os.PathLike | Toolpath):
        cl = [cl]
    files = (
        [file_on_disk(each.file) if isinstance(each, Toolpath) else each for each in cl]
        if isinstance(cl, Sequence)
        else []
    )
    return [file for file in files if isinstance(file, str | os.PathLike)]


def definition_files(machine: MachineLike, loaded: Machine) -> list[FilePath]:
    """Return the files of a machine's definition and of its control's, with all that they extend."""
    named = [machine] if isinstance(machine, str | os.PathLike) and os.fspath(machine).endswith(".toml") else []
    control = resolve_extends(loaded.control.unread_copy(), control_library())
    return [*named, *loaded.files, *control.files()]


def machine_files(machine: MachineLike, loaded: Machine) -> list[FilePath]:
    """Return the files of a machine: those of its definition, and the meshes of its bodies, which only a simulation
    opens.
    """
    meshes = [body.shape for body in loaded.bodies if isinstance(body.shape, BodyFile)]
    return [*definition_files(machine, loaded), *(Path(mesh.of).parent / mesh.file for mesh in meshes)]


def verified_files(verification: Verification) -> list[FilePath]:
    """Return the files that a verification is about."""
    run = verification.run
    cl = {file_on_disk(operation.cl_file) for operation in verification.operations}
    return [verification.program, *run.files, *cl, *machine_files(run.machine, run.machine)]
