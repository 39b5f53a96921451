"""``trunnion controls``."""

import sys
from collections.abc import Iterator, Sequence
from typing import Final

from trunnion.cli.columns import CodeLine, table, width_of
from trunnion.cli.results import show
from trunnion.cli.wording import in_words, line, part
from trunnion.jobs.describe.controls import (
    ControlDescription,
    SettingDescription,
    WordDescription,
    describe_control,
    describe_controls,
)
from trunnion.jobs.job import Given
from trunnion.messages import Wording, declared
from trunnion.results import to_data

_INDENT: Final = "  "


def controls(given: Given) -> int:
    """List the shipped controls, or explain one."""
    if given.name:
        control = describe_control(given.name)
        show(given, lambda: control, control_lines(control))
        return 0
    found = describe_controls()
    show(given, lambda: [_list_entry(control) for control in found], _list_lines(found))
    return 0


def _list_entry(control: ControlDescription) -> dict[str, object]:
    data: dict[str, object] = to_data(control, only=("key", "name", "family", "description"))
    return data | {"settings": len(control.settings), "run_settings": len(control.run_settings)}


def _list_lines(found: Sequence[ControlDescription]) -> Iterator[str]:
    rows = (
        (
            control.key,
            control.family,
            line("settings_counted", count=len(control.settings)),
            line("control_listed", name=control.name, description=declared(control.description, "descriptions")),
        )
        for control in found
    )
    return table(rows, width_of(sys.stdout))


def control_lines(control: ControlDescription) -> Iterator[str]:
    """Yield a control and all that can be set, in lines."""
    yield f"{control.name} ({control.key})"
    yield line("control_family", family=control.family, extension=control.extension)
    yield from [in_words(declared(control.description, "descriptions"))] if control.description else []
    yield from ("", line("what_it_can_do"))
    yield from (_INDENT + in_words(ability) for ability in control.able)
    yield from ("", line("words_of_motion"))
    yield from (_INDENT + _word_line(word) for word in control.words)
    yield from ("", line("texts_of_programs"))
    for text in control.texts:
        yield _INDENT + text.name
        yield from (CodeLine(_INDENT * 2 + each) for each in text.lines)
    yield from ("", line("settings_of_control"))
    yield from _setting_lines(control.settings)
    yield from ("", line("settings_of_every_control"))
    yield from _setting_lines(control.run_settings)


def _word_line(word: WordDescription) -> str:
    return f"{word.name:<20} {word.letter:<10} {in_words(_decimals(word))}"


def _decimals(word: WordDescription) -> Wording:
    if word.decimals is None:
        return part("word_without_number")
    five, three = word.decimals
    decimals = (
        part("word_decimals", five=five) if five == three else part("word_decimals_by_axes", five=five, three=three)
    )
    return part("word_modal", decimals=decimals) if word.modal else decimals


def _setting_lines(settings: Sequence[SettingDescription]) -> Iterator[str]:
    for setting in settings:
        variant = "setting_line_by_operation" if setting.by_operation else "setting_line"
        yield _INDENT + line(variant, name=setting.name, default=setting.default_said, allowed=setting.allowed_said)
        yield _INDENT * 3 + (in_words(setting.meant) if setting.meaning else line("setting_not_explained"))
