"""``trunnion post``: CL files in, one proven NC program out (or one each, into a folder)."""

import argparse
import math
import os
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from trunnion import readers
from trunnion.cli.output_tolerances import program_tolerances
from trunnion.cli.progress import progress
from trunnion.cli.settings import RUN_SETTINGS, apply_setup, check_settings, parse_plan_options, program_division
from trunnion.cli.verify import check_report_name, save_report
from trunnion.controls import Control, load_control
from trunnion.errors import InputError, Problem, RefusedError, Severity
from trunnion.files import OutputFiles, WriteProgress, atomic_output
from trunnion.jit import load
from trunnion.machines import Machine, load_machine
from trunnion.model.motion import Decision, MachiningMode
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.output import KERNELS as WRITING
from trunnion.output.capabilities import control_capabilities
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.output.subprograms import SubprogramOutput
from trunnion.output.validation import check_program
from trunnion.planning import KERNELS as PLANNING
from trunnion.planning import ControlCapabilities, PlanOptions, plan
from trunnion.readers import run_program

if TYPE_CHECKING:
    from trunnion.verification import Settings, Tolerances, Verification


def post(arguments: argparse.Namespace, coming: Iterator[Toolpath]) -> int:
    """Post every CL file; their toolpaths come one after the other."""
    if arguments.report:
        check_report_name(arguments.report)
    machine = load_machine(arguments.machine)
    control = load_control(machine.control)
    settings = dict(arguments.settings)
    check_settings(settings, control)
    if settings.get("numbers") == "off":
        control = replace(control, block_numbers=replace(control.block_numbers, numbered=False))
    machine = apply_setup(machine, settings)
    printed = {key: value for key, value in settings.items() if key not in RUN_SETTINGS}
    options = parse_plan_options(settings, control, arguments.explain or bool(arguments.report))
    targets = _files_by_target(arguments, control)
    load(*PLANNING, *WRITING)
    import trunnion.verification  # noqa: F401 - wanted for the proof; while the first CL file is read it takes no time

    if arguments.report and len(targets) > 1:
        what = f"one report for {len(targets)} programs"
        raise InputError(Problem(arguments.report, 0, what, "post them one at a time, or leave --report out"))
    for target, files in targets.items():
        with atomic_output(target) as output_files:
            division = program_division(settings, control, target, output_files)
            paths = list(islice(coming, len(files)))
            if {**control.settings, **settings}.get("normals") == "contact":
                from trunnion.cl.surface_normals import with_normals

                paths = [with_normals(path) for path in paths]
            for path in paths:
                print_problems(path.remarks)
            with run_while_writing(output_files, machine, division) as (write_progress, run):
                program, decisions = plan_program(
                    paths, machine, control, printed, arguments.force, options, explain=arguments.explain
                )
                written = write_for_proof(program, output_files.main, options, write_progress, division)
            # The proof needs nothing of what was planned; only a program that fails and is forced is written again.
            forced_program = program if arguments.force else None
            del program
            planned_decisions = decisions if options.explain else ()
            prove_program(
                written, run.result(), paths, output_files, target, forced_program, arguments.report, planned_decisions
            )
        if target != "-":
            print(f"{target}: {written.rows} points, {written.operations} operations", file=sys.stderr)
        for subprogram in output_files.other_paths:
            print(f"{Path(target).with_name(subprogram.name)}: a subprogram of {Path(target).name}", file=sys.stderr)
    return 0


def plan_program(
    paths: Sequence[Toolpath],
    machine: Machine,
    control: Control,
    settings: Mapping[str, str],
    force: bool,
    options: PlanOptions,
    capabilities: ControlCapabilities | None = None,
    *,
    explain: bool = False,
) -> tuple[Program, tuple[Decision, ...]]:
    """The program of toolpaths, planned and checked, and why it is so; what speaks against it is said.

    Raises
    ------
    InputError, RefusedError
        When there can be no program, or when it must not run, unless ``force``: then its head says so.
    """
    capabilities = capabilities or control_capabilities(control, settings)
    planned = plan(paths, machine, control.arcs.chord_tolerance, options, capabilities)
    if explain:
        print(*planned.decisions, sep="\n", file=sys.stderr)
    program = Program(machine, control, planned.motions, settings, paths[0].file)
    unwritable = check_program(program)
    errors = [problem for problem in unwritable if problem.severity is Severity.ERROR]
    if errors:
        raise InputError(unwritable)
    print_problems(unwritable)
    blocking = [problem for problem in planned.problems if problem.severity is Severity.ERROR]
    blocking += _missing_reader(machine, control)
    if blocking and not force:
        unproven = _missing_reader(machine, control)
        raise RefusedError(
            (*planned.problems, *unproven, Problem(paths[0].file, 0, "no program is written", "--force writes it"))
        )
    print_problems(planned.problems)
    notices = [f"MUST NOT RUN AS IT IS, written by --force: {problem.what}" for problem in blocking]
    return replace(program, notices=notices), planned.decisions


def _missing_reader(machine: Machine, control: Control) -> list[Problem]:
    """Why a program of this machine can be written but not read back; empty where it can."""
    if readers.can_read(machine):
        return []
    what = f"programs for {control.name} cannot be read back yet: nothing proves this one"
    return [Problem(machine.key, 0, what)]


@dataclass(frozen=True, slots=True, eq=False)
class WrittenProgram:
    """What a written program says of itself, and what its proof holds against it.

    rows, operations  how many points and operations it has
    allowed           half the last digit that each operation prints
    settings          what was asked for besides the CL files
    division          how it was divided into files; None: it is one
    """

    machine: Machine
    rows: int
    operations: int
    allowed: "list[Tolerances]"
    settings: "Settings"
    division: SubprogramOutput | None = None


@contextmanager
def run_while_writing(
    output_files: OutputFiles, machine: Machine, division: SubprogramOutput | None
) -> "Iterator[tuple[WriteProgress, Future[Run | None]]]":
    """Run a program while it is being written, and get ready for that before: what runs it is imported meanwhile.

    Gives who wants to know how far the program is written, and the run, complete when the block has ended; None where
    nobody can read such programs. The run is of what can be read under the path of what is made, as if it had waited
    for the end. A program of several files is waited for: its calls stand before what they call.
    """
    write_progress = WriteProgress()
    with ThreadPoolExecutor(1) as executor:
        run = executor.submit(_run_program, output_files, machine, write_progress, division)
        try:
            yield write_progress, run
            output_files.start_sync()
        finally:
            write_progress.finish()


def _run_program(
    output_files: OutputFiles, machine: Machine, write_progress: WriteProgress, division: SubprogramOutput | None
) -> Run | None:
    from trunnion import verification

    if not readers.can_read(machine):
        return None
    load(*readers.KERNELS, *verification.KERNELS)
    if division is not None:
        write_progress.wait_until_finished()
    return run_program(output_files.path, machine, subprograms=output_files.other_paths, write_progress=write_progress)


def write_for_proof(
    program: Program,
    sink: BinaryIO,
    options: PlanOptions | None = None,
    write_progress: WriteProgress | None = None,
    division: SubprogramOutput | None = None,
) -> WrittenProgram:
    """Write a program; what comes back is all that its proof needs, with the tolerances that were asked for.

    ``write_progress`` is told how much of it can be read back.
    """
    rows, done = sum(len(motion.operation.moves) for motion in program.motions), 0
    with progress("writing", rows, "points") as advance:

        def written(points: int) -> None:
            nonlocal done
            advance(points)
            done += points
            if write_progress is not None:
                sink.flush()
                write_progress.advance(sink.tell(), sink.tell() * rows // done)

        write_program(program, sink, written, division)
    sink.flush()
    operations = sum(motion.starts_operation for motion in program.motions)
    return WrittenProgram(
        program.machine,
        rows,
        operations,
        program_tolerances(program),
        _expected_settings(program, options or PlanOptions()),
        division,
    )


def prove_program(
    written: WrittenProgram,
    run: Run | None,
    paths: Sequence[Toolpath],
    output_files: OutputFiles,
    target: str,
    forced_program: Program | None = None,
    report: str | None = None,
    decisions: Sequence[Decision] = (),
) -> None:
    """Compare what a program does with its toolpaths; one line a check.

    Parameters
    ----------
    claim
        Of ``write_for_proof``.
    run
        The program as it was read back and run; None: nobody can.
    paths
        What the program was made from.
    made
        Where the program is written.
    target
        What messages call the program.
    again
        The program, if it is to be written though a check fails: then its head says which.
    report
        File of the report.
    decisions
        What the report says of the planning.

    Raises
    ------
    RefusedError
        When a check fails and there is no program to write again.
    """
    from trunnion.verification import check_lines, failures, place_lines, time_lines, verify

    if run is None:
        what = "it is written by --force, and nothing has been checked" + (": there is no report" if report else "")
        print_problems([Problem(target, 0, what, severity=Severity.WARNING)])
        return
    verification = verify(run, paths, tolerances=written.allowed, settings=written.settings, columns=bool(report))
    verification = replace(verification, program="the program" if target == "-" else target)
    for line in (*check_lines(verification), *place_lines(verification, failed_only=True), *time_lines(verification)):
        print(line, file=sys.stderr)
    if not decisions and _exceeds_rotary_speed(verification):
        print(
            f"{verification.program}: a rotary axis cannot follow the feed everywhere;"
            " --explain says where, and what helps",
            file=sys.stderr,
        )
    if report:
        save_report(verification, report, decisions)
    failed = failures(verification)
    if failed and forced_program is None:
        what = f"the program does not do what this file asks for: {', '.join(check.key for check in failed)}"
        raise RefusedError(Problem(paths[0].file, 0, what, "no program is written; --force writes it"))
    if failed and forced_program is not None:
        notices = [f"MUST NOT RUN AS IT IS, written by --force: {check.title}: {check.summary}" for check in failed]
        output_files.restart()
        write_program(
            replace(forced_program, notices=[*forced_program.notices, *notices]),
            output_files.main,
            subprograms=written.division,
        )


def _exceeds_rotary_speed(verification: "Verification") -> bool:
    """Whether a rotary axis would have to be faster than it can."""
    names = tuple(f"{axis.name} " for axis in verification.machine.axes if axis.is_rotary)
    return any(
        c.key == "speed" and any(place.text.startswith(names) for place in c.places) for c in verification.checks
    )


def _expected_settings(program: Program, options: PlanOptions) -> "Settings":
    """What the settings of the run say that the CL files do not."""
    from trunnion.verification import Settings

    led = any(motion.mode is MachiningMode.WITHOUT_TCP for motion in program.motions)
    axis = (
        options.axis_tolerance_between_points if led or math.isfinite(options.axis_tolerance_between_points) else None
    )

    values = {**program.control.settings, **{key: value for key, value in program.settings.items() if value}}
    rate = program.control.formats.get("inverse_time")
    offset = values["work_offset"].strip().upper().removeprefix("G")
    more = re.fullmatch(r"54\.1 *P0*(\d{1,3})", offset)
    offset = str(600 + int(more[1])) if more else offset
    return Settings(
        tool=values["tool"].strip('"'),
        work_offset=int(offset) if offset.isdigit() else None,
        edge=int(values["edge"]) if "edge" in values else None,
        span=axis,
        span_tip=options.tip_tolerance if led else None,
        absolute=options.absolute_frame,
        max_inverse_time_feed=rate.five_axis.greatest if rate else None,
        max_feed=program.control.formats["feed"].five_axis.greatest,
        rapid_feed=float(values["rapid_feed"]) if values.get("rapid_feed") else None,
    )


def print_problems(problems: Sequence[Problem]) -> None:
    """Print problems, one a line."""
    for problem in problems:
        print(problem, file=sys.stderr)


def _files_by_target(arguments: argparse.Namespace, control: Control) -> dict[str, list[str]]:
    """Which program is made from which CL files."""
    output = arguments.output
    if output == "-":
        return {"-": arguments.files}
    folder = output is not None and (Path(output).is_dir() or output.endswith(("/", os.sep)))
    if output is not None and not folder:
        return {output: arguments.files}
    if output is None and len(arguments.files) > 1:
        raise InputError(Problem("post", 0, "several CL files, and no output named", "write --output FILE or FOLDER"))
    into = Path(output or ".")
    if not into.is_dir():
        raise InputError(Problem(str(into), 0, "is no folder", "make it first"))
    targets: dict[str, list[str]] = {}
    for file in arguments.files:
        targets.setdefault(str(into / (Path(file).stem + control.extension)), []).append(file)
    twice = next((files for files in targets.values() if len(files) > 1), None)
    if twice:
        raise InputError(Problem(twice[1], 0, f"would write over the program of {twice[0]}", "rename one of them"))
    return targets
