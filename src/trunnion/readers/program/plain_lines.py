"""Lines of a program in the form that its family's reader knows.

In:     a line as it stands, and the form of the programs (``forms``).
Out:    the same line with its comment, block number, program number and end mark as the family writes them.
"""

import re
from collections.abc import Iterator
from typing import Final

from trunnion.readers.program.forms import Form

_CLOSING: Final = {"{": "}"}
_NUMBER: Final = re.compile(r"(?<![A-Z0-9#<\[.])N[ \t]*[0-9]+", re.IGNORECASE)
_SKIP: Final = re.compile(r"[ \t]*/[0-9]?")
_PROGRAM_NUMBER: Final = re.compile(r"[ \t]*([O:%])[ \t]*([0-9]{1,8})[ \t]*", re.IGNORECASE)


class PlainLines:
    """Brings lines into the form of the family.

    form      what the definition states
    own       how the family writes comments: its sign, and the one that closes it, which may be empty
    texts     sign around texts in which nothing is a comment; empty: there are none
    letter    the letter of program numbers; empty: the family has none, and they become comments
    """

    def __init__(self, form: Form, own: tuple[str, str], texts: str = "", letter: str = "") -> None:
        self._own, self._texts, self._letter = own, texts, letter
        self._comments, self._ends = form.has("more_comments"), form.has("block_ends")
        self._programs = form.has("program_numbers")
        self._anywhere = form.is_so("numbers_anywhere", "anywhere")
        self._marks = form.is_so("tape_marks", "ignored")
        self._nested = form.is_so("nested_comments", "counted")
        self.any = bool(self._comments or self._ends or self._programs or self._anywhere or self._marks or self._nested)

    def plain(self, raw: str) -> str:
        """Return a line in the form of the family."""
        if not self.any:
            return raw
        line = raw.rstrip("\r\n")
        code, comments = self._divided(line)
        code = self._without_end(code)
        if self._marks and code.strip() == "%":
            code = ""
        number = _PROGRAM_NUMBER.fullmatch(code)
        if number is not None and number[1].upper() in self._programs:
            code = f"{self._letter}{number[2]}" if self._letter else ""
            comments = comments if self._letter else [f"{number[1]}{number[2]}", *comments]
        if self._anywhere and (found := _NUMBER.search(code)) is not None:
            code = _with_number_first(code, found)
        return "".join((code, *self._written(comments)))

    def _divided(self, line: str) -> tuple[str, list[str]]:
        """Return a line without its comments, and these."""
        code: list[str] = []
        comments: list[str] = []
        signs = sorted({*self._comments, self._own[0]}, key=len, reverse=True)
        at, in_text = 0, False
        while at < len(line):
            if self._texts and line[at] == self._texts:
                in_text = not in_text
            sign = "" if in_text else next((each for each in signs if line.startswith(each, at)), "")
            if not sign:
                code.append(line[at])
                at += 1
                continue
            closing = self._own[1] if sign == self._own[0] else _CLOSING.get(sign, "")
            end = self._end(line, at, sign, closing)
            if end < 0:  # it does not end, which the reader of the family reports
                code.append(line[at:])
                break
            comments.append(line[at + len(sign) : end])
            at = end + len(closing)
        return "".join(code), comments

    def _end(self, line: str, at: int, sign: str, closing: str) -> int:
        """Return where the comment that begins at a sign ends, -1 if it does not."""
        if not closing:
            return len(line)
        if not (self._nested and sign == self._own[0]):
            return line.find(closing, at)
        depth = 0
        for place in range(at, len(line)):
            depth += (line[place] == sign) - (line[place] == closing)
            if not depth:
                return place
        return -1

    def _without_end(self, code: str) -> str:
        """Return a block without the mark that ends it."""
        bare = code.rstrip()
        mark = next((each for each in self._ends if bare.endswith(each)), "")
        return bare[: len(bare) - len(mark)] if mark else code

    def _written(self, comments: list[str]) -> Iterator[str]:
        """Yield comments as the family writes them."""
        begin, end = self._own
        for comment in comments:
            text = comment.replace(begin, " ")
            yield f"{begin}{text.replace(end, ' ') if end else text}{end}"


def _with_number_first(code: str, number: re.Match[str]) -> str:
    """Return a block with its number at the beginning, behind the sign of block skip if there is one."""
    skip = _SKIP.match(code)
    begin = skip.end() if skip is not None else 0
    return f"{code[:begin]}{number[0]} {code[begin : number.start()]}{code[number.end() :]}"
