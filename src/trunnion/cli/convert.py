"""``trunnion convert``: an NC program or a CL file to a toolpath, and out again as a CL file or for another machine."""

import argparse
import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from trunnion.cli.cl_files import cl_inputs, named_files, result_stem
from trunnion.cli.results import tell
from trunnion.cli.terminal import ConversionTerminal, check_unnamed, output_folder, output_place
from trunnion.controls import load_control
from trunnion.files import check_outputs
from trunnion.jobs.convert.converting import convert
from trunnion.jobs.inputs.reading import load_machine
from trunnion.wording import counted

#: Extensions of CL files by their dialects.
_CL_EXTENSIONS: Final = {"clsf": ".cls", "catia": ".aptsource", "ncl": ".ncl"}


def run(arguments: argparse.Namespace) -> int:
    """Convert one program; 1 if what came of it is forced."""
    machine = load_machine(arguments.machine) if arguments.machine else None
    to_machine = load_machine(arguments.to_machine) if arguments.to_machine else None
    dialect = arguments.to_dialect or "clsf"
    extension = _CL_EXTENSIONS[dialect] if to_machine is None else load_control(to_machine.control).extension
    target = _target_file(arguments, extension)
    converted = convert(
        cl_inputs([arguments.file])[0] if machine is None else arguments.file,
        machine=machine,
        to_machine=to_machine,
        to_cl=arguments.to_cl,
        dialect=dialect,
        output=output_place(target),
        subprograms=arguments.subprograms,
        zero=arguments.zero or None,
        tool_length=arguments.tool_length or None,
        settings=dict(arguments.settings),
        force=arguments.force,
        observer=ConversionTerminal(),
    )
    if arguments.to_cl and converted.settings:
        tell(_post_hint(target, arguments.machine, converted.settings))
    if target != "-":
        operations = converted.toolpath.operations
        rows = sum(len(operation.moves) for operation in operations)
        tell(f"{target}: {counted(rows, 'point')}, {counted(len(operations), 'operation')}")
    return 0 if converted.passed else 1


def _post_hint(target: str, machine: str, settings: Mapping[str, str]) -> str:
    """How to post the CL file such that the program's head becomes the same."""
    name = "FILE.cls" if target == "-" else target
    words = [f"--set={key}={value}" for key, value in settings.items()]
    return "to post it with the same head: " + shlex.join(["trunnion", "post", name, "--machine", machine, *words])


def _target_file(arguments: argparse.Namespace, extension: str) -> str:
    """Where the result goes."""
    folder = output_folder(arguments.output)
    if folder is None:
        return str(arguments.output)
    stem = Path(arguments.file).stem if arguments.machine else result_stem(arguments.file)
    target = str(folder / (stem + extension))
    check_outputs([target], [*named_files([arguments.file]), *arguments.subprograms])
    check_unnamed(target)
    return target
