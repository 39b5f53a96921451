"""``trunnion convert``: an NC program or a CL file to a toolpath, and out again as a CL file or for another machine."""

import shlex
from collections.abc import Mapping
from pathlib import Path

from trunnion.cli.cl_files import result_stem
from trunnion.cli.printing import tell, tell_problem
from trunnion.cli.results import show
from trunnion.cli.terminal import ConversionTerminal, check_unnamed, output_folder, output_place
from trunnion.cli.wording import in_words, problem_line, said
from trunnion.controls import load_control
from trunnion.dialect_names import WRITTEN_DIALECTS
from trunnion.errors import warning
from trunnion.files import check_outputs
from trunnion.jobs.convert.converting import convert
from trunnion.jobs.guard import files_read
from trunnion.jobs.inputs.reading import load_machine
from trunnion.jobs.job import Given
from trunnion.messages import Wording, phrase


def run(given: Given) -> int:
    """Convert one program; 1 if what came of it is forced."""
    machine = load_machine(given.machine) if given.machine else None
    to_machine = load_machine(given.to_machine) if given.to_machine else None
    _told_of_dialect(given)
    extension = WRITTEN_DIALECTS[given.to_dialect or "clsf"]
    if to_machine is not None:
        extension = load_control(to_machine.control).extension
    target = _target_file(given, extension)
    own = {"machine": machine, "to_machine": to_machine, "output": output_place(target)}
    arguments = given.arguments()
    if machine is not None:
        arguments["nc"] = given.nc
    converted = convert(**{**arguments, **own}, observer=ConversionTerminal())
    if given.to_cl and converted.settings:
        tell(_post_hint(target, given.machine, converted.settings))
    if target != "-":
        operations = converted.toolpath.operations
        rows = sum(len(operation.moves) for operation in operations)
        tell(f"{target}: {said('points_and_operations', points=rows, operations=len(operations))}")
    if converted.stated:
        tell(in_words(phrase("stands_on_stated", words=converted.stated)))
    if given.json is not None:
        show(given, lambda: converted, ())
    return 0 if converted.passed else 1


def _told_of_dialect(given: Given) -> None:
    """Take ``--dialect`` alone for ``--to-dialect``, as it was before; a warning says so until the next version."""
    if given.to_dialect is None and given.dialect is not None and given.to_cl:
        wording = Wording("ARG190", "dialect_of_written")
        tell_problem(problem_line(warning("trunnion convert", 0, wording)))
        given.values["to_dialect"], given.values["dialect"] = given.dialect, None


def _post_hint(target: str, machine: str, settings: Mapping[str, str]) -> str:
    """How to post the CL file such that the program's head becomes the same."""
    name = "FILE.cls" if target == "-" else target
    words = [f"--set={key}={value}" for key, value in settings.items()]
    return said("post_with_same_head", command=shlex.join(["trunnion", "post", name, "--machine", machine, *words]))


def _target_file(given: Given, extension: str) -> str:
    """Where the result goes."""
    folder = output_folder(given.output)
    if folder is None:
        return str(given.output)
    stem = Path(given.nc).stem if given.machine else result_stem(given.nc)
    target = str(folder / (stem + extension))
    check_outputs([file for file in (target, given.json) if file not in (None, "-")], files_read(given))
    check_unnamed(target)
    return target
