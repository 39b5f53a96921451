"""``trunnion verify``: an NC program, read back by an independent reader, run, and compared with its CL files."""

import io
import json
from typing import Any, Final

from trunnion.cli.printing import tell
from trunnion.cli.results import show
from trunnion.cli.terminal import Terminal, verification_lines
from trunnion.cli.wording import said, spoken
from trunnion.errors import InputError, argument_problem
from trunnion.jobs.inputs.reading import load_machine
from trunnion.jobs.job import Given
from trunnion.jobs.verify.reports import add_report, write_report
from trunnion.jobs.verify.verifying import verify
from trunnion.messages import Wording
from trunnion.verification import Verification
from trunnion.wording import one_line

#: Options that stand beside a manifest.
_OF_MANIFESTS: Final = ("nc", "cl", "json")


def run(given: Given) -> int:
    """Verify one program; 0 if every check has passed, else 1."""
    if given.machine is None:
        if given.nc.lower().endswith(".json"):
            return _run_manifest(given)
        raise InputError(argument_problem("machine", Wording("ARG130", "missing_machine_of_program")))
    verification = verify(
        **{**given.arguments(), "machine": load_machine(given.machine)},
        columns=given.report is not None or given.json is not None,
        observer=Terminal(),
    )
    show(given, lambda: _report_data(verification), verification_lines(verification))
    if given.report is not None:
        write_report(verification, given.report, words=spoken())
    return 0 if verification.passed else 1


def _run_manifest(given: Given) -> int:
    """Compare the files of a post with its manifest; 0 if all are the same and proven, else 1."""
    from trunnion.jobs.post.papers.manifests import verify_manifest  # a program has no need of it

    stated = (each for each in given.job.options if each.name not in _OF_MANIFESTS)
    if wrong := [each for each in stated if given.values[each.name] != each.empty]:
        raise InputError(argument_problem(wrong[0].name, Wording("ARG130", "not_for_manifest")))
    found = verify_manifest(given.nc, cl=given.cl)
    show(given, lambda: found, map(str, found.files))
    for name in found.not_compared:
        tell(one_line(f"{name}: {said('not_compared')}"))
    if not found.proven:
        tell(f"{given.nc}: {said('written_by_force')}")
    return 0 if found.passed else 1


def _report_data(verification: Verification) -> Any:
    """Return what a report of the verification has, as data (docs/report.md)."""
    sink = io.BytesIO()
    add_report(verification, sink, "report.json", None)
    return json.loads(sink.getvalue())
