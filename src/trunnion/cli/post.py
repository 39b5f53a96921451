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

import numpy as np

from trunnion import reader
from trunnion.cli.progress import progress
from trunnion.cli.settings import RUN_SETTINGS, check_settings, division_of, set_up, wishes_of
from trunnion.cli.verify import check_report
from trunnion.cli.verify import report as write_report
from trunnion.control import Control, Division, Program, check_program, load_control, write_program
from trunnion.control.definition import SURFACE_NORMAL
from trunnion.control.family import CENTRE_DIGITS
from trunnion.control.standing import inside_limits
from trunnion.errors import InputError, Problem, Refused, Severity
from trunnion.files import Growing, Output, output
from trunnion.kernels import load
from trunnion.machine import Machine, load_machine
from trunnion.nc import KERNELS as WRITING
from trunnion.plan import KERNELS as PLANNING
from trunnion.plan import Decision, Manner, Motion, Wishes, plan
from trunnion.plan.arcs import off_circle
from trunnion.toolpath import CycleOn, Toolpath

if TYPE_CHECKING:
    from trunnion.verify import Allowed, Settings, Verification

#: A turn of the rotary axes turns the tool axis by no less than this part of it, however near the pole.
_LEAST_LEVER = 1e-3


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
    if reader.can_read(machine):
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
) -> "Iterator[tuple[Growing, Future[reader.Run | None]]]":
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


def _run(made: Output, machine: Machine, growing: Growing, division: Division | None) -> reader.Run | None:
    from trunnion import verify  # wanted next, and no kernel waits for it here

    if not reader.can_read(machine):
        return None
    load(*reader.KERNELS, *verify.KERNELS)
    if division is not None:
        growing.wait()
    return reader.run_program(made.path, machine, subprograms=made.others, growing=growing)


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
    return Claim(program.machine, rows, operations, _allowed(program), _asked(program, wishes or Wishes()), division)


def prove(
    claim: Claim,
    run: reader.Run | None,
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
    from trunnion.verify import check_lines, failures, place_lines, time_lines, verify

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


def _allowed(program: Program) -> "list[Allowed]":
    """Half the last digit that each operation prints; in a tilted plane, what that comes to in the program's frame."""
    from trunnion.verify import Agreed, Allowed

    control, machine = program.control, program.machine
    primary, secondary = machine.axes[machine.primary].name, machine.axes[machine.secondary].name
    allowed: list[Allowed] = []
    for motion in program.motions:
        words = control.block_words(primary, secondary, motion.three_axis)
        half = {word.key: 0.5 * 10.0**-word.format.decimals + 1e-9 for word in words}
        tip, angle = half["X"], max(half["primary"], half["secondary"])
        normal = half.get(SURFACE_NORMAL[0], 0.0)
        # Near a pole angles are noisy, and the check takes the ways of the tool axis for straight.
        angle += 1e-8 + angle * math.radians(angle) / _LEAST_LEVER
        if motion.plane is not None and control.plane_from_pose:
            # Places are worked out for the plane as it is printed; only circles stay in it that are not quite in it.
            widest = float(motion.operation.arcs.radius.max(initial=0.0))
            tip = _in_plane(motion, tip, 0.0) + 2.0 * widest * math.radians(2.0 * angle)
        elif motion.plane is not None:
            turning = control.number_formats(three_axis=False)["plane_angle"].decimals
            tilt = max(angle, 1.5 * 10.0**-turning)  # three angles of a plane, or a rotary position
            if inside_limits(machine, motion, turning) is not motion:
                tilt += 1.5 * 10.0**-turning
            tip, angle = _in_plane(motion, tip, tilt), math.sqrt(2.0) * tilt + 1e-8
            normal = math.sqrt(3.0) * (normal + math.radians(tilt))
        if "arc_angle" in half:
            tip += _by_angles(motion, half["X"], half["arc_angle"])
        if motion.manner is Manner.TCP and any(isinstance(event, CycleOn) for event in motion.operation.events):
            # Heights of holes are printed along their axes from the zero, which rounded rotary positions turn.
            tip += math.radians(angle) * float(np.abs(motion.operation.moves.tip).max())
        if motion.manner is Manner.WITHOUT_TCP:
            tip *= math.sqrt(3.0)  # three slides are rounded, and turned parts look at them aslant
        if not motion.begins:
            before = allowed.pop()
            tip, angle, normal = max(tip, before.tip), max(angle, before.angle), max(normal, before.normal)
        apart = motion.departures
        agreed = Agreed(apart.lean, apart.leaned, apart.rotary, apart.slowed, apart.feed) if len(apart) else None
        found = 2.0 * CENTRE_DIGITS * half["X"] if control.arcs_by_radius else 0.0
        allowed.append(
            Allowed(
                tip,
                angle,
                control.chord_tolerance,
                half["feed"],
                agreed,
                centre=found,
                normal=normal,
                plane=motion.plane is not None,
            )
        )
    return allowed


def _by_angles(motion: Motion, half: float, angle: float) -> float:
    """How much farther the ends of helices may be off that are said by a centre and an angle, mm.

    Start and centre are rounded by ``half`` mm, of which the end has that of the centre twice, once turned; the angle
    by ``angle`` degrees. What the CL file's own end is off the circle comes on top. A helix right behind another begins
    where that one has really ended.
    """
    operation = motion.as_written()
    arcs, tip = operation.arcs, operation.moves.tip
    rises = (arcs.turns > 0) | (np.abs(tip[arcs.row, 2] - tip[arcs.row - 1, 2]) > 0.5 * half)
    if not rises.any():
        return 0.0
    rounded = half * (1.0 + math.sqrt(2.0)) + float(np.abs(off_circle(operation)[rises]).max())
    each = rounded + math.radians(angle) * float(arcs.radius[rises].max())
    row = arcs.row[rises]
    ends = np.flatnonzero(np.append(np.diff(row) != 1, True))
    return each * int(np.diff(ends, prepend=-1).max())


def _in_plane(motion: Motion, half: float, tilt: float) -> float:
    """How far a coordinate may be off where ``half`` is, in each coordinate of the plane and of its origin, mm, and
    the plane itself by ``tilt`` degrees."""
    assert motion.plane is not None
    reach = float(np.abs(motion.as_written().moves.tip).max())
    rounded = half * (1.0 + float(np.abs(motion.plane.matrix()).sum(axis=1).max()))
    return rounded + float(np.radians(tilt)) * reach * math.sqrt(3.0)


def _asked(program: Program, wishes: Wishes) -> "Settings":
    """What the settings of the run say that the CL files do not."""
    from trunnion.verify import Settings

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
