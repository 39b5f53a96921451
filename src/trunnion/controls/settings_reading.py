"""The settings of a control's definition, what they may be and what they mean, with every mistake reported."""

from collections.abc import Mapping, Sequence

from trunnion.controls.definition import Control
from trunnion.controls.family_writer import FamilyWriter
from trunnion.controls.setting_rules import SettingKind, SettingRule, read_setting_rules
from trunnion.controls.vocabulary import PROGRAM_CHOICES
from trunnion.definitions import Table
from trunnion.definitions.setting_text import setting_text
from trunnion.messages import Wording


def read_rules(table: Table, settings: Table, family: FamilyWriter) -> dict[str, SettingRule]:
    choices = {
        name: SettingRule(SettingKind.CHOICE, one_of=words, optional=False)
        for name, words in family.SETTING_CHOICES.items()
    }
    return choices | read_setting_rules(table, settings)


def read_settings(table: Table, rules: Mapping[str, SettingRule], family: FamilyWriter) -> dict[str, str]:
    found = {name: table.setting(name, _words_of(name, rules)) or "" for name in table.names()}
    for name, choices in family.SETTING_CHOICES.items():
        found.setdefault(name, choices[0])
    table.report_unread_keys()
    return found


def read_setting_meanings(table: Table, settings: Table, family: FamilyWriter) -> dict[str, str]:
    """Return what each setting changes; the family explains its own."""
    own = {name: table.text(name) for name in table.names()}
    for name in own:
        if name not in settings and name not in family.SETTING_CHOICES:
            table.add_problem(name, Wording("DEF520", "explains_no_setting"))
    table.report_unread_keys()
    return {**family.SETTING_MEANINGS, **own}


def read_method_defaults(
    entries: Sequence[Table], settings: Table, rules: Mapping[str, SettingRule]
) -> dict[str, tuple[tuple[str, str], ...]]:
    found: dict[str, tuple[tuple[str, str], ...]] = {}
    for entry in entries:
        name = entry.text("setting", one_of=settings.keys())
        value = entry.setting("value", _words_of(name, rules)) or ""
        found[name] = (*found.get(name, ()), (entry.text("method"), value))
        entry.report_unread_keys()
    return found


def check_settings(table: Table, by_method: Sequence[Table], control: Control) -> None:
    """Report defaults that their own rules do not allow."""
    rules, stated = control.setting_rules, table.to_dict()
    # Of a type that no setting has: that is told already.
    unread = {name for name, value in stated.items() if setting_text(value, _words_of(name, rules)) is None}
    for name, value in control.settings.items():
        if name in unread:
            continue
        if name == "preselect" and value == "on" and not control.family.tool_preselection("1"):
            table.add_problem(name, Wording("DEF520", "not_known_how"))
        allowed = control.allowed_instead(name, value)
        if allowed is not None and name in table:
            table.add_problem(name, Wording("DEF520", "not_allowed", value=repr(value), allowed=allowed))
    faults = control.family.validate_settings(control.settings)
    for name, allowed in (each for each in faults if each[0] not in unread):
        table.add_problem(name, Wording("DEF520", "not_allowed", value=repr(control.settings[name]), allowed=allowed))
    for entry in by_method:
        name, default = entry.text("setting"), _default_of_method(entry, rules)
        allowed = control.allowed_instead(name, default) if name in control.settings and default is not None else None
        if allowed is not None:
            entry.add_problem("value", Wording("DEF520", "not_allowed", value=repr(default), allowed=allowed))


def _default_of_method(entry: Table, rules: Mapping[str, SettingRule]) -> str | None:
    """Return the value of a setting for some methods; None where it is of a type that no setting has."""
    stated = entry.to_dict()
    return setting_text(stated.get("value"), _words_of(str(stated.get("setting")), rules))


def _words_of(name: str, rules: Mapping[str, SettingRule]) -> tuple[str, ...]:
    """Return the words of a setting that is a choice; none of others."""
    return rules[name].one_of if name in rules else PROGRAM_CHOICES.get(name, ())
