"""``trunnion survey``: what becomes of the files of a folder, and what stands in the way of most."""

from collections.abc import Iterator
from itertools import islice
from typing import Final

from trunnion.cli.many_files.counting_terminal import CountingTerminal
from trunnion.cli.results import show
from trunnion.cli.wording import in_command_words
from trunnion.files import atomic_file
from trunnion.jobs.job import Given
from trunnion.survey.page import survey_page
from trunnion.survey.result import Rate, Survey, SurveyedFile
from trunnion.survey.taking import take_survey
from trunnion.wording import counted, one_line

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
            sink.write(survey_page(found, in_command_words))
    show(given, lambda: found, survey_lines(found))
    return 0


def survey_lines(found: Survey) -> Iterator[str]:
    """Yield a survey in lines: files, rates, what blocks most files."""
    for file in islice(found.files, _MOST_FILES):
        yield f"{file.file:<{_FILE_WIDTH}}  {_said(file)}".rstrip()
    if len(found.files) > _MOST_FILES:
        yield f"and {len(found.files) - _MOST_FILES} more; --report FILE.html and --json FILE have all of them"
    yield from ("", "By dialect and control: files that went through, of those tried")
    yield from map(_rate_line, found.rates)
    if found.blockers:
        yield from ("", "Blocked by: files, and files with no other error; the first place and its cure")
    for each in found.blockers[:_MOST_CODES]:
        first = each.first
        place = f"{first.file}:{first.line}" if first.line else first.file
        message = in_command_words(f"{first.what}; {each.cure}")
        yield f"{each.code:<12} {each.files:>5} {each.opens:>5}  {place}: {message}"
    if len(found.blockers) > _MOST_CODES:
        yield f"and {counted(len(found.blockers) - _MOST_CODES, 'code')} more"
    machines = ", ".join(f"{each.machine} ({each.control})" for each in found.machines if each.posts)
    others = ", ".join(each.machine for each in found.machines if not each.posts)
    also = f"; programs also on {others}" if others else ""
    yield from ("", f"tried on {machines}{also}; at most {found.timeout:g} s each")
    counts = ", ".join(f"{count} {became}" for became, count in found.counts.items())
    yield f"{counted(len(found.files), 'file')}: {counts}" if found.files else "no files"


def _said(file: SurveyedFile) -> str:
    """Return what a file is and what became of it."""
    if not file.tries:
        return one_line(f"{file.looks}: {file.became}")
    looks = f"{file.kind}, {file.looks}" if file.looks else str(file.kind)
    machines = f" on {file.passes} of {len(file.tries)} machines" if len(file.tries) > 1 and file.passes else ""
    is_in_part = 0 < file.passes < len(file.tries)
    became = f"went through{machines}, else {file.became}" if is_in_part else f"{file.became}{machines}"
    codes = dict.fromkeys(code for each in file.tries if not each.became.passed for code in each.codes)
    return one_line(f"{looks}: {became}{': ' if codes else ''}{', '.join(codes)}")


def _rate_line(rate: Rate) -> str:
    looks = rate.looks or "of no certain control"
    became = ", ".join(f"{count} {name}" for name, count in rate.became.items())
    return f"{rate.kind:<8} {looks:<40} {rate.control:<24} {rate.passed:>5} of {rate.files:<5} {became}"
