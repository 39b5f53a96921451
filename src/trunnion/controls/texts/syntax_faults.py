"""What Jinja does not understand of a template, in the words of those who write templates.

In:     the text of a template, and the line at which Jinja's parser gave up.
Out:    what is wrong there, and what to write, at the line where it began.

The tags of the text are read once more, simply: where each begins and ends, which statements are open, and the slips
that people make within them. Jinja's own words never reach the user.
"""

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from trunnion.controls.texts.values import Fault, question
from trunnion.definitions.messages import meant_word

_LANGUAGE: Final = "docs/templates.md has the language"

#: What tags begin and end with.
_ENDS: Final = {"{%": "%}", "{{": "}}", "{#": "#}"}
_OPENING: Final = re.compile(r"\{[%{#]")

#: Statements, with the one that ends each; empty for those that end nothing and need no end.
_END_OF: Final = {"if": "endif", "for": "endfor"}
_WITHIN: Final = {"elif": ("if",), "else": ("if", "for")}
_STATEMENTS: Final = ("if", "elif", "else", "endif", "for", "endfor", "set")

#: What other languages call them.
_OTHER_NAMES: Final = {"elseif": "elif", "elsif": "elif", "elif:": "elif", "foreach": "for", "while": "for"}

#: A tag is shown as far as this.
_SHOWN: Final = 50

_WORD: Final = re.compile(r"[A-Za-z_]\w*")
_TEXT: Final = re.compile(r"'[^']*'|\"[^\"]*\"")
_TYPOGRAPHIC: Final = re.compile("[\u2018-\u201f\u00ab\u00bb\u2039\u203a\u00b4`]")


@dataclass(frozen=True, slots=True)
class _Tag:
    """A tag: what it begins with, what stands in it, its line from 1; ``fault`` if it does not end as it must."""

    opening: str
    body: str
    line: int
    fault: Fault | None = None

    @property
    def statement(self) -> str:
        """The first word of a statement; empty for an expression or a remark."""
        match = _WORD.match(self._content) if self.opening == "{%" else None
        return "" if match is None else match[0]

    @property
    def expression(self) -> str:
        """What stands behind the first word of a statement, or the whole of an expression."""
        return self._content[len(self.statement) :].strip()

    @property
    def _content(self) -> str:
        """What stands in it, without the signs beside its braces that take blanks away."""
        return self.body.removeprefix("-").removeprefix("+").removesuffix("-").removesuffix("+").strip()

    def __str__(self) -> str:
        shown = " ".join(f"{self.opening}{self.body}{_ENDS[self.opening]}".split())
        shown = "".join(f"<{_code_of(sign)}>" if _is_invisible(sign) else sign for sign in shown)
        return shown if len(shown) <= _SHOWN else f"{shown[:_SHOWN]}…"


def syntax_fault(text: str, line: int) -> Fault:
    """Return what is wrong with a template that Jinja refuses at a line, counted from 1."""
    tags = list(_tags(text))
    near = [tag for tag in tags if tag.line <= line and line <= tag.line + tag.body.count("\n")]
    for fault in (
        next((tag.fault for tag in tags if tag.fault is not None), None),
        next((found for tag in near if (found := _slip(tag)) is not None), None),
        _nesting(tags),
        next((found for tag in tags if (found := _slip(tag)) is not None), None),
    ):
        if fault is not None:
            return fault
    where = next((tag for tag in near if tag.opening != "{#"), None)
    what = "is not understood" if where is None else f"has {where}, which is not understood"
    return Fault(f"{what}: a word, a sign or a value too many or too few", _LANGUAGE, line)


# Where tags end


def _tags(text: str) -> Iterator[_Tag]:
    at = 0
    while (match := _OPENING.search(text, at)) is not None:
        line = 1 + text.count("\n", 0, match.start())
        end = _end(text, match.end(), _ENDS[match[0]], plain=match[0] == "{#")
        if isinstance(end, str):
            yield _Tag(match[0], _rest(text, match.end()), line, _unended(match[0], end, line, text, match.start()))
            return
        yield _Tag(match[0], text[match.end() : end], line)
        at = end + 2


def _end(text: str, at: int, closing: str, *, plain: bool) -> int | str:
    """Return the place of what closes a tag; else why there is none: a quotation mark that is open, or empty."""
    if plain:
        found = text.find(closing, at)
        return found if found >= 0 else ""
    while at < len(text):
        if text.startswith(closing, at):
            return at
        if text[at] in "'\"":
            end = text.find(text[at], at + 1)
            if end < 0 or "\n" in text[at:end] or "%}" in text[at:end] or "}}" in text[at:end]:
                return text[at]
            at = end
        elif _OPENING.match(text, at):
            return ""
        at += 1
    return ""


def _unended(opening: str, quote: str, line: int, text: str, at: int) -> Fault:
    shown = _rest(text, at)[:_SHOWN].rstrip()
    if quote:
        what = f"has {shown} with a text that begins with {quote} and does not end"
        return Fault(what, f"write {quote} behind it", line)
    closing = _ENDS[opening]
    return Fault(f"has {shown}, which does not end with {closing}", f"write {closing} behind it", line)


def _rest(text: str, at: int) -> str:
    """Return the rest of a line."""
    return text[at:].partition("\n")[0]


# Which statements are open


def _nesting(tags: list[_Tag]) -> Fault | None:
    """Return what is wrong with the beginnings and ends of statements."""
    open_: list[_Tag] = []
    for tag in tags:
        name = tag.statement
        if name in _END_OF:
            open_.append(tag)
        elif name in _END_OF.values():
            begin = name.removeprefix("end")
            if not open_:
                return Fault(f"has {tag} without its {{% {begin} … %}}", "take it out, or write what it ends", tag.line)
            last = open_.pop()
            if last.statement != begin:
                what = f"has {tag} where the {last} of line {last.line} of the template must end first"
                return Fault(what, f"write {{% {_END_OF[last.statement]} %}} before it", tag.line)
        elif name in _WITHIN and (not open_ or open_[-1].statement not in _WITHIN[name]):
            return Fault(f"has {tag} without its {{% if … %}}", "take it out, or write the condition", tag.line)
    if open_:
        end = _END_OF[open_[-1].statement]
        return Fault(f"has {open_[-1]} without its {{% {end} %}}", f"write {{% {end} %}} where it ends", open_[-1].line)
    return None


# Slips within a tag


def _slip(tag: _Tag) -> Fault | None:
    """Return what is wrong within a tag."""
    if tag.opening == "{#" or tag.fault is not None:
        return tag.fault
    bare = _TEXT.sub(lambda found: "'" + "_" * (len(found[0]) - 2) + "'", tag.expression)
    unseen = next((sign for sign in _TEXT.sub("", tag.body) if _is_invisible(sign)), "")
    if unseen:
        name = unicodedata.name(unseen, "").lower()
        what = f"has {tag} with a sign that nobody sees, {_code_of(unseen)}{name and f' ({name})'}"
        return Fault(what, "delete it, and write the part anew", tag.line)
    for slip in (_statement_slip, _sign_slip, _comparison_slip, _bracket_slip, _missing_slip):
        found = slip(tag, bare)
        if found is not None:
            return Fault(found[0], found[1], tag.line)
    return None


def _is_invisible(sign: str) -> bool:
    return unicodedata.category(sign) == "Cf"


def _code_of(sign: str) -> str:
    return f"U+{ord(sign):04X}"


def _statement_slip(tag: _Tag, bare: str) -> tuple[str, str] | None:
    """Return a statement that there is not, or one with words that do not belong to it."""
    name = tag.statement
    if tag.opening == "{{":
        return None
    if name not in _STATEMENTS:
        if not name:
            return f"has {tag} without a statement", f"write one of {', '.join(_STATEMENTS)}"
        if name == "end":
            following = _WORD.match(bare)
            if following is None:
                return f"has {tag}, which is no statement", "write {% endif %} or {% endfor %}"
            return f"has {tag}, which is no statement", f"write {{% end{following[0].lower()} %}} in one word"
        meant = _OTHER_NAMES.get(name.lower()) or (name.lower() if name.lower() in _STATEMENTS else "")
        cure = f"write {meant}" if meant else question(meant_word(name, _STATEMENTS))
        return f"has {tag}, which is no statement", cure or f"write one of {', '.join(_STATEMENTS)}"
    if name == "else" and bare:
        cure = "write {% elif … %}" if bare.startswith("if") else "write {% else %}"
        return f"has {tag} with something behind else", cure
    if name in _END_OF.values() and bare:
        return f"has {tag} with something behind {name}", f"write {{% {name} %}}"
    if name == "for" and not re.match(r"[A-Za-z_]\w*\s+in\s+\S", bare):
        return f"has {tag}, which is no loop", "write {% for one in list %}"
    if name == "set" and not re.match(r"[A-Za-z_]\w*\s*=(?!=)\s*\S", bare):
        return f"has {tag}, which sets nothing", "write {% set name = value %}"
    if name in ("if", "elif") and re.search(r"(\bthen|:)$", bare):
        return f"has {tag} with {bare.split()[-1].lstrip(':') or ':'} behind the condition", "leave it out"
    return None


#: Signs of other languages, and what to write.
_SIGNS: Final[tuple[tuple[str, str], ...]] = (
    (r"&&?", "write and"), (r"\|\|", "write or"), (r"!(?!=)", "write not"), (r"<>", "write != for unequal"),
    (r"=>", "write >= for at least"), (r"=<", "write <= for at most"), (r"\?", "write a if b else c"),
    (r";", "leave it out"), (r"\$", "leave it out"), (r"\^", "powers are not there: multiply"),
    ("[\u00d7\u00b7\u22c5\u2219\u2715\u2716]", "write * to multiply"), ("[\u00f7\u2215\u2044]", "write / to divide"),
    ("[\u2212\u2010-\u2015]", "write the minus sign of the keyboard: -"), ("\u2264", "write <= for at most"),
    ("\u2265", "write >= for at least"), ("\u2260", "write != for unequal"), ("\u00b0", "write numbers without units"),
    ("[\u00b2\u00b3]", "powers are not there: multiply"), ("[\u00bc-\u00be]", "write a decimal number"),
    ("\u221a", "roots are not there"),
)  # fmt: skip


def _sign_slip(tag: _Tag, bare: str) -> tuple[str, str] | None:
    found = _TYPOGRAPHIC.search(bare)
    if found is not None:
        return f"has {tag} with the quotation mark {found[0]}", "write \" or '"
    for pattern, cure in _SIGNS:
        match = re.search(pattern, bare)
        if match is not None:
            return f"has {tag} with {match[0]}, which is no sign of the language", cure
    return None


def _comparison_slip(tag: _Tag, bare: str) -> tuple[str, str] | None:
    """Return a single equals sign where something is compared."""
    value = bare.partition("=")[2] if tag.statement == "set" else bare
    if re.search(r"(?<![=!<>])=(?!=)", value):
        return f"has {tag} with =, which compares nothing", "write == to compare"
    return None


_CLOSING: Final = {"(": ")", "[": "]", "{": "}"}


def _bracket_slip(tag: _Tag, bare: str) -> tuple[str, str] | None:
    """Brackets that do not match."""
    open_: list[str] = []
    for sign in bare:
        if sign in _CLOSING:
            open_.append(sign)
        elif sign in _CLOSING.values() and (not open_ or _CLOSING[open_.pop()] != sign):
            return f"has {tag} with {sign}, which closes no bracket", "take it out, or write what it closes"
    if open_:
        return f"has {tag} with {open_[-1]}, which is not closed", f"write {_CLOSING[open_[-1]]} where it ends"
    return None


#: What cannot be the last part of an expression.
_OPEN_ENDED: Final = re.compile(r"(?:[-+*/%~.,|]|==|!=|<=?|>=?|\b(?:and|or|not|in|is|if|else))$")


def _missing_slip(tag: _Tag, bare: str) -> tuple[str, str] | None:
    """Values that are missing, or that stand side by side."""
    if not bare and tag.statement not in ("else", *_END_OF.values()):
        return f"has {tag} with nothing in it", "write a value or a condition"
    ends = _OPEN_ENDED.search(bare)
    if ends is not None:
        return f"has {tag} with nothing behind {ends[0]}", "write a value behind it"
    unit = re.search(r"(?<![\w.])(\d+(?:\.\d+)?)([A-Za-z]\w*)", bare)
    if unit is not None:
        return f"has {tag} with {unit[2]} right behind a number", "write numbers without units"
    beside = re.search(_SIDE_BY_SIDE, bare)
    if beside is not None:
        return f"has {tag} with {beside[1]} and {beside[2]} side by side", 'join texts by ~, and write texts in "…"'
    return None


_OPERATORS: Final = "and|or|not|in|is|if|else|for|set"
_SIDE_BY_SIDE: Final = (
    rf"(?<![\w.'])((?!(?:{_OPERATORS})\b)[\w.]+|'_*')\s+((?!(?:{_OPERATORS})\b)(?:[A-Za-z_0-9]\w*|'_*'))"
)
