"""The work on one file: bytes in, bytes out, in a folder of its own that is gone afterwards.

It is the same on this computer and on another one, and leaves nothing behind: neither files nor notes in the user's
cache. It raises nothing that has to do with the file.
"""

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory
from typing import Any, Final

from trunnion.batch.jobs import shipped_machine
from trunnion.batch.result_keys import program_version
from trunnion.batch.share_seals import BrokenSealError, unsealed_all
from trunnion.batch.summary_figures import block_count, point_count, simulation_figures, verification_figures
from trunnion.batch.worker_task import (
    DEFINITIONS,
    FILES,
    MOST_PROBLEMS,
    SHARE_FILE,
    Action,
    Costs,
    OtherVersionError,
    Outcome,
    Status,
    Task,
)
from trunnion.batch.workers import damaged, hindered, hindrance, shown
from trunnion.errors import Problem, RefusedError, Severity, TrunnionError
from trunnion.files import output_group
from trunnion.jobs.convert.converting import convert_beside
from trunnion.jobs.observer import Observer
from trunnion.jobs.post.posting import Work, post_beside
from trunnion.jobs.post.result import ProofFailedError
from trunnion.jobs.registry import JOBS
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.jobs.simulate.shares import join_shares, simulate_share
from trunnion.jobs.simulate.simulating import simulate
from trunnion.jobs.verify.reports import write_report
from trunnion.jobs.verify.verifying import verify
from trunnion.machines import Machine
from trunnion.messages import Wording, foreign
from trunnion.options.kinds import FileIn
from trunnion.simulation.cutting.shares import DamagedShareError, Share
from trunnion.verification import Check, Verification

#: Arguments that may name files.
_NAMING: Final = frozenset(
    option.name for action in Action for option in JOBS[action].flags if isinstance(option.kind, FileIn)
)


#: The check that fails where something is not understood.
_WORDS: Final = "words"

#: The folder of what comes of a task, within its own.
_RESULT: Final = "result"


class _Collector(Observer):
    """Keeps what is warned of."""

    def __init__(self) -> None:
        self.found: list[Problem] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        self.found += problems


def work(task: Task) -> Outcome:
    """Do the work on one file.

    Raises ``OtherVersionError`` if this process has another version of Trunnion than the task asks for.
    """
    if task.program != program_version():
        raise OtherVersionError(f"a worker has Trunnion {program_version()}, and this computer {task.program}")
    started, used = time.perf_counter(), time.process_time()
    try:
        with TemporaryDirectory(prefix="trunnion-", ignore_cleanup_errors=True) as folder:
            found = _work_in(Path(folder).resolve(), task)
    except OSError as error:
        if (why := hindrance(error)) is None:
            raise
        found = Outcome(Status.HINDERED, (hindered(task.file, why),))
    costs = Costs(time.process_time() - used, time.perf_counter() - started)
    return replace(found, costs=costs + task.spent)


def _work_in(folder: Path, task: Task) -> Outcome:
    paths = _lay_out(folder, {**task.shared, **task.files})
    result = folder / _RESULT
    result.mkdir()
    collector = _Collector()
    figures: dict[str, Any] = {}
    doing = partial(_DOING[task.action], task, paths[task.file], _with_paths(task.arguments, folder), result)
    status, own = _done(partial(doing, figures, collector), task.file, figures)
    files = _files_to_keep(result, task, status, folder)
    judged = task.action in (Action.VERIFY, Action.SIMULATE)
    programs = [task.files[task.file]] if judged else [data for name, data in files.items() if name != task.report]
    if programs and status in (Status.PASSED, Status.FAILED):
        figures["blocks"] = block_count(programs)
    problems = dict.fromkeys((*own, *collector.found))
    errors = [problem for problem in problems if problem.severity is Severity.ERROR]
    warnings = [problem for problem in problems if problem.severity is not Severity.ERROR]
    if codes := [code for code in dict.fromkeys(problem.code for problem in warnings) if code]:
        figures["warning_codes"] = codes
    if errors:
        figures["error_codes"] = dict(Counter(problem.code for problem in errors))
    kept = tuple(_without_folder(problem, folder) for problem in _some([*errors, *warnings]))
    return Outcome(status, kept, len(warnings), files, figures)


def _done(doing: Callable[[], "_Done"], file: str, figures: dict[str, Any]) -> "_Done":
    """Do the work; what stopped it is its outcome."""
    try:
        return doing()
    except (DamagedShareError, BrokenSealError) as error:
        return Status.HINDERED, [damaged(file, str(error))]
    except RefusedError as error:
        if isinstance(error, ProofFailedError) and error.result.verification is not None:
            _add_proof(figures, error.result.verification, error.result.toolpaths)
        return Status.FAILED, error.problems
    except Exception as error:
        if (why := hindrance(error)) is not None:
            return Status.HINDERED, [hindered(file, why)]
        if isinstance(error, TrunnionError):
            return Status.UNUSABLE, error.problems
        return Status.BROKEN, (_broken(file, error),)


def _files_to_keep(result: Path, task: Task, status: Status, folder: Path) -> dict[str, bytes]:
    """Return what came of a task; of one that did not pass, only its report."""
    files = {each.name: each.read_bytes() for each in sorted(result.iterdir()) if each.is_file()}
    if status is not Status.PASSED:
        files = {name: data for name, data in files.items() if name == task.report}
    if task.report in files:
        files[task.report] = _told(files[task.report].decode(), folder).encode()
    return files


def _some(problems: Sequence[Problem]) -> list[Problem]:
    """Return so many problems as are kept, with the first of each code."""
    firsts = {problem.code: problem for problem in reversed(problems)}
    others = [problem for problem in problems if firsts[problem.code] is not problem]
    kept = {*map(id, [*firsts.values(), *others][:MOST_PROBLEMS])}
    return [problem for problem in problems if id(problem) in kept]


def _broken(file: str, error: Exception) -> Problem:
    return Problem(shown(file), 0, Wording("BAT330", "trunnion_error_here", name=type(error).__name__, error=error))


def _lay_out(folder: Path, files: Mapping[str, bytes | Path]) -> dict[str, Path]:
    """Write files under their logical names; paths by these."""
    paths = {}
    for name, content in files.items():
        paths[name] = path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            copyfile(content, path)
    return paths


def _with_paths(arguments: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Arguments with the paths of the files that they name, which need not be there: no others are ever opened."""

    def path(value: Any) -> Any:
        if isinstance(value, list | tuple):
            return [path(each) for each in value]
        is_name = isinstance(value, str) and value.startswith((FILES, DEFINITIONS))
        return str(folder / value) if is_name else value

    return {name: path(value) if name in _NAMING else value for name, value in arguments.items()}


def _without_folder(problem: Problem, folder: Path) -> Problem:
    """Return a problem with the names of files as they stand beside the jobs."""
    file, wording = _told(problem.file, folder), problem.wording.changed(lambda text: _told(text, folder))
    return replace(problem, file=file.replace("\\", "/"), wording=wording)


def _told(text: str, folder: Path) -> str:
    """Return a text without the folder of the task in the names of files, also as JSON writes them."""
    for name in (FILES, DEFINITIONS, f"{_RESULT}/"):
        at = str(folder / name)
        for start in (f"{at}/", f"{at}\\", f"{at}\\".replace("\\", "\\\\")):
            text = text.replace(start, "")
    return text


def _machine(given: Machine | str) -> Machine | str:
    """Return a machine that is shipped is loaded once; definitions of others lie in the folder of the task."""
    return given if isinstance(given, Machine) or given.endswith(".toml") else shipped_machine(given)


_Done = tuple[Status, Sequence[Problem]]


def _post(
    task: Task, file: Path, arguments: dict[str, Any], result: Path, figures: dict[str, Any], observer: _Collector
) -> _Done:
    output = result / task.result
    given: Any = {
        **arguments, "output": output, "report": result / task.report if task.report else None, "columns": True,
    }  # fmt: skip
    machine = _machine(given.pop("machine"))
    with output_group(remembers=False) as group:
        found = post_beside(str(file), machine, given, Work(group=group), observer)
    if found.verification is not None:
        _add_proof(figures, found.verification, found.toolpaths)
    return Status.PASSED if found.passed else Status.FAILED, found.problems


def _add_proof(figures: dict[str, Any], found: Verification, toolpaths: Sequence[Any] = ()) -> None:
    figures |= verification_figures(found)
    if toolpaths:
        figures["points"] = point_count(toolpaths)


def _convert(
    task: Task, file: Path, arguments: dict[str, Any], result: Path, figures: dict[str, Any], observer: _Collector
) -> _Done:
    arguments |= {name: _machine(arguments[name]) for name in ("machine", "to_machine") if arguments.get(name)}
    with output_group(remembers=False) as group:
        given: Any = {**arguments, "output": result / task.result}
        found = convert_beside(file, given, observer, group)
    if found.posted is not None and found.posted.verification is not None:
        _add_proof(figures, found.posted.verification, found.posted.toolpaths)
    figures["points"] = point_count([found.toolpath])
    figures["settings"] = {str(key): str(value) for key, value in found.settings.items()}
    return Status.PASSED if found.passed else Status.FAILED, found.problems


def _verify(
    task: Task, file: Path, arguments: dict[str, Any], result: Path, figures: dict[str, Any], observer: _Collector
) -> _Done:
    machine = _machine(arguments.pop("machine"))
    found = verify(file, machine=machine, **arguments, columns=True, observer=observer)
    _add_proof(figures, found)
    if task.report:
        write_report(found, result / task.report)
    return (Status.PASSED, ()) if found.passed else (Status.FAILED, _failures(task.file, found))


def _failures(file: str, found: Verification) -> list[Problem]:
    """Return what is not understood, and a problem of each other check that failed, at its worst place."""
    errors = list[Problem]()
    failed = {check.key: check for check in found.checks if not check.passed}
    if _WORDS in failed and found.run.errors:
        del failed[_WORDS]
        errors = [Problem(each.file or shown(file), each.line, each.wording) for each in found.run.errors]
    return [*errors, *(_failure(file, check) for check in failed.values())]


def _failure(file: str, check: Check) -> Problem:
    line = next((place.nc_line for place in check.places if not place.nc_file), 0)
    return Problem(shown(file), line, foreign(check.summary, "", check.key))


def _simulate(
    task: Task, file: Path, arguments: dict[str, Any], result: Path, figures: dict[str, Any], observer: _Collector
) -> _Done:
    given: Any = {**arguments, "machine": _machine(arguments["machine"]), "threads": 1}
    if task.share is not None:
        (result / SHARE_FILE).write_bytes(simulate_share(file, Share(*task.share), given, observer))
        return Status.PASSED, ()
    if task.shares:
        found = join_shares(file, unsealed_all(task.shares, task.seals), given, observer)
    else:
        found = simulate(file, **given, observer=observer)
    figures |= simulation_figures(found)
    if task.report:
        write_report(replace(found, seconds=0.0), result / task.report)
    if found.passed:
        return Status.PASSED, found.remarks
    return Status.FAILED, [*_findings(task.file, found), *found.remarks]


def _findings(file: str, found: SimulationResult) -> list[Problem]:
    told = [
        Problem(
            shown(file),
            each.line,
            Wording("BAT340", "mm_deep", kind=each.kind, between=tuple(each.between), depth=each.depth),
        )
        for each in found.findings[:MOST_PROBLEMS]
    ]
    if found.gouge is not None and found.gouge.largest > found.limit:
        told.append(Problem(shown(file), 0, Wording("BAT340", "missing_from_part", largest=found.gouge.largest)))
    return told


_DOING: Final[Mapping[Action, Callable[[Task, Path, dict[str, Any], Path, dict[str, Any], _Collector], _Done]]] = {
    Action.POST: _post,
    Action.CONVERT: _convert,
    Action.VERIFY: _verify,
    Action.SIMULATE: _simulate,
}
