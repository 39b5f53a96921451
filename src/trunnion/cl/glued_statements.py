"""Refuses statements without a line of their own: a line end before them is lost, or a continuation sign is too many.

A text, a comment and a statement without effect would hide such a statement, so each is searched for words of others.
"""

import re
from collections.abc import Iterable
from typing import Final

from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import Dialect
from trunnion.cl.statement import Statement, joined_lines
from trunnion.cl.word_classes import ACTING_WORDS, words_that_count
from trunnion.messages import Wording

#: Statements that may stand without a slash.
_BARE_WORDS: Final = ("END-OF-PATH", "OPSTOP", "GOHOME", "RETRCT", "MULTAX", "RAPID", "AUTOPS", "FINI")
#: The same, and words that are too common to be looked for but at the beginning of a line.
_BARE_LINES: Final = frozenset({*_BARE_WORDS, "STOP", "END", "TLON", "REWIND"})
#: Statements behind which text may stand without a slash.
_TEXT_WORDS: Final = ("INSERT", "PPRINT", "TPRINT", "DISPLY", "DISPLAY", "PARTNO")
_SAYING_NOTHING: Final = frozenset({*_TEXT_WORDS, "PAINT", "MACHIN", "LEADER", "CLPRNT", "REMARK", "TOOLPATH"})
#: Shorter words are parts of too many names.
_SHORTEST: Final = 4

#: What stands behind the slash of a statement; words of a text may have a slash behind them as well.
_BEGINS_VALUES: Final = (
    r"(?:[-+.]?\d|(?:TOOL|MILL|DRILL|TCUTTER|BARREL|COLOR|RPM|SFM|SMM|CLW|CCLW|ON|OFF|FLOOD|MIST|TAP|THRU|AIR|LEFT|RIGHT"
    r"|MMPM|MMPR|IPM|IPR|INVERS|PERMIN|PERREV|MM|INCH(?:ES)?|XYPLAN|DEEP|BRKCHP|FACE|BORE|REAM|WORLD|MODE|ABSOL)\b)"
)
_BRACKET: Final = re.compile(r"[()]")
_GLUED_TEXT: Final = re.compile(rf"[^,/]({'|'.join(_TEXT_WORDS)})")
_CONTROL: Final = re.compile(r"[\x00-\x08\x0b-\x1f\x7f]")
_POINT: Final = re.compile(r"(GOTO|GODLTA)\s*/\s*[-+.]?\d", re.IGNORECASE)


class GluedStatements:
    """Finds statements of ``dialect`` within others."""

    def __init__(self, dialect: Dialect) -> None:
        counting = {word.removeprefix("->") for word in words_that_count(dialect)}
        self._words = frozenset(word for word in counting | ACTING_WORDS | _SAYING_NOTHING if len(word) >= _SHORTEST)
        listed = "|".join(r"\s*".join(map(re.escape, word)) for word in sorted(counting | {"TOOLPATH", "INSERT"}))
        self._longest = max(map(len, self._words))
        self._has_commands = any(word.startswith("->") for word in dialect.handlers)
        self._in_text = re.compile(rf"(?<=[^\s_/-])({listed})\s*/\s*{_BEGINS_VALUES}", re.IGNORECASE)

    def refuse(self, statement: Statement, comments: Iterable[str]) -> None:
        """Refuse a statement in which another one stands, also in one of its ``comments``.

        Raises ``StatementError`` if one does, or if a comment has a control character.
        """
        for comment in comments:
            if self._has_commands and comment.lstrip().startswith("->"):
                raise StatementError(Wording("CL160", "behind_begins_line", major=statement.major[:40]))
            self.refuse_in_comment(comment)
        if self._has_commands and "$$->" in statement.text:
            raise StatementError(Wording("CL160", "behind_begins_line", major=statement.major[:40]))
        if not statement.text:
            found = self._in_values(statement)
        else:
            point = None if statement.major == "REMARK" else _POINT.search(statement.text)
            found = point[1] if point else self._in_next_lines(statement.source) or self._in_words(statement.text)
        if found:
            raise StatementError(Wording("CL160", "within_statement_without", major=statement.major[:40], found=found))

    def refuse_in_comment(self, comment: str) -> None:
        """Refuse a comment in which a statement stands without a line of its own."""
        comment = comment.rstrip(" \t\r\n\x1a")
        if control := _CONTROL.search(comment):
            if control[0] == "\r":
                raise StatementError(Wording("CL150", "carriage_return_without"))
            raise StatementError(Wording("CL150", "unknown_encoding_byte_0x", ord=ord(control[0])))
        if found := self._in_words(comment):
            raise StatementError(Wording("CL160", "comment_within_statement", found=found))

    def _in_words(self, text: str) -> str:
        """Return the statement that is glued to a text or a comment; empty if there is none."""
        if "/" in text and (found := self._in_text.search(text)):
            return "".join(found[1].split()).upper()
        ends = (word for word in _BARE_WORDS if text.endswith(word))
        return next((word for word in ends if text[: -len(word)][-1:] not in ("", " ", "\t", "_", "-", "/")), "")

    def _in_next_lines(self, source: str) -> str:
        """Return the statement that a later line of a text begins with; empty if there is none."""
        for line in source.upper().split("\n")[1:]:
            word, slash, _ = line.partition("/")
            word = "".join(word.split())
            if word in _BARE_LINES or (slash and word in self._words):
                return word
        return ""

    def _in_values(self, statement: Statement) -> str:
        """Return the statement that stands among the values of another one; empty if there is none."""
        if not any(isinstance(value, str) for value in statement.values):
            return ""
        lines = statement.source.upper().split("\n")
        for line in lines[1:]:
            first = line.partition("$")[0].strip()
            if first in _BARE_LINES or first.startswith(_TEXT_WORDS):
                return first.split()[0]
        rest = "".join(joined_lines(statement.source).partition("/")[2].split()).upper()
        rest = _outside_brackets(rest)
        for before in rest.split("/")[:-1]:
            if found := self._ending(before.rpartition(",")[2]):
                return found
        if glued := _GLUED_TEXT.search(rest):
            return glued[1]
        last = rest.rpartition(",")[2]
        return next((word for word in _BARE_WORDS if last != word and last.endswith(word)), "")

    def _ending(self, field: str) -> str:
        """Return the longest known word at the end of a field; empty if there is none."""
        longest = field[-self._longest :]
        return next((longest[at:] for at in range(len(longest) - _SHORTEST + 1) if longest[at:] in self._words), "")


def _outside_brackets(text: str) -> str:
    """Return the text with a 0 for each pair of brackets that is in no other one."""
    parts, depth, begin = list[str](), 0, 0
    for found in _BRACKET.finditer(text):
        depth += 1 if found[0] == "(" else -1
        if depth < 0:
            return text
        if depth == 1 and found[0] == "(":
            parts.append(text[begin : found.start()])
        elif depth == 0:
            begin = found.end()
            parts.append("0")
    return text if depth else "".join(parts) + text[begin:]
