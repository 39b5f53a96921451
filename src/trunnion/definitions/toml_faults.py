"""What is wrong with a line that is not TOML, in plain words: the mistakes of people who write it seldom.

In:     the text, the line at which the parser gave up, and what it said.
Out:    the line to correct, what is wrong in it, and the cure. Where no known mistake is found, the parser's words.
"""

import re
from typing import Final, NamedTuple

from trunnion.messages import Wording

_COMMENT: Final = re.compile(r"//|;|--|/\*|REM\b|'")
_CURLY: Final = re.compile("[“”„‟‘’‚«»]")
_KEY: Final = re.compile(r"[A-Za-z0-9_.-]+|\"[^\"]*\"|'[^']*'")
_WORD: Final = re.compile(r"[^\s\"'\[\]{},=#]+(?:[ \t]+[^\s\"'\[\]{},=#]+)*")
_SIGNED: Final = r"[-+]?[0-9]+"
_DECIMAL_COMMA: Final = re.compile(rf"({_SIGNED}),([0-9]+)(?![0-9,]*\])")
_BARE_POINT: Final = re.compile(r"([-+]?)(?:\.([0-9]+)|([0-9]+)\.(?![0-9]))$")
_LEADING_ZERO: Final = re.compile(r"([-+]?)0+([1-9][0-9]*(?:\.[0-9]+)?|0)$")
_WITH_UNIT: Final = re.compile(rf"({_SIGNED}(?:\.[0-9]+)?)[ \t]*([A-Za-zµ°%/\"']+[A-Za-z0-9²/]*)$")
_UNIT_IN_LIST: Final = re.compile(rf"({_SIGNED}(?:\.[0-9]+)?)[ \t]*(mm|cm|in|inch|deg|rad|[°%\"'])(?![A-Za-z0-9])")
_ANSWERS: Final = {"true": "true", "yes": "true", "on": "true", "false": "false", "no": "false", "off": "false"}
#: Ends of the names of tables whose keys are words of programs and statements, in quotation marks.
_OF_WORDS: Final = ("known", "statements", "cl.words")

_SECOND_KEY: Final = re.compile(r"[\s,;][ \t]*[A-Za-z0-9_-]+[ \t]*=")
_SHOWN: Final = 60


class TomlFault(NamedTuple):
    """A mistake: its line from 1, and what it is."""

    line: int
    wording: Wording


def toml_fault(text: str, line: int, message: str) -> TomlFault:
    """Return the mistake for which a parser has refused a text.

    text     of the file
    line     at which the parser gave up, from 1; 0 if it does not say
    message  what it said
    """
    lines = text.split("\n")
    if found := _unclosed(lines, line, message):
        return found
    at = line if 1 <= line <= len(lines) else len(lines)
    content = lines[at - 1].strip()
    wording = _of_line(content, message, _header_above(lines, at))
    if wording is None:
        return TomlFault(line, Wording("DEF130", "refused", message=f"{message[:1].lower()}{message[1:]}"))
    return TomlFault(at, wording)


def _unclosed(lines: list[str], line: int, message: str) -> TomlFault | None:
    """Return a text or a list that does not end, at the line where it begins."""
    for quotes in ("'''", '"""'):
        if message == f"Expected {quotes!r}" or (message == "Unterminated string" and quotes in "\n".join(lines)):
            begins = [k for k, each in enumerate(lines, 1) if each.count(quotes) % 2]
            return TomlFault(begins[-1] if begins else line, Wording("DEF130", "text_never_ends", quotes=quotes))
    if message == "Unclosed array":
        begins = [k for k, each in enumerate(lines[:line], 1) if re.match(r"[^#\"']*=[ \t]*\[", each)]
        at = begins[-1] if begins else line
        for where in range(at, min(line, len(lines)) + 1):
            if fault := _of_list(lines[where - 1]):
                return TomlFault(where, fault)
        return TomlFault(at, Wording("DEF130", "list_never_ends"))
    if message == "Unclosed inline table":
        return TomlFault(line, Wording("DEF130", "table_does_not_end_in_line"))
    if message in ('Expected "\'"', "Illegal character '\\n'", "Illegal character '\\r'", "Unterminated string"):
        at = min(line, len(lines)) or len(lines)
        while at > 1 and not {'"', "'"} & set(lines[at - 1]):
            at -= 1
        if _CURLY.search(lines[at - 1]):
            return None
        mark = "'" if lines[at - 1].count("'") % 2 and not lines[at - 1].count('"') % 2 else '"'
        return TomlFault(at, Wording("DEF130", "text_does_not_end_in_line", mark=mark))
    return None


def _of_list(content: str) -> Wording | None:
    """Return what is wrong with the values in a line of a list; None if that is not known."""
    key, equals, values = content.rpartition("=")
    values = _without_comment(values.strip())
    if {'"', "'"} & set(values):
        return None
    number = _UNIT_IN_LIST.search(values)
    without = _UNIT_IN_LIST.sub(r"\1", values).replace(";", ",")
    wanted = f"{f'{key.strip()} = ' if equals else ''}{without[:_SHOWN]}"
    if number:
        return Wording("DEF130", "unit_in_list", unit=number[2][:_SHOWN], wanted=wanted)
    if ";" in values:
        return Wording("DEF130", "semicolon_in_list", wanted=wanted)
    return None


def _header_above(lines: list[str], line: int) -> str:
    """Return the name of the table that a line stands in; empty for the top of the file."""
    for each in reversed(lines[: line - 1]):
        if each.lstrip().startswith("["):
            return each.partition("#")[0].strip(" \t\r[]")
    return ""


def _of_line(content: str, message: str, table: str = "") -> Wording | None:
    """Return what is wrong with a line of a table; None if that is not known."""
    if content.startswith("["):
        return _of_header(content)
    if _COMMENT.match(content):
        return Wording("DEF130", "comment_of_other_language")
    if _CURLY.search(content):
        return Wording("DEF130", "typographic_quotation_marks")
    key, equals, value = (part.strip() for part in content.partition("="))
    if not equals:
        return _without_equals(content)
    if not _KEY.fullmatch(key):
        shown = key[:_SHOWN]
        if table.endswith(_OF_WORDS) and not {'"', "'"} & set(key):
            return Wording("DEF130", "key_without_quotation_marks", key=shown, value=value[:_SHOWN])
        return Wording("DEF130", "no_key", key=repr(shown))
    return _of_value(key, _without_comment(value), message)


def _of_header(content: str) -> Wording:
    name = content.strip("[] \t").partition("]")[0].partition("#")[0].strip()[:_SHOWN]
    wanted = f"[[{name}]]" if content.startswith("[[") or "]]" in content else f"[{name}]"
    if not re.fullmatch(r"[A-Za-z0-9_.\"' -]*", name) or " " in name.strip():
        return Wording("DEF130", "no_name_of_table", name=repr(name))
    behind = content[content.rindex("]") + 1 :].strip() if "]" in content else ""
    if behind and not behind.startswith("#") and content.startswith(wanted):
        return Wording("DEF130", "something_behind_header", behind=behind[:_SHOWN], header=wanted)
    return Wording("DEF130", "brackets_of_header", wanted=wanted)


def _without_equals(content: str) -> Wording | None:
    found = re.match(r"([A-Za-z0-9_.-]+)[ \t]*(:?)[ \t]*(.*)", content)
    if found is None or not found[1]:
        return None
    key, colon, value = found[1], found[2], found[3].strip()
    wanted = f"{key} = {value[:_SHOWN] or '…'}"
    if colon:
        return Wording("DEF130", "colon_for_equals", wanted=wanted)
    return Wording("DEF130", "no_equals" if value else "key_alone", wanted=wanted)


def _of_value(key: str, value: str, message: str) -> Wording | None:
    if not value:
        return Wording("DEF130", "no_value", key=key)
    if '"' in value and "\\" in value:
        return Wording("DEF130", "backslash_in_text", text=value.strip('[]" ')[:_SHOWN])
    if found := _DECIMAL_COMMA.match(value):
        return Wording("DEF130", "decimal_comma", wanted=f"{key} = {found[1]}.{found[2]}")
    if found := _BARE_POINT.fullmatch(value):
        number = f"{found[1]}0.{found[2]}" if found[2] else f"{found[1]}{found[3]}.0"
        return Wording("DEF130", "point_at_end", wanted=f"{key} = {number}")
    if found := _LEADING_ZERO.fullmatch(value):
        return Wording("DEF130", "leading_zeros", wanted=f"{key} = {found[1]}{found[2]}")
    if found := _WITH_UNIT.fullmatch(value):
        return Wording("DEF130", "unit_behind_number", unit=found[2], wanted=f"{key} = {found[1]}")
    if answer := _ANSWERS.get(value.lower()):
        return Wording("DEF130", "other_word_for_flag", value=value, wanted=f"{key} = {answer}")
    if value.startswith("{") and not value.endswith("}"):
        return Wording("DEF130", "table_does_not_end_in_line")
    if _SECOND_KEY.search(value):
        return Wording("DEF130", "two_keys_in_line")
    if value[0].isalpha() and _WORD.fullmatch(value):
        mark = "'" if "\\" in value else '"'
        return Wording("DEF130", "text_without_quotation_marks", wanted=f"{key} = {mark}{value[:_SHOWN]}{mark}")
    if value[0] in "\"'" and message.startswith("Expected newline"):
        return Wording("DEF130", "something_behind_text", key=key)
    if "\\" in value or value[:1] in "./" or (len(value) > 1 and value[1] == ":"):
        return Wording("DEF130", "text_without_quotation_marks", wanted=f"{key} = '{value[:_SHOWN]}'")
    return None


def _without_comment(value: str) -> str:
    """Return a value without the comment behind it, if no text begins before that."""
    before = value.partition("#")[0]
    return before.strip() if not {'"', "'"} & set(before) else value
