"""What makes rows of posted CL files: by lines behind the first cut, by settings, and by the machine's definition."""

from collections.abc import Mapping
from pathlib import Path

from tests.support.cures.cure import Cure, Outcome, Trial, marked, post
from tests.support.posting import FOOT, HEAD


def by_lines(message: str, *lines: str, on: str = "yl569", head: str = HEAD, **settings: str) -> Cure:
    """Lines behind the first cut."""
    return marked(message, post(on), *lines, head=head, foot=FOOT, **settings)


def by_settings(
    message: str, change: Mapping[str, str | None], text: str = HEAD, on: str = "yl569", **settings: str
) -> Cure:
    """Settings with which an operation is posted, and the one that the cure gives."""
    code, _, variant = message.partition(" ")
    return Cure(code, variant, post(on), text + FOOT, (change,), settings)


def defined(text: str, **given: str) -> Trial:
    """Return what posts a CL file on the machine of a definition."""

    def posted(definition: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        machine = folder / "ours.toml"
        machine.write_text('schema = 1\nname = "Ours"\n' + definition, encoding="utf-8")
        return post(str(machine))(text, {**given, **settings}, folder)

    return posted


def on_machine(definition: str) -> Trial:
    """Return what posts a CL file on the machine of a definition."""

    def posted(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        return defined(text, **settings)(definition, {}, folder)

    return posted


def by_definition(message: str, *lines: str, text: str = HEAD, **settings: str) -> Cure:
    """Lines of the definition of the machine."""
    return marked(message, defined(text + FOOT, **settings), *lines)
