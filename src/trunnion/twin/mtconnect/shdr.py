"""Lines of SHDR: texts of a program that end neither their field nor their line, and begin no other one.

How an agent takes a line apart is not in the standard: it is what MTConnect's agent in C++ does (``ShdrTokenizer`` and
``ShdrAdapter``). A field that begins with a quotation mark goes up to the next one behind which a bar or the end comes,
and a backslash in it takes the next character as it is. Elsewhere quotation marks and backslashes are letters.
"""

from typing import Final

#: With this anywhere in a line all lines behind it are one text, up to one that repeats it.
_MULTILINE: Final = "--multiline--"

#: What means something within quotation marks.
_ESCAPED: Final = str.maketrans({"\\": "\\\\", '"': '\\"', "|": "\\|"})


def shdr_line(*fields: str) -> str:
    """Return the line of some fields."""
    return "|".join(map(shdr_field, fields)) + "\n"


def shdr_field(text: str) -> str:
    """Return a text as a field from which an agent reads it as ``shown_text`` has it."""
    shown = shown_text(text)
    if "|" not in shown and not shown.startswith('"') and _MULTILINE not in shown:
        return shown
    quoted = shown.translate(_ESCAPED).replace(_MULTILINE, _MULTILINE[:-1] + "\\" + _MULTILINE[-1])
    return f'"{quoted}"'


def shown_text(text: str) -> str:
    """Return a text without what neither a field nor XML can hold: characters of control, what is no character, and
    more than one blank.
    """
    printable = "".join(" " if letter.isspace() else letter for letter in text if _is_text(letter))
    return " ".join(printable.split())


def _is_text(letter: str) -> bool:
    control = letter < " " or "\x7f" <= letter < "\xa0"
    return letter.isspace() or not (control or "\ud800" <= letter <= "\udfff" or letter in "\ufffe\uffff")
