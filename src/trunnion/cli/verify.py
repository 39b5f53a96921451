"""``trunnion verify``: an NC program, read back by an independent reader, run, and compared with its CL files."""

import argparse

from trunnion.api.reports import check_report_name, write_report
from trunnion.api.verifying import verify
from trunnion.verification import check_lines, place_lines, time_lines


def run(arguments: argparse.Namespace) -> int:
    """Verify one program; 0 if every check has passed, else 1."""
    if arguments.report:
        check_report_name(arguments.report)
    verification = verify(
        arguments.file,
        machine=arguments.machine,
        cl=arguments.cl,
        subprograms=arguments.subprograms,
        tolerance=arguments.tolerance,
        span=arguments.span,
        span_tip=arguments.span_tip,
        tool=arguments.tool,
        work_offset=arguments.offset,
        edge=arguments.edge,
        units=arguments.units,
        frame=arguments.frame,
        zero=arguments.zero or None,
        tool_length=arguments.tool_length or None,
        columns=bool(arguments.report),
    )
    print(*check_lines(verification), *place_lines(verification), *time_lines(verification), sep="\n")
    if arguments.report:
        write_report(verification, arguments.report)
    return 0 if verification.passed else 1
