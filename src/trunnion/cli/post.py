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
from trunnion.cli.output_tolerances import allowed_of
from trunnion.cli.progress import progress
from trunnion.cli.settings import RUN_SETTINGS, check_settings, division_of, set_up, wishes_of
from trunnion.cli.verify import check_report
from trunnion.cli.verify import report as write_report
from trunnion.controls import Control, load_control
from trunnion.errors import InputError, Problem, Refused, Severity
from trunnion.files import Growing, Output, output
from trunnion.jit import load
from trunnion.machines import Machine, load_machine
from trunnion.model.motion import Decision, Manner
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.output import KERNELS as WRITING
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.output.subprograms import Division
from trunnion.output.validation import check_program
from trunnion.planning import KERNELS as PLANNING
from trunnion.planning import Wishes, plan
from trunnion.readers import run_program

if TYPE_CHECKING:
    from trunnion.verification import Allowed, Settings, Verification


def post(arguments: argparse.Namespace, toolpaths: Iterator[Toolpath]) -> int:
    """Post every CL file; their toolpaths come one after the other."""
    if arguments.report:
        check_report(arguments.report)
    machine = load_machine(arguments.machine)
    control = load_control(machine.control)
    settings = dict(arguments.settings)
    check_settings(settings, control)
    if settings.get("numbers") == "off":
        control = replace(control, numbers=replace(control.numbers, numbered=False))
    machine = set_up(machine, settings)
    printed = {key: value for key, value in settings.items() if key not in RUN_SETTINGS}
    wishes = wishes_of(settings, control, arguments.explain or bool(arguments.report))
    targets = _targets(arguments, control)
    load(*PLANNING, *WRITING)
    import trunnion.verification  # noqa: F401 - wanted for the proof; while the first CL file is read it takes no time

    if arguments.report and len(targets) > 1:
        what = f"one report for {len(targets)} programs"
        raise InputError(Problem(arguments.report, 0, what, "post them one at a time, or leave --report out"))
    for target, files in targets.items():
        with output(target) as made:
            division = division_of(settings, control, target, made)
            paths = list(islice(toolpaths, len(files)))
            if {**control.settings, **settings}.get("normals") == "contact":
                from trunnion.cl.contact import with_normals

                paths = [with_normals(path) for path in paths]
            for path in paths:
                say(path.remarks)
            with running(made, machine, division) as (growing, run):
                program, decisions = planned_program(
                    paths, machine, control, printed, arguments.force, wishes, say_why=arguments.explain
                )
                claim = write(program, made.main, wishes, growing, division)
            # The proof needs nothing of what was planned; only a program that fails and is forced is written again.
            again = program if arguments.force else None
            del program
            said = decisions if wishes.explain else ()
            prove(claim, run.result(), paths, made, target, again, arguments.report, said)
        if target != "-":
            print(f"{target}: {claim.rows} points, {claim.operations} operations", file=sys.stderr)
        for other in made.others:
            print(f"{Path(target).with_name(other.name)}: a subprogram of {Path(target).name}", file=sys.stderr)
    return 0


def planned_program(
    paths: Sequence[Toolpath],
    machine: Machine,
    control: Control,
    settings: Mapping[str, str],
    force: bool,
    wishes: Wishes,
    *,
    say_why: bool = False,
) -> tuple[Program, tuple[Decision, ...]]:
    """The program of toolpaths, planned and checked, and why it is so; what speaks against it is said.

    Raises
    ------
    InputError, Refused
        When there can be no program, or when it must not run, unless ``force``: then its head says so.
    """
    planned = plan(paths, machine, control.chord_tolerance, wishes)
    if say_why:
        print(*planned.decisions, sep="\n", file=sys.stderr)
    program = Program(machine, control, planned.motions, settings, paths[0].file)
    lacking = check_program(program)
    errors = [problem for problem in lacking if problem.severity is Severity.ERROR]
    if errors:
        raise InputError(lacking)
    say(lacking)
    against = [problem for problem in planned.problems if problem.severity is Severity.ERROR]
    against += _unprovable(machine, control)
    if against and not force:
        unproven = _unprovable(machine, control)
        raise Refused(
            (*planned.problems, *unproven, Problem(paths[0].file, 0, "no program is written", "--force writes it"))
        )
    say(planned.problems)
    notices = [f"MUST NOT RUN AS IT IS, written by --force: {problem.what}" for problem in against]
    return replace(program, notices=notices), planned.decisions


def _unprovable(machine: Machine, control: Control) -> list[Problem]:
    """Why a program of this machine can be written but not read back; empty where it can."""
    if readers.can_read(machine):
        return []
    what = f"programs for {control.name} cannot be read back yet: nothing proves this one"
    return [Problem(machine.key, 0, what)]


@dataclass(frozen=True, slots=True, eq=False)
class Claim:
    """What a written program says of itself, and what its proof holds against it.

    rows, operations  how many points and operations it has
    allowed           half the last digit that each operation prints
    settings          what was asked for besides the CL files
    division          how it was divided into files; None: it is one
    """

    machine: Machine
    rows: int
    operations: int
    allowed: "list[Allowed]"
    settings: "Settings"
    division: Division | None = None


@contextmanager
def running(
    made: Output, machine: Machine, division: Division | None
) -> "Iterator[tuple[Growing, Future[Run | None]]]":
    """Run a program while it is being written, and get ready for that before: what runs it is imported meanwhile.

    Gives who wants to know how far the program is written, and the run, complete when the block has ended; None where
    nobody can read such programs. The run is of what can be read under the path of what is made, as if it had waited
    for the end. A program of several files is waited for: its calls stand before what they call.
    """
    growing = Growing()
    with ThreadPoolExecutor(1) as aside:
        run = aside.submit(_run, made, machine, growing, division)
        try:
            yield growing, run
            made.settle()
        finally:
            growing.end()


def _run(made: Output, machine: Machine, growing: Growing, division: Division | None) -> Run | None:
    from trunnion import verification

    if not readers.can_read(machine):
        return None
    load(*readers.KERNELS, *verification.KERNELS)
    if division is not None:
        growing.wait()
    return run_program(made.path, machine, subprograms=made.others, growing=growing)


def write(
    program: Program,
    sink: BinaryIO,
    wishes: Wishes | None = None,
    growing: Growing | None = None,
    division: Division | None = None,
) -> Claim:
    """Write a program; what comes back is all that its proof needs, with the tolerances that were asked for.

    ``growing`` is told how much of it can be read back.
    """
    rows, done = sum(len(motion.operation.moves) for motion in program.motions), 0
    with progress("writing", rows, "points") as advance:

        def written(points: int) -> None:
            nonlocal done
            advance(points)
            done += points
            if growing is not None:
                sink.flush()
                growing.grow(sink.tell(), sink.tell() * rows // done)

        write_program(program, sink, written, division)
    sink.flush()
    operations = sum(motion.begins for motion in program.motions)
    return Claim(program.machine, rows, operations, allowed_of(program), _asked(program, wishes or Wishes()), division)


def prove(
    claim: Claim,
    run: Run | None,
    paths: Sequence[Toolpath],
    made: Output,
    target: str,
    again: Program | None = None,
    report: str | None = None,
    decisions: Sequence[Decision] = (),
) -> None:
    """Compare what a program does with its toolpaths; one line a check.

    Parameters
    ----------
    claim
        Of ``write``.
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
    Refused
        When a check fails and there is no program to write again.
    """
    from trunnion.verification import check_lines, failures, place_lines, time_lines, verify

    if run is None:
        what = "it is written by --force, and nothing has been checked" + (": there is no report" if report else "")
        say([Problem(target, 0, what, severity=Severity.WARNING)])
        return
    found = verify(run, paths, allowed=claim.allowed, settings=claim.settings, columns=bool(report))
    found = replace(found, program="the program" if target == "-" else target)
    for line in (*check_lines(found), *place_lines(found, failed_only=True), *time_lines(found)):
        print(line, file=sys.stderr)
    if not decisions and _too_fast(found):
        print(
            f"{found.program}: a rotary axis cannot follow the feed everywhere; --explain says where, and what helps",
            file=sys.stderr,
        )
    if report:
        write_report(found, report, decisions)
    failed = failures(found)
    if failed and again is None:
        what = f"the program does not do what this file asks for: {', '.join(check.key for check in failed)}"
        raise Refused(Problem(paths[0].file, 0, what, "no program is written; --force writes it"))
    if failed and again is not None:
        notices = [f"MUST NOT RUN AS IT IS, written by --force: {check.title}: {check.summary}" for check in failed]
        made.begin_again()
        write_program(replace(again, notices=[*again.notices, *notices]), made.main, division=claim.division)


def _too_fast(found: "Verification") -> bool:
    """Whether a rotary axis would have to be faster than it can."""
    names = tuple(f"{axis.name} " for axis in found.machine.axes if axis.is_rotary)
    return any(c.key == "speed" and any(place.text.startswith(names) for place in c.places) for c in found.checks)


def _asked(program: Program, wishes: Wishes) -> "Settings":
    """What the settings of the run say that the CL files do not."""
    from trunnion.verification import Settings

    led = any(motion.manner is Manner.WITHOUT_TCP for motion in program.motions)
    axis = wishes.axis_between if led or math.isfinite(wishes.axis_between) else None

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
        span_tip=wishes.tip_tolerance if led else None,
        absolute=wishes.absolute,
        top_rate=rate.five_axis.greatest if rate else None,
        top_feed=program.control.formats["feed"].five_axis.greatest,
        rapid_feed=float(values["rapid_feed"]) if values.get("rapid_feed") else None,
    )


def say(problems: Sequence[Problem]) -> None:
    """Print problems, one a line."""
    for problem in problems:
        print(problem, file=sys.stderr)


def _targets(arguments: argparse.Namespace, control: Control) -> dict[str, list[str]]:
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
