"""What is wrong with a line that is not TOML, in plain words: the mistakes of people who write it seldom.

In:     the text, the line at which the parser gave up, and what it said.
Out:    the line to correct, what is wrong in it, and the cure. Where no known mistake is found, the parser's words.
"""

import re
from typing import Final, NamedTuple

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
_SECOND_KEY: Final = re.compile(r"[\s,;][ \t]*[A-Za-z0-9_-]+[ \t]*=")
_SHOWN: Final = 60


class TomlFault(NamedTuple):
    """A mistake: its line from 1, what it is, and the cure."""

    line: int
    what: str
    cure: str


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
    fault = _of_line(content, message, _header_above(lines, at))
    if fault is None:
        return TomlFault(line, f"{message[:1].lower()}{message[1:]}", "correct the line, or the one before it")
    what, cure = fault
    return TomlFault(at, f"the line {what}", cure)


def _unclosed(lines: list[str], line: int, message: str) -> TomlFault | None:
    """Return a text or a list that does not end, at the line where it begins."""
    for quotes in ("'''", '"""'):
        if message == f"Expected {quotes!r}" or (message == "Unterminated string" and quotes in "\n".join(lines)):
            begins = [k for k, each in enumerate(lines, 1) if each.count(quotes) % 2]
            cure = f"write {quotes} in a line of its own behind the text"
            return TomlFault(begins[-1] if begins else line, f"the text that begins with {quotes} does not end", cure)
    if message == "Unclosed array":
        begins = [k for k, each in enumerate(lines[:line], 1) if re.match(r"[^#\"']*=[ \t]*\[", each)]
        at = begins[-1] if begins else line
        for where in range(at, min(line, len(lines)) + 1):
            if fault := _of_list(lines[where - 1]):
                return TomlFault(where, *fault)
        return TomlFault(at, "the list that begins with [ does not end", "write ] behind it, and , between its values")
    if message == "Unclosed inline table":
        cure = "write all of it in one line, with } behind it and , between its keys"
        return TomlFault(line, "the table that begins with { does not end in its line", cure)
    if message in ('Expected "\'"', "Illegal character '\\n'", "Illegal character '\\r'", "Unterminated string"):
        at = min(line, len(lines)) or len(lines)
        while at > 1 and not {'"', "'"} & set(lines[at - 1]):
            at -= 1
        if _CURLY.search(lines[at - 1]):
            return None
        mark = "'" if lines[at - 1].count("'") % 2 and not lines[at - 1].count('"') % 2 else '"'
        cure = f"write {mark} behind it; a text of several lines stands between ''' and '''"
        return TomlFault(at, f"the text that begins with {mark} does not end in its line", cure)
    return None


def _of_list(content: str) -> tuple[str, str] | None:
    """Return what is wrong with the values in a line of a list, and the cure; None if that is not known."""
    key, equals, values = content.rpartition("=")
    values = _without_comment(values.strip())
    if {'"', "'"} & set(values):
        return None
    number = _UNIT_IN_LIST.search(values)
    without = _UNIT_IN_LIST.sub(r"\1", values).replace(";", ",")
    wanted = f"write {f'{key.strip()} = ' if equals else ''}{without[:_SHOWN]}"
    if number:
        return f"the list has {number[2][:_SHOWN]} behind a number", f"{wanted}; keys name the unit"
    if ";" in values:
        return "the list has ; between its values", wanted
    return None


def _header_above(lines: list[str], line: int) -> str:
    """Return the name of the table that a line stands in; empty for the top of the file."""
    for each in reversed(lines[: line - 1]):
        if each.lstrip().startswith("["):
            return each.partition("#")[0].strip(" \t\r[]")
    return ""


def _of_line(content: str, message: str, table: str = "") -> tuple[str, str] | None:
    """Return what is wrong with a line of a table, and the cure; None if that is not known."""
    if content.startswith("["):
        return _of_header(content)
    if _COMMENT.match(content):
        return "is a comment of another language", "begin comments with #"
    if _CURLY.search(content):
        return "has typographic quotation marks", 'write straight ones: "'
    key, equals, value = (part.strip() for part in content.partition("="))
    if not equals:
        return _without_equals(content)
    if not _KEY.fullmatch(key):
        shown = key[:_SHOWN]
        if table.endswith("known") and not {'"', "'"} & set(key):
            return f"has {shown} without quotation marks", f'write "{shown}" = {value[:_SHOWN]}'
        return (
            f"has the key {shown!r}, which is none",
            "write keys of letters from A to Z, digits and _, without blanks, and = behind it",
        )
    return _of_value(key, _without_comment(value), message)


def _of_header(content: str) -> tuple[str, str]:
    name = content.strip("[] \t").partition("]")[0].partition("#")[0].strip()[:_SHOWN]
    wanted = f"[[{name}]]" if content.startswith("[[") or "]]" in content else f"[{name}]"
    if not re.fullmatch(r"[A-Za-z0-9_.\"' -]*", name) or " " in name.strip():
        cure = "write names of letters from A to Z, digits and _, without blanks"
        return f"has the table {name!r}, whose name is none", cure
    behind = content[content.rindex("]") + 1 :].strip() if "]" in content else ""
    if behind and not behind.startswith("#") and content.startswith(wanted):
        return f"has {behind[:_SHOWN]} behind the header {wanted}", "write it in the next line"
    return "has a header of a table whose brackets do not match", f"write {wanted}"


def _without_equals(content: str) -> tuple[str, str] | None:
    found = re.match(r"([A-Za-z0-9_.-]+)[ \t]*(:?)[ \t]*(.*)", content)
    if found is None or not found[1]:
        return None
    key, colon, value = found[1], found[2], found[3].strip()
    wanted = f"{key} = {value[:_SHOWN] or '…'}"
    if colon:
        return "has : between key and value", f"write {wanted}"
    return ("has no = between key and value" if value else "has a key without = and value"), f"write {wanted}"


def _of_value(key: str, value: str, message: str) -> tuple[str, str] | None:
    if not value:
        return f"has no value behind {key} =", "write one, or take the line out"
    if '"' in value and "\\" in value:
        plain = value.strip('[]" ')[:_SHOWN]
        return r"has a \ in a text in double quotation marks", f"write single ones, '{plain}', or / in a path"
    if found := _DECIMAL_COMMA.match(value):
        return "has a comma in a number", f"write the decimal point: {key} = {found[1]}.{found[2]}"
    if found := _BARE_POINT.fullmatch(value):
        number = f"{found[1]}0.{found[2]}" if found[2] else f"{found[1]}{found[3]}.0"
        return "has a number that begins or ends with its point", f"write {key} = {number}"
    if found := _LEADING_ZERO.fullmatch(value):
        return "has a number with zeros before it", f"write {key} = {found[1]}{found[2]}"
    if found := _WITH_UNIT.fullmatch(value):
        return f"has {found[2]} behind a number", f"write {key} = {found[1]}; keys name the unit"
    if answer := _ANSWERS.get(value.lower()):
        return f"has {value} for a flag", f'write {key} = {answer}, or "{value}" if a text is wanted'
    if _SECOND_KEY.search(value):
        return "has two keys in one line", "write each key in a line of its own"
    if value[0].isalpha() and _WORD.fullmatch(value):
        mark = "'" if "\\" in value else '"'
        return "has a text without quotation marks", f"write {key} = {mark}{value[:_SHOWN]}{mark}"
    if value[0] in "\"'" and message.startswith("Expected newline"):
        return "has something behind the text in quotation marks", f"write only the text behind {key} ="
    if "\\" in value or value[:1] in "./" or (len(value) > 1 and value[1] == ":"):
        return "has a text without quotation marks", f"write {key} = '{value[:_SHOWN]}'"
    return None


def _without_comment(value: str) -> str:
    """Return a value without the comment behind it, if no text begins before that."""
    before = value.partition("#")[0]
    return before.strip() if not {'"', "'"} & set(before) else value
