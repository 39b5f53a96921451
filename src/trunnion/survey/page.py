"""A survey as content of its page."""

from collections.abc import Mapping

from trunnion.errors import Problem
from trunnion.messages import LIBRARY, Words, phrase
from trunnion.reporting.page_words import in_language, on_survey, page_words, told, word
from trunnion.reporting.survey_page import BlockerRow, FileRow, RateRow, SurveyContent, render_survey_page
from trunnion.survey.found_files import FileKind
from trunnion.survey.result import Became, Blocker, Rate, Survey, SurveyedFile, Trying


def survey_page(found: Survey, words: Words = LIBRARY) -> bytes:
    """Return the page of a survey in the language and the words of who asks."""
    with in_language(words):
        return render_survey_page(_content(found))


def _content(found: Survey) -> SurveyContent:
    tried = [file for file in found.files if file.tries]
    through = [file for file in tried if file.passes == len(file.tries)]
    some = [file for file in tried if 0 < file.passes < len(file.tries)]
    facts = [
        (on_survey("fact_files"), str(len(found.files))),
        (on_survey("fact_tried"), str(len(tried))),
        (on_survey("went_through"), str(len(through))),
        (on_survey("fact_some"), str(len(some))),
        (on_survey("fact_others"), str(len(found.files) - len(tried))),
        (on_survey("fact_time"), f"{found.timeout:g} s"),
    ]
    return SurveyContent(
        found.folder,
        facts,
        [(each.machine, each.control) for each in found.machines if each.posts],
        [each.machine for each in found.machines if not each.posts],
        list(map(_rate, found.rates)),
        list(map(_blocker, found.blockers)),
        list(map(_row, found.files)),
    )


def _rate(each: Rate) -> RateRow:
    looks, became = told(each.looks_said), _became(each.became)
    return RateRow(word(each.kind), looks, each.control, each.files, each.passed, became)


def _blocker(each: Blocker) -> BlockerRow:
    cure = each.first.wording.text("cure", page_words()) if each.cure_said is None else told(each.cure_said)
    return BlockerRow(each.code, each.files, each.opens, _place(each.first), told(each.first.wording), cure)


def _became(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{count} {word(name)}" for name, count in counts.items())


def _place(problem: Problem) -> str:
    return f"{problem.file}:{problem.line}" if problem.line else problem.file


def _row(file: SurveyedFile) -> FileRow:
    proven = (Became.PROVEN, Became.PROVEN_WARNED)
    is_proven = bool(file.tries) and all(each.became in proven for each in file.tries)
    kind = word(file.kind) if file.kind is not FileKind.OTHER else ""
    through = on_survey("of", passed=file.passes, count=len(file.tries)) if file.tries else ""
    reasons = [_reason(each, len(file.tries) > 1) for each in file.tries if not each.became.passed]
    looks = told(file.looks_said)
    return FileRow(file.file, kind, looks, word(file.became), is_proven, bool(file.passes), through, reasons)


def _reason(each: Trying, names_machine: bool) -> str:
    machine = f"{each.machine}: " if names_machine else ""
    if not each.errors:
        return f"{machine}{word(each.became)} {', '.join(each.codes)}".rstrip()
    first = each.errors[0]
    line = f"{told(phrase('line_number', line=first.line))}: " if first.line else ""
    return f"{machine}{line}{told(first.wording.with_cure())} [{first.code}]"
