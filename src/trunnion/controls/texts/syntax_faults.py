"""What Jinja does not understand of a template, in the words of those who write templates.

In:     the text of a template, and the line at which Jinja's parser gave up.
Out:    what is wrong there, and what to write, at the line where it began.

The tags of the text are read once more, simply: where each begins and ends, which statements are open, and the slips
that people make within them. Jinja's own words never reach the user.
"""

import re
import unicodedata
from collections.abc import Iterator
from typing import Final

from trunnion.controls.texts.values import Fault
from trunnion.definitions.messages import meant_word
from trunnion.records import dataclass

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
    shown = text.split("\n")[line - 1][:_SHOWN] if where is None else str(where)
    return Fault("tag_not_understood", line, tag=shown)


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
        return Fault("text_does_not_end", line, tag=shown, quote=quote)
    return Fault("tag_does_not_end", line, tag=shown, closing=_ENDS[opening])


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
                return Fault("end_without_beginning", tag.line, tag=str(tag), beginning=begin)
            last = open_.pop()
            if last.statement != begin:
                end = _END_OF[last.statement]
                return Fault("other_must_end_first", tag.line, tag=str(tag), other=str(last), line=last.line, end=end)
        elif name in _WITHIN and (not open_ or open_[-1].statement not in _WITHIN[name]):
            return Fault("branch_without_if", tag.line, tag=str(tag))
    if open_:
        last = open_[-1]
        return Fault("beginning_without_end", last.line, tag=str(last), end=_END_OF[last.statement])
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
        return Fault("unseen_sign_by_name", tag.line, tag=str(tag), sign=_code_of(unseen), name=name)
    slips = (_statement_slip, _sign_slip, _comparison_slip, _bracket_slip, _missing_slip)
    return next((found for slip in slips if (found := slip(tag, bare)) is not None), None)


def _is_invisible(sign: str) -> bool:
    return unicodedata.category(sign) == "Cf"


def _code_of(sign: str) -> str:
    return f"U+{ord(sign):04X}"


def _statement_slip(tag: _Tag, bare: str) -> Fault | None:
    """Return a statement that there is not, or one with words that do not belong to it."""
    name, line, shown = tag.statement, tag.line, str(tag)
    if tag.opening == "{{":
        return None
    if name not in _STATEMENTS:
        return _no_statement(tag, bare)
    if name == "else" and bare:
        return Fault("if_behind_else" if bare.startswith("if") else "something_behind_else", line, tag=shown)
    if name in _END_OF.values() and bare:
        return Fault("something_behind_end", line, tag=shown, end=name)
    if name == "for" and not re.match(r"[A-Za-z_]\w*\s+in\s+\S", bare):
        return Fault("no_loop", line, tag=shown)
    if name == "set" and not re.match(r"[A-Za-z_]\w*\s*=(?!=)\s*\S", bare):
        return Fault("sets_nothing", line, tag=shown)
    if name in ("if", "elif") and re.search(r"(\bthen|:)$", bare):
        return Fault("behind_condition", line, tag=shown, sign=bare.split()[-1].lstrip(":") or ":")
    return None


def _no_statement(tag: _Tag, bare: str) -> Fault:
    """Return a word that is no statement, or that none is there."""
    name, line, shown = tag.statement, tag.line, str(tag)
    if not name:
        return Fault("without_statement", line, tag=shown, known=_STATEMENTS)
    if name == "end":
        following = _WORD.match(bare)
        if following is None:
            return Fault("end_alone", line, tag=shown)
        return Fault("end_in_two_words", line, tag=shown, statement=following[0].lower())
    meant = _OTHER_NAMES.get(name.lower()) or (name.lower() if name.lower() in _STATEMENTS else "")
    if meant:
        return Fault("statement_of_other_language", line, tag=shown, meant=meant)
    if near := meant_word(name, _STATEMENTS):
        return Fault("no_statement_but_near", line, tag=shown, near=near)
    return Fault("no_statement", line, tag=shown, known=_STATEMENTS)


#: Signs of other languages, and the message about each.
_SIGNS: Final[tuple[tuple[str, str], ...]] = (
    (r"&&?", "sign_for_and"), (r"\|\|", "sign_for_or"), (r"!(?!=)", "sign_for_not"), (r"<>", "sign_for_unequal"),
    (r"=>", "sign_for_at_least"), (r"=<", "sign_for_at_most"), (r"\?", "sign_for_choice"),
    (r";", "needless_sign"), (r"\$", "needless_sign"), (r"\^", "sign_for_power"),
    ("[\u00d7\u00b7\u22c5\u2219\u2715\u2716]", "sign_for_times"), ("[\u00f7\u2215\u2044]", "sign_for_divided"),
    ("[\u2212\u2010-\u2015]", "sign_for_minus"), ("\u2264", "sign_for_at_most"),
    ("\u2265", "sign_for_at_least"), ("\u2260", "sign_for_unequal"), ("\u00b0", "sign_of_unit"),
    ("[\u00b2\u00b3]", "sign_for_power"), ("[\u00bc-\u00be]", "sign_for_fraction"),
    ("\u221a", "sign_for_root"),
)  # fmt: skip


def _sign_slip(tag: _Tag, bare: str) -> Fault | None:
    found = _TYPOGRAPHIC.search(bare)
    if found is not None:
        return Fault("typographic_quotation_mark", tag.line, tag=str(tag), mark=found[0])
    for pattern, variant in _SIGNS:
        match = re.search(pattern, bare)
        if match is not None:
            return Fault(variant, tag.line, tag=str(tag), sign=match[0])
    return None


def _comparison_slip(tag: _Tag, bare: str) -> Fault | None:
    """Return a single equals sign where something is compared."""
    value = bare.partition("=")[2] if tag.statement == "set" else bare
    if re.search(r"(?<![=!<>])=(?!=)", value):
        return Fault("single_equals", tag.line, tag=str(tag))
    return None


_CLOSING: Final = {"(": ")", "[": "]", "{": "}"}


def _bracket_slip(tag: _Tag, bare: str) -> Fault | None:
    """Brackets that do not match."""
    open_: list[str] = []
    for sign in bare:
        if sign in _CLOSING:
            open_.append(sign)
        elif sign in _CLOSING.values() and (not open_ or _CLOSING[open_.pop()] != sign):
            return Fault("closes_no_bracket", tag.line, tag=str(tag), sign=sign)
    if open_:
        return Fault("bracket_not_closed", tag.line, tag=str(tag), sign=open_[-1], closing=_CLOSING[open_[-1]])
    return None


#: What cannot be the last part of an expression.
_OPEN_ENDED: Final = re.compile(r"(?:[-+*/%~.,|]|==|!=|<=?|>=?|\b(?:and|or|not|in|is|if|else))$")


def _missing_slip(tag: _Tag, bare: str) -> Fault | None:
    """Values that are missing, or that stand side by side."""
    line, shown = tag.line, str(tag)
    if not bare and tag.statement not in ("else", *_END_OF.values()):
        return Fault("nothing_in_it", line, tag=shown)
    ends = _OPEN_ENDED.search(bare)
    if ends is not None:
        return Fault("nothing_behind", line, tag=shown, sign=ends[0])
    unit = re.search(r"(?<![\w.])(\d+(?:\.\d+)?)([A-Za-z]\w*)", bare)
    if unit is not None:
        return Fault("unit_behind_number", line, tag=shown, unit=unit[2])
    beside = re.search(_SIDE_BY_SIDE, bare)
    if beside is not None:
        return Fault("side_by_side", line, tag=shown, first=beside[1], second=beside[2])
    return None


_OPERATORS: Final = "and|or|not|in|is|if|else|for|set"
_SIDE_BY_SIDE: Final = (
    rf"(?<![\w.'])((?!(?:{_OPERATORS})\b)[\w.]+|'_*')\s+((?!(?:{_OPERATORS})\b)(?:[A-Za-z_0-9]\w*|'_*'))"
)
