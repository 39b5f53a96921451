"""``trunnion verify``: an NC program, read back by an author of its own, run, and compared with its CL files."""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.controls import load_control
from trunnion.errors import InputError, Problem
from trunnion.machines import Machine, load_machine
from trunnion.model.motion import Decision

if TYPE_CHECKING:
    from trunnion.verification import Verification

#: What a report's name may end in.
_REPORTS = (".html", ".json")


def run(arguments: argparse.Namespace) -> int:
    """Verify one program."""
    from trunnion.cl import read_cl
    from trunnion.cli.settings import apply_setup
    from trunnion.readers import reader_of, run_program
    from trunnion.verification import Settings, Tolerances, check_lines, place_lines, time_lines, verify

    if arguments.report:
        check_report_name(arguments.report)
    machine = load_machine(arguments.machine)
    reader_of(machine)
    given = {"zero": arguments.zero, "tool_length": arguments.tool_length}
    machine = apply_setup(machine, {key: value for key, value in given.items() if value})
    usual = default_settings(machine)
    paths = [read_cl(Path(file), units=arguments.units) for file in arguments.cl]
    done = run_program(Path(arguments.file), machine, subprograms=[Path(file) for file in arguments.subprograms])
    if len(done.normals):
        from trunnion.cl.surface_normals import with_normals

        paths = [with_normals(path) for path in paths]
    verification = verify(
        done,
        paths,
        tolerances=Tolerances(
            tip=arguments.tolerance, angle=arguments.tolerance, chord=max(0.001, arguments.tolerance)
        ),
        settings=Settings(
            tool=arguments.tool,
            work_offset=_work_offset_number(arguments.offset, usual.get("work_offset", "G54"), bool(paths)),
            edge=int(usual["edge"]) if arguments.edge is None and paths and "edge" in usual else arguments.edge,
            span=arguments.span,
            span_tip=arguments.span_tip,
            absolute=arguments.frame == "absolute",
            rapid_feed=rapid_feed_of(machine),
        ),
        columns=bool(arguments.report),
    )
    print(*check_lines(verification), *place_lines(verification), *time_lines(verification), sep="\n")
    if arguments.report:
        save_report(verification, arguments.report)
    return 0 if verification.passed else 1


def check_report_name(file: str) -> None:
    """Raise ``InputError`` for a report of a kind that there is not, before any work."""
    if Path(file).suffix.lower() not in _REPORTS:
        raise InputError(Problem(file, 0, "a report is a page or data", f"let its name end in {' or '.join(_REPORTS)}"))


def save_report(verification: "Verification", file: str, decisions: Sequence[Decision] = ()) -> None:
    """Write the report of a verification, with what the planner decided."""
    from trunnion.reporting import write_report

    write_report(verification, Path(file), decisions=decisions)


def default_settings(machine: Machine) -> Mapping[str, str]:
    """The settings of a control's definition; those of most where its programs can be read but not written."""
    try:
        return load_control(machine.control.unread_copy()).settings
    except InputError:
        return {"edge": "1"}


def rapid_feed_of(machine: Machine) -> float | None:
    """The feed that stands for rapid motion on a machine, mm/min; None where rapids are rapids."""
    usual = default_settings(machine).get("rapid_feed")
    return float(usual) if usual else None


def _work_offset_number(text: str | None, usual: str, with_cl: bool) -> int | None:
    if text is None:
        code = usual.removeprefix("G")
        return int(code) if with_cl and code.isdigit() else None
    code = text.strip().upper().removeprefix("G")
    if not code.isdigit():
        raise InputError(Problem("--offset", 0, f"is {text!r}", "write it as the program does, such as G54"))
    return int(code)
