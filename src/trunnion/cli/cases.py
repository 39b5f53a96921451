"""``trunnion test``: whether the cases of a shop still come out as they did."""

from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

from trunnion.cli.printing import print_result, tell
from trunnion.cli.results import show
from trunnion.cli.wording import problem_line, problem_lines
from trunnion.errors import InputError, RefusedError, TrunnionError
from trunnion.jobs.job import Given
from trunnion.jobs.post_project.cases import Case, ChangedProgram, find_cases, posted_case
from trunnion.wording import counted, one_line


def run(given: Given) -> int:
    """Post every case, and compare; 0 if all of them are as they were, or accepted."""
    paths = find_cases(Path(given.folder))
    became, code, outcomes = Counter[str](), 0, list[dict[str, object]]()
    for path in paths:
        outcome, own = _test(path, accept=given.accept, quiet=given.json == "-")
        outcomes.append({"case": path.as_posix(), "outcome": outcome})
        became[outcome] += 1
        code = max(code, own)
    parts = ", ".join(f"{count} {outcome}" for outcome, count in became.items())
    data = {"schema": 1, "passed": code == 0, "cases": outcomes}
    show(given, lambda: data, [f"{counted(len(paths), 'case')}: {parts}"])
    if code and not given.accept and became["different"] + became["new"]:
        folder = f'"{given.folder}"' if " " in given.folder else given.folder
        tell(f"trunnion test {folder} --accept takes the new programs over, once you have looked at them")
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
            said(one_line(f"{path}: accepted: {', '.join(file.name for file in accepted.written)}"))
        if accepted.removed:
            names = ", ".join(file.name for file in accepted.removed)
            said(one_line(f"{path}: removed: {names}; remove it from the control, too"))
        if left or case.passed:
            return outcome, 1 if left else 0
        return "accepted", 0


def _tell_error(case: Case, error: TrunnionError, said: Callable[[str], None]) -> tuple[str, int]:
    tell(*problem_lines(error.problems))
    is_refused = isinstance(error, RefusedError)
    what = "REFUSED: a program must not run" if is_refused else "NOT TESTED: it cannot be posted"
    said(one_line(f"{case.path}: {what}"))
    assert is_refused or isinstance(error, InputError)
    return ("refused", 1) if is_refused else ("not tested", 2)


def _outcome(case: Case) -> str:
    if any(each.text for program in case.changed for each in program.files):
        return "different"
    return "new" if case.changed else "different" if case.papers or case.gone else "same"


def _lines(case: Case, outcome: str) -> Iterator[str]:
    """Yield a case in lines."""
    if outcome == "same":
        yield f"{case.path}: same: {', '.join(file.name for file in case.same)}"
        return
    for program in case.changed:
        yield f"{case.path}: {outcome.upper()}: {'; '.join(_of_files(program))}"
        if any(each.text for each in program.files):
            first, *more = program.motion
            if program.moves:
                yield f"  motion the same: {first.removeprefix('same: ')}"
            else:
                yield f"  motion DIFFERS: {first.removeprefix('different: ')}"
            yield from (f"  {line}" for line in more)
        for each in program.files:
            if each.text is not None:
                yield from (f"  {line}" for line in each.text.lines)
                if each.text.is_cut:
                    yield "  and so on"
    for paper in case.papers:
        yield f"{case.path}: PAPER: {paper.file.name} {paper.why}"
    for file in case.gone:
        yield f"{case.path}: GONE: {file.name} is of an operation that there is no more"


def _of_files(program: ChangedProgram) -> Iterator[str]:
    for each in program.files:
        yield f"{each.file.name} is new" if each.text is None else f"{each.file.name}: text: {each.text.summary}"
