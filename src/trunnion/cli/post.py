"""``trunnion post``: CL files in, one proven NC program out (or one each, into a folder)."""

import argparse
import math
import os
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from trunnion.cl import read_cl
from trunnion.cli.progress import progress
from trunnion.control import Control, Program, check_program, load_control, write_program
from trunnion.errors import InputError, Problem, Refused, Severity
from trunnion.files import whole
from trunnion.machine import Machine, load_machine
from trunnion.plan import Clearance, Decision, Manner, Motion, Pole, Surface, Wishes, plan
from trunnion.toolpath import Toolpath

if TYPE_CHECKING:
    from trunnion.verify import Allowed, Settings, Verification

#: Settings that say how to plan.
PLANNING = (
    "manner", "tcp", "tip_tolerance", "axis_tolerance", "frame", "rewind", "clearance", "pole", "pole_angle",
    "lower_feed",
)  # fmt: skip

#: Settings that say how to read, to place and to plan rather than what to print.
RUN_SETTINGS = ("units", "zero", "tool_length", "numbers", *PLANNING)

#: What the setting ``frame`` may say: whose coordinate system the program's is.
_FRAMES = ("first", "absolute")

#: What the setting ``manner`` may say.
_MANNERS = {"auto": None, "three-axis": Manner.THREE_AXIS, "tilted": Manner.TILTED, "tcp": Manner.TCP}


def run(arguments: argparse.Namespace) -> int:
    """Post every CL file."""
    if arguments.report:
        from trunnion.cli.verify import check_report

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
    if arguments.report and len(targets) > 1:
        what = f"one report for {len(targets)} programs"
        raise InputError(Problem(arguments.report, 0, what, "post them one at a time, or leave --report out"))
    for target, files in targets.items():
        with whole(target) as sink:
            paths = [_read(file, settings.get("units"), arguments.strict) for file in files]
            program, decisions = planned_program(
                paths, machine, control, printed, arguments.force, wishes, say_why=arguments.explain
            )
            claim = write(program, sink, wishes)
            # The proof needs nothing of what was planned; only a program that fails and is forced is written again.
            again = program if arguments.force else None
            del program
            said = decisions if wishes.explain else ()
            prove(claim, paths, sink, target, again, arguments.report, said)
        if target != "-":
            print(f"{target}: {claim.rows} points, {claim.operations} operations", file=sys.stderr)
    return 0


def _read(file: str, units: str | None, strict: bool) -> Toolpath:
    path = Path(file)
    size = path.stat().st_size if path.is_file() else 0
    with progress(path.name, size, "B") as advance:
        done = 0

        def so_far(read: int) -> None:
            nonlocal done
            advance(read - done)
            done = read

        toolpath = read_cl(path, units=units, strict=strict, progress=so_far)
    say(toolpath.remarks)
    return toolpath


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
    from trunnion.reader import can_read

    if can_read(machine):
        return []
    what = f"programs for {control.name} cannot be read back yet: nothing proves this one"
    return [Problem(machine.key, 0, what)]


@dataclass(frozen=True, slots=True, eq=False)
class Claim:
    """What a written program says of itself, and what its proof holds against it.

    rows, operations  how many points and operations it has
    allowed           half the last digit that each operation prints
    settings          what was asked for besides the CL files
    """

    machine: Machine
    rows: int
    operations: int
    allowed: "list[Allowed]"
    settings: "Settings"


def write(program: Program, sink: BinaryIO, wishes: Wishes | None = None) -> Claim:
    """Write a program; what comes back is all that its proof needs, with the tolerances that were asked for."""
    rows = sum(len(motion.operation.moves) for motion in program.motions)
    with progress("writing", rows, "points") as advance:
        write_program(program, sink, advance)
    operations = sum(motion.begins for motion in program.motions)
    return Claim(program.machine, rows, operations, _allowed(program), _asked(program, wishes or Wishes()))


def prove(
    claim: Claim,
    paths: Sequence[Toolpath],
    sink: BinaryIO,
    target: str,
    again: Program | None = None,
    report: str | None = None,
    decisions: Sequence[Decision] = (),
) -> None:
    """Read a program back, run it and compare it with its toolpaths; one line a check.

    Parameters
    ----------
    claim
        Of ``write``.
    paths
        What the program was made from.
    sink
        Of ``whole``: what is written can be read back under its name.
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
    from trunnion.cli.verify import report as write_report
    from trunnion.reader import can_read, run_program
    from trunnion.verify import check_lines, failures, place_lines, time_lines, verify

    if not can_read(claim.machine):
        what = "it is written by --force, and nothing has been checked" + (": there is no report" if report else "")
        say([Problem(target, 0, what, severity=Severity.WARNING)])
        return
    sink.flush()
    run = run_program(Path(sink.name), claim.machine)
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
        sink.seek(0)
        sink.truncate()
        write_program(replace(again, notices=[*again.notices, *notices]), sink)


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
        if motion.plane is not None and control.plane_from_pose:
            # Places are worked out for the plane as it is printed; only circles stay in it that are not quite in it.
            widest = float(motion.operation.arcs.radius.max(initial=0.0))
            tip = _in_plane(motion, tip, 0.0) + 2.0 * widest * math.radians(2.0 * angle)
        elif motion.plane is not None:
            turning = control.number_formats(three_axis=False)["plane_angle"].decimals
            tilt = max(angle, 1.5 * 10.0**-turning)  # three angles of a plane, or a rotary position
            tip, angle = _in_plane(motion, tip, tilt), angle + tilt / _lever(motion, machine)
        if motion.manner is Manner.WITHOUT_TCP:
            tip *= math.sqrt(3.0)  # three slides are rounded, and turned parts look at them aslant
        if not motion.begins:
            before = allowed.pop()
            tip, angle = max(tip, before.tip), max(angle, before.angle)
        apart = motion.departures
        agreed = Agreed(apart.lean, apart.leaned, apart.rotary, apart.slowed, apart.feed) if len(apart) else None
        allowed.append(Allowed(tip, angle, control.chord_tolerance, half["feed"], agreed))
    return allowed


def _in_plane(motion: Motion, half: float, tilt: float) -> float:
    """How far a coordinate may be off where ``half`` is, in each coordinate of the plane and of its origin, mm, and
    the plane itself by ``tilt`` degrees."""
    assert motion.plane is not None
    reach = float(np.abs(motion.as_written().moves.tip).max())
    rounded = half * (1.0 + float(np.abs(motion.plane.matrix()).sum(axis=1).max()))
    return rounded + float(np.radians(tilt)) * reach * math.sqrt(3.0)


def _lever(motion: Motion, machine: Machine) -> float:
    """How far a turn of the rotary axis next to the workpiece turns the tool axis: near its pole hardly at all."""
    first = np.array(machine.axes[machine.rotary[0]].direction)
    return max(float(np.linalg.norm(np.cross(first, motion.operation.moves.axis[0]))), 1e-3)


def _asked(program: Program, wishes: Wishes) -> "Settings":
    """What the settings of the run say that the CL files do not."""
    from trunnion.verify import Settings

    led = any(motion.manner is Manner.WITHOUT_TCP for motion in program.motions)
    axis = wishes.axis_between if led or math.isfinite(wishes.axis_between) else None

    values = {**program.control.settings, **{key: value for key, value in program.settings.items() if value}}
    offset = values["work_offset"].strip().upper().removeprefix("G")
    return Settings(
        tool=values["tool"].strip('"'),
        work_offset=int(offset) if offset.isdigit() else None,
        edge=int(values["edge"]) if "edge" in values else None,
        span=axis,
        span_tip=wishes.tip_tolerance if led else None,
        absolute=wishes.absolute,
        rapid_feed=float(values["rapid_feed"]) if values.get("rapid_feed") else None,
    )


def say(problems: Sequence[Problem]) -> None:
    """Print problems, one a line."""
    for problem in problems:
        print(problem, file=sys.stderr)


def check_settings(settings: Mapping[str, str], control: Control) -> None:
    """Raise ``InputError`` for settings that the control does not have, or that make no sense."""
    known = (*control.settings, *RUN_SETTINGS)
    problems = [
        Problem("--set", 0, f"{key} is no setting of {control.name}", f"write one of {', '.join(known)}")
        for key in settings
        if key not in known
    ]
    problems += [
        Problem("--set", 0, f"{key} has a line break or a control character in it", "write it in one line")
        for key, value in settings.items()
        if any(ord(character) < 32 for character in value)
    ]
    if settings.get("rewind", "insert") not in ("insert", "none"):
        problems.append(Problem("--set", 0, f"rewind is {settings['rewind']!r}", "write rewind=insert or rewind=none"))
    if settings.get("tcp", "on") not in ("on", "off"):
        problems.append(Problem("--set", 0, f"tcp is {settings['tcp']!r}", "write tcp=on or tcp=off"))
    for name, cure in control.family.wrong_settings(settings):
        problems.append(Problem("--set", 0, f"{name} is {settings[name]!r}", cure))
    if settings.get("numbers", "on") not in ("on", "off"):
        problems.append(Problem("--set", 0, f"numbers is {settings['numbers']!r}", "write numbers=on or numbers=off"))
    if settings.get("frame", "first") not in _FRAMES:
        cure = f"write one of {', '.join(_FRAMES)}"
        problems.append(Problem("--set", 0, f"frame is {settings['frame']!r}", cure))
    if settings.get("manner", "auto") not in _MANNERS:
        cure = f"write one of {', '.join(_MANNERS)}"
        problems.append(Problem("--set", 0, f"manner is {settings['manner']!r}", cure))
    for name, choices in control.family.CHOICES.items():
        if settings.get(name, choices[0]) not in choices:
            cure = f"write one of {', '.join(choices)}"
            problems.append(Problem("--set", 0, f"{name} is {settings[name]!r}", cure))
    if settings.get("pole", "off") not in list(Pole):
        what = f"pole is {settings['pole']!r}"
        problems.append(Problem("--set", 0, what, f"write pole= and one of {', '.join(Pole)}"))
    if settings.get("lower_feed", "no") not in ("yes", "no"):
        what = f"lower_feed is {settings['lower_feed']!r}"
        problems.append(Problem("--set", 0, what, "write lower_feed=yes or lower_feed=no"))
    if settings.get("units", "mm") not in ("mm", "inch"):
        problems.append(Problem("--set", 0, f"units is {settings['units']!r}", "write units=mm or units=inch"))
    if not settings.get("edge", "1").isdigit():
        problems.append(Problem("--set", 0, f"edge is {settings['edge']!r}", "write a whole number, such as edge=1"))
    if problems:
        raise InputError(problems)


#: Settings that are numbers: their limits, and what to write.
_NUMBERS = {
    "pole_angle": (1e-3, 10.0, "pole_angle=DEG, by how much the tool axis may lean near the pole, such as 0.1"),
    "tip_tolerance": (1e-4, 10.0, "tip_tolerance=MM, how far the tip may be off between points, such as 0.005"),
    "axis_tolerance": (1e-3, 10.0, "axis_tolerance=DEGREES, how far the tool axis may be off, such as 0.05"),
    "tool_length": (0.0, 1e4, "tool_length=MM, from the spindle's gauge point to the tip, such as tool_length=120.5"),
}


def _clearance(text: str) -> Clearance:
    """The setting ``clearance``."""
    kind, _, length = text.rpartition(":")
    try:
        surface, value = Surface(kind or Surface.DISTANCE), float(length)
    except ValueError:
        surface, value = Surface.DISTANCE, math.nan
    least = -10000.0 if surface is Surface.PLANE else 0.1
    if least <= value <= 10000.0:
        return Clearance(value, surface)
    cure = "write clearance=MM, how far the tool draws back for a rewind, such as clearance=50; or plane:Z, sphere:R"
    raise InputError(Problem("--set", 0, f"clearance is {text!r}", cure))


def number(settings: Mapping[str, str], key: str) -> float | None:
    """A setting that is a number; None where nobody set it.

    Raises
    ------
    InputError
        If it is none, or beyond what makes sense.
    """
    text = settings.get(key)
    if text is None:
        return None
    low, high, cure = _NUMBERS[key]
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise InputError(Problem("--set", 0, f"{key} is {text!r}", f"write {cure}"))
    return value


def set_up(machine: Machine, settings: Mapping[str, str]) -> Machine:
    """The machine with its workpiece and its tool where the settings say so."""
    if "zero" in settings:
        machine = replace(machine, workpiece_zero=point(settings["zero"]))
    length = number(settings, "tool_length")
    return machine if length is None else replace(machine, tool_length=length)


def wishes_of(settings: Mapping[str, str], control: Control, explain: bool = False) -> Wishes:
    """What the settings, checked by ``check_settings``, say to the planner."""
    tcp = settings.get("tcp", "on" if control.tcp else "off") == "on"
    if tcp and not control.tcp:
        raise InputError(Problem("--set", 0, "tcp is on, and the machine's control has none", "write tcp=off"))
    if not tcp and settings.get("manner") == "tcp":
        raise InputError(Problem("--set", 0, "manner is tcp, and there is no TCP", "leave the setting manner out"))
    said = {key: number(settings, key) for key in ("pole_angle", "tip_tolerance", "axis_tolerance")}
    known: dict[str, Any] = {key: value for key, value in said.items() if value is not None}
    if "clearance" in settings:
        known["clearance"] = _clearance(settings["clearance"])
    return Wishes(
        rewind=settings.get("rewind", "insert") == "insert",
        explain=explain,
        manner=_MANNERS[settings.get("manner", "auto")],
        manners=control.manners(settings),
        pole=Pole(settings.get("pole", "off")),
        absolute=settings.get("frame", "first") == "absolute",
        lower_feed=settings.get("lower_feed", "no") == "yes",
        helices=control.helices,
        pose_planes=control.plane_from_pose,
        tcp=tcp,
        **known,
    )


def point(text: str) -> tuple[float, float, float]:
    """The setting ``zero``, mm."""
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(
            Problem("--set", 0, f"zero is {text!r}", "write zero=X,Y,Z: the workpiece zero on the machine, mm")
        ) from None
    return x, y, z


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
