"""``trunnion test``: whether the cases of a shop still come out as they did."""

from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

from trunnion.cli.printing import print_result, tell
from trunnion.cli.results import show
from trunnion.cli.wording import in_words, line, part, problem_line, problem_lines, spoken
from trunnion.errors import InputError, RefusedError, TrunnionError
from trunnion.jobs.job import Given
from trunnion.jobs.post_project.cases import Case, ChangedProgram, find_cases, posted_case
from trunnion.messages import Wording
from trunnion.verification.comparison.result import Comparison
from trunnion.wording import one_line


def run(given: Given) -> int:
    """Post every case, and compare; 0 if all of them are as they were, or accepted."""
    paths = find_cases(Path(given.folder))
    became, code, outcomes = Counter[str](), 0, list[dict[str, object]]()
    for path in paths:
        outcome, own = _test(path, accept=given.accept, quiet=given.json == "-")
        outcomes.append({"case": path.as_posix(), "outcome": outcome})
        became[outcome] += 1
        code = max(code, own)
    parts = tuple(part(f"count_{outcome.replace(' ', '_')}", count=count) for outcome, count in became.items())
    data = {"schema": 1, "passed": code == 0, "cases": outcomes}
    show(given, lambda: data, [line("cases_in_all", count=len(paths), parts=parts)])
    if code and not given.accept and became["different"] + became["new"]:
        folder = f'"{given.folder}"' if " " in given.folder else given.folder
        tell(line("accept_takes_over", folder=folder))
    return code


def _test(path: Path, *, accept: bool, quiet: bool) -> tuple[str, int]:
    """Return what became of a case, and the exit code that it alone would have."""
    said = tell if quiet else print_result  # data on stdout stands alone
    with posted_case(path) as case:
        tell(*map(problem_line, case.warnings))
        if case.error is not None:
            return _tell_error(case, case.error, said)
        outcome = _outcome(case)
        said(*map(one_line, _lines(case, outcome)))
        if not accept:
            return outcome, 0 if case.passed else 1
        try:
            accepted = case.accept()
        except TrunnionError as error:
            return _tell_error(case, error, said)
        left = len(case.gone) - len(accepted.removed)
        if accepted.written:
            names = tuple(file.name for file in accepted.written)
            said(one_line(line("case_accepted", case=str(path), names=names)))
        if accepted.removed:
            names = tuple(file.name for file in accepted.removed)
            said(one_line(line("case_removed", case=str(path), names=names)))
        if left or case.passed:
            return outcome, 1 if left else 0
        return "accepted", 0


def _tell_error(case: Case, error: TrunnionError, said: Callable[[str], None]) -> tuple[str, int]:
    tell(*problem_lines(error.problems))
    is_refused = isinstance(error, RefusedError)
    said(one_line(line("case_refused" if is_refused else "case_not_tested", case=str(case.path))))
    assert is_refused or isinstance(error, InputError)
    return ("refused", 1) if is_refused else ("not tested", 2)


def _outcome(case: Case) -> str:
    if any(each.text for program in case.changed for each in program.files):
        return "different"
    return "new" if case.changed else "different" if case.papers or case.gone else "same"


def _lines(case: Case, outcome: str) -> Iterator[str]:
    """Yield a case in lines."""
    if outcome == "same":
        yield line("case_same", case=str(case.path), names=tuple(file.name for file in case.same))
        return
    for program in case.changed:
        yield line(f"case_{outcome}", case=str(case.path), files=tuple(_of_files(program)))
        if any(each.text for each in program.files):
            first, *more = _motion_lines(program.motion)
            yield f"  {line('case_motion', motion=first)}"
            yield from (f"  {each}" for each in more)
        for each in program.files:
            if each.text is not None:
                yield from (f"  {shown}" for shown in each.text.lines)
                if each.text.is_cut:
                    yield f"  {line('and_so_on')}"
    for paper in case.papers:
        yield line("case_paper", case=str(case.path), file=paper.file.name, why=paper.why)
    for file in case.gone:
        yield line("case_gone", case=str(case.path), file=file.name)


def _motion_lines(motion: Comparison | Wording | None) -> list[str]:
    """Return how a program moves against the one that is there."""
    return list(motion.lines(spoken())) if isinstance(motion, Comparison) else [in_words(motion)] if motion else [""]


def _of_files(program: ChangedProgram) -> Iterator[Wording]:
    for each in program.files:
        if each.text is None:
            yield part("file_is_new", file=each.file.name)
        else:
            yield part("file_text", file=each.file.name, summary=each.text.summary)
