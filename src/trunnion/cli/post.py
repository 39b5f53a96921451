"""``trunnion post``: CL files in, one proven NC program out (or one each, into a folder)."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from itertools import chain, islice
from pathlib import Path
from typing import Final, cast

from trunnion.cli.cl_files import result_stem
from trunnion.cli.printing import tell
from trunnion.cli.results import show
from trunnion.cli.suggest import NotingTerminal, suggestion
from trunnion.cli.terminal import Terminal, check_unnamed, output_folder, output_place, warn_of_old
from trunnion.cli.wording import said
from trunnion.controls import load_control
from trunnion.errors import InputError, Problem, TrunnionError, argument_problem
from trunnion.files import OutputGroup, check_outputs
from trunnion.jobs.arguments import PostArguments
from trunnion.jobs.guard import files_read
from trunnion.jobs.inputs.reading import load_machine
from trunnion.jobs.job import Given
from trunnion.jobs.observer import Observer
from trunnion.jobs.post.posting import Work, post_beside
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.result_output import PAPERS
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.toolpath import Toolpath
from trunnion.options.groups import BODIES, CUTTING

#: What is said of the tools on a sheet, and what of a simulation.
_OF_SHEET: Final = ("tools", "tool_libraries", "unit")
_SIMULATED: Final = ("project", *(each.name for each in (*BODIES, *CUTTING)))


def post(
    given: Given,
    toolpaths: Iterator[list[Toolpath]],
    group: OutputGroup | None = None,
    observer: Observer | None = None,
) -> int:
    """Post every CL file, whose toolpaths come file after file; 1 if one of the programs is forced.

    Programs appear one by one, or with those of the ``group``; an ``observer`` is told in place of the terminal.
    """
    machine = load_machine(given.machine)
    targets = files_by_target(given, machine)
    papers = {name: getattr(given, name) for name in PAPERS if getattr(given, name) is not None}
    alone = papers | ({} if given.suggest is None else {"suggest": given.suggest})
    for name, file in alone.items():
        if len(targets) > 1:
            raise InputError(
                Problem(file, 0, Wording("ARG130", "one_paper_for_several_programs", count=len(targets), name=name))
            )
    read = list(files_read(given))
    if "-" in targets and given.json == "-":
        raise InputError(argument_problem("json", Wording("ARG140", "data_and_program_to_stdout")))
    written = [*targets, *alone.values(), *([] if given.json is None else [given.json])]
    check_outputs([file for file in written if file != "-"], read)
    if output_folder(given.output) is not None:
        for target in targets:
            check_unnamed(target, alone=len(targets) == 1)
    terminal = NotingTerminal(explain=given.explain, recorded=given.explain or bool(given.report))
    toolpaths = toolpaths if observer is not None else _as_read(toolpaths, terminal)
    stated = given.arguments("cl", "machine", "simulate", *_SIMULATED)
    stated |= {"columns": False, "simulation": simulation_of(given), "sheet_tools": sheet_tools_of(given)}
    made: list[Path] = []
    results: list[PostResult] = []
    for target, files in targets.items():
        old = [target, *(file for name, file in papers.items() if name != "report")]  # a refusal writes its report
        asks = nullcontext() if given.suggest is None else suggestion(given, target, terminal)
        with asks, old_files_told(old if observer is None else []):
            result = post_beside(
                chain.from_iterable(islice(toolpaths, len(files))),
                machine,
                cast(PostArguments, {**stated, "output": output_place(target)}),
                Work(read if group is not None else [*read, *made], group),  # a group knows what its jobs write
                observer or terminal,
            )
        made += [*result.subprograms, *([] if result.output is None else [result.output])]
        results.append(result)
        if observer is None:
            print_summary(target, result)
    if given.json is not None and observer is None:
        show(given, lambda: {"schema": 2, "programs": results}, ())
    return 0 if all(result.passed for result in results) else 1


@contextmanager
def old_files_told(names: Sequence[str]) -> Iterator[None]:
    """Where a post fails, say that files which are there are not of it; not where a name or an argument is wrong."""
    try:
        yield
    except TrunnionError as error:
        if not any(problem.code.startswith(("FIL", "ARG")) for problem in error.problems):
            warn_of_old(names)
        raise


def simulation_of(given: Given) -> dict[str, object] | None:
    """Return what the program is simulated with; None: it is not.

    Raises ``InputError`` if something is said about a simulation, and none is asked for.
    """
    stated = {name: getattr(given, name) for name in _SIMULATED if getattr(given, name)}
    if given.simulate:
        return stated
    if unused := [name for name in stated if name not in (sheet_tools_of(given) or ())]:
        raise InputError(argument_problem(unused[0], Wording("ARG130", "only_for_simulation")))
    return None


def sheet_tools_of(given: Given) -> dict[str, object] | None:
    """Return the tools and libraries that a sheet names without a simulation; None: there are none, or no sheet."""
    stated = {name: getattr(given, name) for name in _OF_SHEET if getattr(given, name)}
    return stated if stated and given.sheet and not given.simulate else None


def _as_read(files: Iterator[list[Toolpath]], terminal: Terminal) -> Iterator[list[Toolpath]]:
    """Yield the toolpaths; the terminal says as what each file was read as it comes."""
    for toolpaths in files:
        terminal.read(toolpaths)
        yield toolpaths


def print_summary(target: str, result: PostResult) -> None:
    """Name the files of a program, and say what the operator enters for it."""
    tell(*(f"{target}: {text}" for text in result.entered))
    if result.output is None:
        return
    rows = sum(len(motion.operation.moves) for motion in result.motions)
    operations = sum(motion.starts_operation for motion in result.motions)
    tell(f"{target}: {said('points_and_operations', points=rows, operations=operations)}")
    for subprogram in result.subprograms:
        tell(f"{subprogram}: {said('subprogram_of', program=result.output.name)}")


def files_by_target(given: Given, machine: Machine) -> dict[str, list[str]]:
    """Which program is made from which CL files."""
    place, files = given.output, given.cl
    if place == "-":
        return {"-": files}
    if place is None and len(files) > 1:
        raise InputError(Problem("post", 0, Wording("FIL270", "several_files_without_output")))
    into = output_folder(place)
    if into is None:
        _check_joined(place, files, machine)
        return {place: files}
    extension = load_control(machine.control).extension
    targets: dict[str, list[str]] = {}
    for file in given.cl:
        targets.setdefault(str(into / (result_stem(file) + extension)), []).append(file)
    twice = next((files for files in targets.values() if len(files) > 1), None)
    if twice:
        raise InputError(Problem(twice[1], 0, Wording("FIL240", "over_program_of_other", other=twice[0])))
    return targets


def _check_joined(place: str, files: Sequence[str], machine: Machine) -> None:
    """Raise ``InputError`` for one program of several CL files whose name looks like that of a folder."""
    if len(files) == 1 or Path(place).suffix or Path(place).exists():
        return
    extension = load_control(machine.control).extension
    if extension:
        raise InputError(Problem(place, 0, Wording("FIL220", "no_folder_for_programs", program=place + extension)))
