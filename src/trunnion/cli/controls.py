"""``trunnion controls``."""

import sys
from collections.abc import Iterator, Sequence
from typing import Final

from trunnion.cli.columns import CodeLine, table, width_of
from trunnion.cli.results import show
from trunnion.jobs.describe.controls import (
    ControlDescription,
    SettingDescription,
    WordDescription,
    describe_control,
    describe_controls,
)
from trunnion.jobs.job import Given
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
        (control.key, control.family, f"{len(control.settings)} settings", f"{control.name}: {control.description}")
        for control in found
    )
    return table(rows, width_of(sys.stdout))


def control_lines(control: ControlDescription) -> Iterator[str]:
    """Yield a control and all that can be set, in lines."""
    yield f"{control.name} ({control.key})"
    yield f"family {control.family}, programs *{control.extension}"
    yield from [control.description] if control.description else []
    yield from ("", "What it can do")
    yield from (_INDENT + ability for ability in control.abilities)
    yield from ("", "Words of its motion blocks, in their order")
    yield from (_INDENT + _word_line(word) for word in control.words)
    yield from ("", "Texts of its programs, in their order; {field} stands for a value")
    for text in control.texts:
        yield _INDENT + text.name
        yield from (CodeLine(_INDENT * 2 + line) for line in text.lines)
    yield from ("", "Settings of this control: --set NAME=VALUE, or --set NAME=OPERATION:VALUE where it says so")
    yield from _setting_lines(control.settings)
    yield from ("", "Settings of every control")
    yield from _setting_lines(control.run_settings)


def _word_line(word: WordDescription) -> str:
    if word.decimals is None:
        return f"{word.name:<20} {word.letter:<10} no number"
    five, three = word.decimals
    decimals = f"{five} decimals" if five == three else f"{five} decimals, {three} in three-axis operations"
    return f"{word.name:<20} {word.letter:<10} {decimals}{', modal' if word.modal else ''}"


def _setting_lines(settings: Sequence[SettingDescription]) -> Iterator[str]:
    for setting in settings:
        own = "; by operation" if setting.by_operation else ""
        yield f"{_INDENT}{setting.name} = {setting.default}  [{setting.allowed}{own}]"
        yield _INDENT * 3 + (setting.meaning or "not explained in its definition: add it to [setting_meanings]")
