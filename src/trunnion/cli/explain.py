"""``trunnion explain``: what a code of a message, or a check, means."""

import sys
from collections.abc import Sequence
from dataclasses import replace

from trunnion.cli.columns import width_of, wrapped
from trunnion.cli.command_line.language import spoken_language
from trunnion.cli.results import show
from trunnion.cli.wording import in_command_words, said
from trunnion.errors import InputError, Problem
from trunnion.explanations import SUBJECTS, Explanation, explanations
from trunnion.jobs.describe.codes import all_explanations
from trunnion.jobs.describe.codes import explain as explain_code
from trunnion.jobs.job import Given
from trunnion.messages import said_in

#: The most that lines have.
_WIDTH = 100


def explain(given: Given) -> int:
    """Print what codes mean; without any, list all of them."""
    found, faults = _asked(given.codes)
    found = found if given.codes else list(all_explanations())
    spoken = explanations(spoken_language())  # data stays English
    texts = [spoken[each.code] for each in found]
    lines = "\n\n".join(map(_text, texts)).split("\n") if given.codes else _list(texts)
    if found or given.json:
        show(given, lambda: found, lines)
    if faults:
        raise InputError(faults)
    return 0


def _asked(codes: Sequence[str]) -> tuple[list[Explanation], list[Problem]]:
    """Return the explanations of the codes that there are, and what is wrong with the others."""
    found, faults = [], []
    for code in codes:
        try:
            found.append(explain_code(code))
        except InputError as error:
            faults += [replace(problem, file=code, subject=None) for problem in error.problems]
    return found, faults


def _text(found: Explanation) -> str:
    parts = (found.means, said("at_the_machine", matters=found.matters), said("what_to_do", cure=found.cure))
    width = min(width_of(sys.stdout) or _WIDTH, _WIDTH)
    paragraphs = ("\n".join(wrapped(in_command_words(part), width)) for part in parts)
    return "\n\n".join((f"{found.code}: {found.title}", *paragraphs))


def _list(found: list[Explanation]) -> list[str]:
    width = max(len(each.code) for each in found)
    lines: list[str] = []
    for subject, english in SUBJECTS.items():
        title = said_in(spoken_language(), "help", "subjects", subject, english=english)
        lines += ["", title] if lines else [title]
        lines += [f"  {each.code:<{width}}  {each.title}" for each in found if each.subject == subject]
    return lines
