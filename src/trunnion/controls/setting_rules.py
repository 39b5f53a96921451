"""What a setting may be, as the definition of a control states it.

In:     the table ``[setting_rules]`` of a definition.
Out:    rules that judge a text, and say what to write instead.
"""

import math
import re
import unicodedata
from enum import StrEnum
from typing import Final

from trunnion.definitions import Table
from trunnion.definitions.messages import a_number, a_whole_number
from trunnion.messages import Wording, phrase
from trunnion.records import dataclass

#: Controls read numbers without an exponent.
_NUMBER: Final = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)")

#: Numbers of tools; and texts that mean one, but are not written as one.
_TOOL_NUMBER: Final = re.compile(r"[1-9][0-9]{0,7}")
_NEARLY_NUMBER: Final = re.compile(r"[+-]?[\d.,]+")

#: Unicode categories of characters that would break a line, or that a file cannot have.
_NOT_IN_A_LINE: Final = frozenset({"Cc", "Cs", "Zl", "Zp"})


class SettingKind(StrEnum):
    """What a setting is.

    TEXT    any text of one line
    STRING  a text without quotation marks, for places inside them
    QUOTED  a text in quotation marks
    PATH    a folder of the control
    NUMBER  a number, without an exponent
    WHOLE   a whole number, without a sign
    G_CODE  G and a number of up to three digits, with a tenth at most, and no motion
    M_CODE  M and a number of up to four digits, of those that builders choose
    CHOICE  one of some words
    TOOL    a tool number, or the name of a tool where the family calls tools by name
    """

    TEXT = "text"
    STRING = "string"
    QUOTED = "quoted"
    PATH = "path"
    NUMBER = "number"
    WHOLE = "whole"
    G_CODE = "g_code"
    M_CODE = "m_code"
    CHOICE = "choice"
    TOOL = "tool"


#: The texts of some kinds, and how to say what they are.
_FORMS: Final = {
    SettingKind.STRING: (re.compile(r'[^"]*'), phrase("text_without_quotation_marks")),
    SettingKind.QUOTED: (re.compile(r'"[^"]*"'), phrase("text_in_quotation_marks")),
    SettingKind.PATH: (re.compile(r"[A-Za-z0-9_:./\\-]*[/\\]"), phrase("folder_of_control")),
    SettingKind.G_CODE: (re.compile(r"G(?!0*[0-4]$)[0-9]{1,3}(\.[1-9])?"), phrase("g_code")),
    SettingKind.M_CODE: (re.compile(r"M(?!0*(?:[0-9]|30|98|99)$)[0-9]{1,4}"), phrase("m_code")),
}


@dataclass(frozen=True, slots=True, eq=False)
class SettingRule:
    """What a setting may be.

    kind                       what it is
    unit                       of a number, for messages
    above, at_least, at_most   bounds of a number, the last of a tool's too; None: there is none
    one_of                     the words of a CHOICE
    optional                   may be empty: then there is none
    """

    kind: SettingKind = SettingKind.TEXT
    unit: str = ""
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    one_of: tuple[str, ...] = ()
    optional: bool = True

    @property
    def is_number(self) -> bool:
        """Whether the setting is a number."""
        return self.kind in (SettingKind.NUMBER, SettingKind.WHOLE)

    def allows(self, text: str) -> bool:
        """Whether a setting may be this text."""
        if not is_one_line(text):
            return False
        if not text:
            return self.optional
        match self.kind:
            case SettingKind.NUMBER | SettingKind.WHOLE:
                return self._allows_number(text)
            case SettingKind.CHOICE:
                return text in self.one_of
            case SettingKind.TOOL:
                return _is_tool(text) and self._is_in_bounds(tool_number(text))
            case SettingKind.TEXT:
                return True
            case _:
                return bool(_FORMS[self.kind][0].fullmatch(text))

    def _allows_number(self, text: str) -> bool:
        if not _NUMBER.fullmatch(text) or (self.kind is SettingKind.WHOLE and not text.isdecimal()):
            return False
        return self._is_in_bounds(float(text))

    def _is_in_bounds(self, value: float | None) -> bool:
        return value is None or (
            math.isfinite(value)
            and (self.above is None or value > self.above)
            and (self.at_least is None or value >= self.at_least)
            and (self.at_most is None or value <= self.at_most)
        )

    def allowed(self) -> Wording:
        """Return what to write, such as ``a number in mm above 0 and of at most 10``: a phrase."""
        bounds = (self.above, self.at_least, self.at_most)
        match self.kind:
            case SettingKind.NUMBER:
                return self._or_nothing(a_number(self.unit, *bounds))
            case SettingKind.WHOLE:
                return self._or_nothing(a_whole_number(self.unit, *bounds))
            case SettingKind.CHOICE:
                return self._or_nothing(phrase("either_of", words=self.one_of))
            case SettingKind.TOOL if self.at_most is None:
                return phrase("number_of_tool")
            case SettingKind.TOOL:
                return phrase("number_of_tool_at_most", most=self.at_most)
            case SettingKind.TEXT:
                return phrase("text_of_one_line") if self.optional else phrase("text_of_one_line_not_empty")
            case _:
                form = _FORMS[self.kind][1]
                return self._or_nothing(form) if self.optional else phrase("not_empty", form=form)

    def _or_nothing(self, allowed: Wording) -> Wording:
        return phrase("or_nothing", allowed=allowed) if self.optional else allowed


def is_one_line(text: str) -> bool:
    """Whether a text has no line break, control character or other character that a program cannot have."""
    return not any(unicodedata.category(character) in _NOT_IN_A_LINE for character in text)


def _is_tool(text: str) -> bool:
    """Whether a text is a number of a tool as programs write it, or a name that nobody takes for a number."""
    if tool_number(text) is not None:
        return _TOOL_NUMBER.fullmatch(text) is not None
    return text == text.strip() and _NEARLY_NUMBER.fullmatch(text) is None


def tool_number(text: str) -> int | None:
    """Return the number that a tool is called by; None for a name."""
    return int(text) if text.isdecimal() and text.isascii() else None


def read_setting_rules(table: Table, settings: Table) -> dict[str, SettingRule]:
    """Read the rules of a definition, each for one of its settings; mistakes are added to the table's problems.

    A rule with ``one_of`` is a choice. A setting whose default is empty may be empty, and others if their rule says so.
    """
    rules, stated = {}, settings.to_dict()
    for name in table.names():
        entry = table.table(name)
        if name not in settings:
            entry.add_problem("", Wording("DEF520", "rule_no_setting"))
        words = entry.texts("one_of", ())
        kinds = tuple(kind for kind in SettingKind if kind is not SettingKind.CHOICE)
        kind = SettingKind.CHOICE if words else SettingKind(entry.text("kind", "text", one_of=kinds) or "text")
        is_number = kind in (SettingKind.NUMBER, SettingKind.WHOLE)
        rules[name] = SettingRule(
            kind,
            entry.text("unit", "") if is_number else "",
            entry.number("above", None) if is_number else None,
            entry.number("at_least", None) if is_number else None,
            entry.number("at_most", None) if is_number or kind is SettingKind.TOOL else None,
            words,
            entry.flag("optional", stated.get(name, "") == ""),
        )
        entry.report_unread_keys()
    table.report_unread_keys()
    return rules
