"""``trunnion survey``: what becomes of the files of a folder, and what stands in the way of most."""

from collections.abc import Iterator
from itertools import islice
from typing import Final

from trunnion.cli.columns import padded
from trunnion.cli.many_files.counting_terminal import CountingTerminal
from trunnion.cli.results import show
from trunnion.cli.wording import in_words, spoken
from trunnion.files import atomic_file
from trunnion.jobs.job import Given
from trunnion.messages import Wording, word_said
from trunnion.survey.page import survey_page
from trunnion.survey.result import Rate, Survey, SurveyedFile
from trunnion.survey.taking import take_survey
from trunnion.wording import one_line

#: Codes and files that are printed; page and data have all of them.
_MOST_CODES: Final = 20
_MOST_FILES: Final = 200

#: Columns of a file and of what it is.
_FILE_WIDTH: Final = 50


def run(given: Given) -> int:
    """Take a survey; 0 once it is done, whatever came of the files."""
    written = [file for file in (given.json, given.report) if file not in (None, "-")]
    found = take_survey(**given.arguments(), written=written, observer=CountingTerminal())
    if given.report is not None:
        with atomic_file(given.report) as sink:
            sink.write(survey_page(found, spoken()))
    show(given, lambda: found, survey_lines(found))
    return 0


def survey_lines(found: Survey) -> Iterator[str]:
    """Yield a survey in lines: files, rates, what blocks most files."""
    for file in islice(found.files, _MOST_FILES):
        yield f"{padded(file.file, _FILE_WIDTH)}  {_of_file(file)}".rstrip()
    if len(found.files) > _MOST_FILES:
        yield _said("more_files", count=len(found.files) - _MOST_FILES)
    yield from ("", _said("rates"))
    yield from map(_rate_line, found.rates)
    if found.blockers:
        yield from ("", _said("blockers"))
    for each in found.blockers[:_MOST_CODES]:
        first = each.first
        place = f"{first.file}:{first.line}" if first.line else first.file
        told = in_words(first.wording.with_cure())
        message = told if each.cure_said is None else _said("with_explanation", what=told, where=each.cure_said)
        yield f"{each.code:<12} {each.files:>5} {each.opens:>5}  {place}: {message}"
    if len(found.blockers) > _MOST_CODES:
        yield _said("more_codes", count=len(found.blockers) - _MOST_CODES)
    machines = tuple(f"{each.machine} ({each.control})" for each in found.machines if each.posts)
    others = tuple(each.machine for each in found.machines if not each.posts)
    if others:
        on_them = _said("tried_on_others", machines=machines, others=others, timeout=found.timeout)
    else:
        on_them = _said("tried_on", machines=machines, timeout=found.timeout)
    yield from ("", on_them)
    counts = tuple(f"{count} {in_words(word_said(became))}" for became, count in found.counts.items())
    yield _said("counts", count=len(found.files), counts=counts) if found.files else _said("no_files")


def _said(variant: str, /, **parameters: object) -> str:
    """Return a text of the catalogue ``survey``."""
    return in_words(Wording("survey", variant, **parameters))


def _of_file(file: SurveyedFile) -> str:
    """Return what a file is and what became of it."""
    became = in_words(word_said(file.became))
    if not file.tries:
        return one_line(f"{in_words(file.looks_said)}: {became}")
    kind, count = in_words(word_said(file.kind)), len(file.tries)
    looks = _said("kind_and_looks", kind=kind, looks=file.looks_said) if file.looks else kind
    if 0 < file.passes < count:
        became = _said("through_on_some", passed=file.passes, count=count, became=became)
    elif count > 1 and file.passes:
        became = _said("became_on", passed=file.passes, count=count, became=became)
    codes = dict.fromkeys(code for each in file.tries if not each.became.passed for code in each.codes)
    return one_line(f"{looks}: {became}{': ' if codes else ''}{', '.join(codes)}")


def _rate_line(rate: Rate) -> str:
    looks = in_words(rate.looks_said) or _said("no_control")
    became = ", ".join(f"{count} {in_words(word_said(name))}" for name, count in rate.became.items())
    of = padded(_said("of", passed=rate.passed, count=rate.files), 14, right=True)
    kind = padded(in_words(word_said(rate.kind)), 8)
    return f"{kind} {padded(looks, 40)} {padded(rate.control, 24)} {of} {became}"
