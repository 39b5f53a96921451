"""``trunnion verify``: an NC program, read back by an independent reader, run, and compared with its CL files."""

import argparse
from typing import Final

from trunnion.cli.cl_files import cl_inputs, named_files
from trunnion.cli.results import print_result, tell
from trunnion.cli.terminal import Terminal
from trunnion.controls import load_control
from trunnion.errors import InputError, Severity, argument_problem
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import load_machine
from trunnion.jobs.papers.manifests import verify_manifest
from trunnion.jobs.papers.reports import check_report, write_report
from trunnion.jobs.verify.verifying import verify
from trunnion.verification import Verification, check_lines, place_lines, time_lines
from trunnion.wording import counted, one_line

#: Fewer errors do not suggest that the program is for another control.
_MANY_ERRORS: Final = 5


def run(arguments: argparse.Namespace) -> int:
    """Verify one program; 0 if every check has passed, else 1."""
    if arguments.machine is None:
        if arguments.file.lower().endswith(".json"):
            return _run_manifest(arguments)
        raise InputError(
            argument_problem("machine", "is missing", "name the machine that runs the program", code="ARG130")
        )
    machine = load_machine(arguments.machine)
    if arguments.report is not None:
        read = [arguments.file, *named_files(arguments.cl), *arguments.subprograms, *arguments.hooks]
        read += [] if arguments.recorded is None else [arguments.recorded]
        check_report(arguments.report, [*read, *machine_files(arguments.machine, machine)])
    verification = verify(
        arguments.file,
        machine=machine,
        cl=cl_inputs(arguments.cl),
        subprograms=arguments.subprograms,
        tolerance=arguments.tolerance,
        span=arguments.span,
        span_tip=arguments.span_tip,
        tool=arguments.tool,
        work_offset=arguments.offset,
        edge=arguments.edge,
        units=arguments.units,
        dialect=arguments.dialect,
        frame=arguments.frame,
        zero=arguments.zero or None,
        tool_length=arguments.tool_length or None,
        recorded=arguments.recorded,
        recorded_tolerance=arguments.recorded_tolerance,
        feed=arguments.feed or "programmed",
        feed_limit=arguments.feed_limit,
        columns=arguments.report is not None,
        hooks=arguments.hooks,
        turn=arguments.turn or 0.0,
        tilt=arguments.tilt or 0.0,
        observer=Terminal(),
    )
    if hint := _control_hint(verification):
        tell(hint)
    lines = (*check_lines(verification), *place_lines(verification), *time_lines(verification))
    print_result(*map(one_line, lines))
    if arguments.report is not None:
        write_report(verification, arguments.report)
    return 0 if verification.passed else 1


def _run_manifest(arguments: argparse.Namespace) -> int:
    """Compare the files of a post with its manifest; 0 if all are the same and proven, else 1."""
    others = (
        "subprograms",
        "hooks",
        "recorded",
        "report",
        "zero",
        "tool_length",
        "span",
        "span_tip",
        "tool",
        "offset",
        "edge",
        "feed_limit",
        "turn",
        "tilt",
    )
    for name in (*others, "feed_limit", "units", "dialect"):
        if getattr(arguments, name):
            what, cure = "says nothing about a manifest", "leave it out; --cl compares CL files, too"
            raise InputError(argument_problem(name, what, cure, code="ARG130"))
    found = verify_manifest(arguments.file, cl=arguments.cl)
    print_result(*(one_line(str(file)) for file in found.files))
    for name in found.not_compared:
        tell(one_line(f"{name}: not compared, and the program was made from it: --cl FILE compares it"))
    if not found.proven:
        tell(f"{arguments.file}: the program was written by force, and must not run as it is")
    return 0 if found.passed else 1


def _control_hint(verification: Verification) -> str:
    """A question where more blocks have errors than motions: the program may be for another control. Else empty."""
    run, machine = verification.run, verification.machine
    errors = len({one.line for one in run.diagnostics if one.severity is Severity.ERROR})
    if errors < max(_MANY_ERRORS, len(run)):
        return ""
    try:
        control = load_control(machine.control.unread_copy()).name
    except InputError:  # its programs can be read, but not written
        return ""
    return (
        f"{verification.program}: is this a {control} program? {counted(errors, 'line')} of it not understood;"
        f" --machine names the machine that runs it, and {machine.key} has this control"
    )
