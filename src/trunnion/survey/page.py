"""A survey as content of its page."""

from collections.abc import Callable

from trunnion.errors import Problem
from trunnion.reporting.survey_page import BlockerRow, FileRow, RateRow, SurveyContent, render_survey_page
from trunnion.survey.found_files import FileKind
from trunnion.survey.result import Became, Survey, SurveyedFile, Trying


def survey_page(found: Survey, spoken: Callable[[str], str] = str) -> bytes:
    """Return the page of a survey; ``spoken`` puts messages into the words of who reads them."""
    tried = [file for file in found.files if file.tries]
    through = [file for file in tried if file.passes == len(file.tries)]
    some = [file for file in tried if 0 < file.passes < len(file.tries)]
    facts = [
        ("Files", str(len(found.files))),
        ("Tried", str(len(tried))),
        ("Went through", str(len(through))),
        ("On some machines", str(len(some))),
        ("Not ours, or not tried", str(len(found.files) - len(tried))),
        ("Time for each on a machine", f"{found.timeout:g} s"),
    ]
    return render_survey_page(
        SurveyContent(
            found.folder,
            facts,
            [(each.machine, each.control) for each in found.machines if each.posts],
            [each.machine for each in found.machines if not each.posts],
            [
                RateRow(str(each.kind), each.looks, each.control, each.files, each.passed, _became(each.became))
                for each in found.rates
            ],
            [
                BlockerRow(each.code, each.files, each.opens, _place(each.first), spoken(each.first.what),
                           spoken(each.cure))
                for each in found.blockers
            ],
            [_row(file, spoken) for file in found.files],
        )
    )  # fmt: skip


def _became(counts: object) -> str:
    assert isinstance(counts, dict)
    return ", ".join(f"{count} {name}" for name, count in counts.items())


def _place(problem: Problem) -> str:
    return f"{problem.file}:{problem.line}" if problem.line else problem.file


def _row(file: SurveyedFile, spoken: Callable[[str], str]) -> FileRow:
    proven = (Became.PROVEN, Became.PROVEN_WARNED)
    is_proven = bool(file.tries) and all(each.became in proven for each in file.tries)
    kind = str(file.kind) if file.kind is not FileKind.OTHER else ""
    through = f"{file.passes} of {len(file.tries)}" if file.tries else ""
    reasons = [_reason(each, spoken, len(file.tries) > 1) for each in file.tries if not each.became.passed]
    return FileRow(file.file, kind, file.looks, str(file.became), is_proven, bool(file.passes), through, reasons)


def _reason(each: Trying, spoken: Callable[[str], str], names_machine: bool) -> str:
    machine = f"{each.machine}: " if names_machine else ""
    if not each.errors:
        return f"{machine}{each.became} {', '.join(each.codes)}".rstrip()
    first = each.errors[0]
    line = f"line {first.line}: " if first.line else ""
    cure = f"; {spoken(first.cure)}" if first.cure else ""
    return f"{machine}{line}{spoken(first.what)}{cure} [{first.code}]"
