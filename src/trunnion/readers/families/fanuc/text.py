"""Targets of jumps and calls in a Fanuc program: O numbers, block numbers and loops."""

import re
from bisect import bisect_left, bisect_right
from pathlib import Path
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.program.source_text import SourceText
from trunnion.records import dataclass

#: Endings of program names.
SUFFIXES: Final = (".NC", ".CNC", ".TAP", ".PRG", ".TXT", "")

#: How deep loops may nest; the control itself allows 3 levels.
MAX_NESTING: Final = 64

_START: Final = rb"^[ \t]*(?:(/[0-9]?)[ \t]*)?(?:N[ \t]*[0-9]+[ \t]*)?"
_O_NUMBER = re.compile(rb"^[ \t]*[O:][ \t]*([0-9]{1,8})(?![0-9])", re.IGNORECASE | re.MULTILINE)
#: Where a control numbers programs so: alone in its block, for tape marks are written with the same sign.
_PERCENT_NUMBER = re.compile(rb"^[ \t]*%[ \t]*([0-9]{1,8})(?=[ \t]*(?:[\r\n(;]|$))", re.MULTILINE)
_N_NUMBER = re.compile(rb"^[ \t]*(?:/[0-9]?[ \t]*)?N[ \t]*([0-9]{1,15})", re.IGNORECASE | re.MULTILINE)
#: What begins a block, and no mere text.
_BLOCK: Final = re.compile(
    r"/|#|<|(?:IF|WHILE|GOTO|DO|END)[ \t]*[\[0-9#]|[A-Z:][ \t]*[-+]?[ \t]*[.0-9#\[]", re.IGNORECASE
)
_COMMENT: Final = re.compile(r"\([^)]*\)|;.*")
#: Lines before a percent sign in which a text is looked for.
_MOST_TEXT: Final = 200
_LOOP = re.compile(
    _START + rb"(?:WHILE[ \t]*\[[^\n(]*\][ \t]*)?(DO|END)[ \t]*([0-9]{1,3})[ \t]*(?=[\r\n(;]|$)",
    re.IGNORECASE | re.MULTILINE,
)


@dataclass(slots=True)
class _JumpTargets:
    """Lines of O numbers, also in order, of block numbers, and of the other ends of DO and END; found on first use.

    percent   ``%`` begins a program number too
    """

    programs: dict[int, int] | None = None
    begins: list[int] | None = None
    numbers: dict[int, list[int]] | None = None
    loops: dict[int, int] | None = None
    percent: bool = False


class FanucText(SourceText):
    """A program file with the targets of its jumps and calls."""

    def __init__(self, path: Path, *, whole: bool = False, encoding: str = "") -> None:
        # Shared by the copies that ``restarted`` makes.
        self._jump_targets = _JumpTargets()
        super().__init__(path, whole=whole, encoding=encoding)

    def skip_text(self) -> int:
        """Go past texts that stand before the first percent sign of the file, and behind which a program follows.

        A control leaves out what comes before that sign. Lines that may be blocks are not gone past. Returns the line
        of the first such text, 0 where there is none.
        """
        text = 0
        if not self.fill():
            return 0
        begin, first = self.position, self.line
        while self.line - first < _MOST_TEXT and self.position < len(self.buffer):
            at, line, content = self.position, self.line, _COMMENT.sub("", self.next_line()).strip()
            if content.startswith("%"):
                has_more = bool(self.buffer[self.position :].tobytes().strip())
                if text and has_more:
                    self.position, self.line = at, line
                    return text
                break
            if _BLOCK.match(content):
                break
            text = text or (line if content else 0)
        self.position, self.line = begin, first
        return 0

    def number_by_percent(self) -> None:
        """Take ``%1234`` for a program number too, as the definition states."""
        self._jump_targets.percent = True

    def program(self, number: int) -> int | None:
        """Return the line of an O number, None if the file does not have it."""
        return self._programs().get(number)

    def numbers(self) -> tuple[str, ...]:
        """Return the O numbers of the file, as they are called."""
        return tuple(f"O{number:04d}" for number in sorted(self._programs()))

    def _programs(self) -> dict[int, int]:
        if self._jump_targets.programs is None:
            found: dict[int, int] = {}
            for sign in (_O_NUMBER, _PERCENT_NUMBER) if self._jump_targets.percent else (_O_NUMBER,):
                for match in sign.finditer(self.whole_bytes()):
                    found.setdefault(int(match.group(1)), self.line_of(match.start(1)))
            self._jump_targets.programs = found
        return self._jump_targets.programs

    def program_lines(self, line: int) -> tuple[int, int]:
        """Return the first line of the O program of a line, and the line after its last."""
        begins = self._jump_targets.begins
        if begins is None:
            begins = self._jump_targets.begins = sorted(self._programs().values())
        at = bisect_right(begins, line)
        return begins[at - 1] if at else 1, begins[at] if at < len(begins) else self.lines + 1

    def number(self, number: int, here: int) -> int | None:
        """Return the line of a block number: the next one after ``here``, else the first of the program."""
        lines, begin, end = self._lines_of_number(number, here)
        at = bisect_right(lines, here, begin, end)
        return lines[at if at < end else begin] if begin < end else None

    def doubled_number(self, number: int, here: int) -> tuple[int, int] | None:
        """Return the first two lines of a block number that the program of a line has more than once, or None."""
        lines, begin, end = self._lines_of_number(number, here)
        return (lines[begin], lines[begin + 1]) if end - begin > 1 else None

    def _lines_of_number(self, number: int, here: int) -> tuple[list[int], int, int]:
        """Return the lines with a block number, and from and before which of them they are in the program of a line."""
        if self._jump_targets.numbers is None:
            numbers: dict[int, list[int]] = {}
            for match in _N_NUMBER.finditer(self.whole_bytes()):
                numbers.setdefault(int(match.group(1)), []).append(self.line_of(match.start(1)))
            self._jump_targets.numbers = numbers
        first, end = self.program_lines(here)
        lines = self._jump_targets.numbers.get(number, [])
        return lines, bisect_left(lines, first), bisect_left(lines, end)

    def partner(self, line: int) -> int:
        """Return the line of the END of a DO, or of the DO of an END."""
        if self._jump_targets.loops is None:
            self._jump_targets.loops = self._match_loops()
        try:
            return self._jump_targets.loops[line]
        except KeyError:
            raise self.problem(line, Wording("NC142", "stray_do_or_end")) from None

    def _match_loops(self) -> dict[int, int]:
        partners: dict[int, int] = {}
        open_: list[tuple[int, int, bytes]] = []
        for match in _LOOP.finditer(self.whole_bytes()):
            line = self.line_of(match.start(2))
            number, skip = int(match.group(3)), _skip_level(match.group(1))
            if match.group(2).upper() == b"DO":
                open_.append((number, line, skip))
                if len(open_) > MAX_NESTING:
                    raise self.problem(line, Wording("NC141", "loops_too_deep", most=MAX_NESTING))
            elif not open_ or open_[-1][0] != number:
                raise self.problem(line, Wording("NC142", "end_without_do", number=number))
            else:
                _, begin, skip_of_begin = open_.pop()
                if skip != skip_of_begin:
                    word, beginning = f"END{number}", f"DO{number}"
                    raise self.problem(line, Wording("NC142", "skip_of_part", word=word, beginning=beginning))
                partners[begin], partners[line] = line, begin
        if open_:
            raise self.problem(open_[-1][1], Wording("NC142", "never_ends", word=f"DO{open_[-1][0]}"))
        return partners


def _skip_level(sign: bytes | None) -> bytes:
    """Return a skip sign with its level; empty: there is none."""
    return b"/1" if sign == b"/" else sign or b""
