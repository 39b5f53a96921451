"""The page of all settings, made of what the definitions say; run as a module, this writes it."""

from collections.abc import Sequence
from typing import Final

import trunnion
from tests.support.locations import DOCS
from trunnion.jobs.describe.controls import SettingDescription

PAGE: Final = DOCS / "controls" / "settings.md"

_HEAD: Final = """# Settings

Every setting that `--set` and `settings` take, as the definitions explain it; `trunnion controls NAME` prints the
same for one control, your own definition too. An error in a setting ends with its meaning. The tests keep this page
complete.

A setting marked * can differ [by operation](../commands.md#trunnion-post).
"""

_TABLE: Final = "\n| setting | default | may be | meaning |\n| --- | --- | --- | --- |\n"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("[", "\\[")


def _row(setting: SettingDescription) -> str:
    star = "*" if setting.by_operation else ""
    cells = map(_cell, (setting.default, setting.allowed, setting.meaning))
    return f"| `{setting.name}`{star} | {' | '.join(cells)} |\n"


def _section(title: str, settings: Sequence[SettingDescription]) -> str:
    return f"\n## {title}\n{_TABLE}" + "".join(map(_row, settings))


def page() -> str:
    """The page of the docs; controls that differ from one before them in a few settings show these only."""
    controls = trunnion.describe_controls()
    # Some controls have one of these as their own, with other values.
    every = max((control.run_settings for control in controls), key=len)
    text = _HEAD + _section("Every control", every)
    shown: list[trunnion.ControlDescription] = []
    for control in controls:
        like = next((other for other in shown if _names(other) == _names(control)), None)
        settings = _differing(control, like) if like else control.settings
        text += _section(control.name, settings) if settings else f"\n## {control.name}\n"
        if like:
            text += f"\n{'All others' if settings else 'All'} as on the {like.name}.\n"
        shown.append(control)
    return text


def _names(control: trunnion.ControlDescription) -> list[str]:
    return [setting.name for setting in control.settings]


def _differing(
    control: trunnion.ControlDescription, other: trunnion.ControlDescription
) -> Sequence[SettingDescription]:
    return [setting for setting in control.settings if setting not in other.settings]


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
