"""``trunnion explain``: what a code of a message, or a check, means."""

import argparse
import textwrap
from dataclasses import asdict

from trunnion.api.explaining import all_explanations
from trunnion.api.explaining import explain as explain_code
from trunnion.cli.results import as_json, print_result
from trunnion.cli.wording import in_command_words
from trunnion.explanations import SUBJECTS, Explanation

_WIDTH = 100


def explain(arguments: argparse.Namespace) -> int:
    """Print what codes mean; without any, list all of them."""
    found = [explain_code(code) for code in arguments.codes] or list(all_explanations())
    if arguments.json:
        print_result(as_json([asdict(each) for each in found]))
    elif arguments.codes:
        print_result("\n\n".join(map(_text, found)))
    else:
        print_result(*_list(found))
    return 0


def _text(found: Explanation) -> str:
    parts = (found.means, f"At the machine: {found.matters}", f"What to do: {found.cure}")
    paragraphs = (textwrap.fill(in_command_words(part), _WIDTH) for part in parts)
    return "\n\n".join((f"{found.code}: {found.title}", *paragraphs))


def _list(found: list[Explanation]) -> list[str]:
    width = max(len(each.code) for each in found)
    lines: list[str] = []
    for subject, title in SUBJECTS.items():
        lines += ["", title] if lines else [title]
        lines += [f"  {each.code:<{width}}  {each.title}" for each in found if each.subject == subject]
    return lines
