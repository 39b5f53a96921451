"""Targets of the jumps in a Sinumerik program: labels, block numbers and control structures."""

import re
from bisect import bisect_left, bisect_right
from dataclasses import field
from pathlib import Path
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.program.source_text import SourceText
from trunnion.records import dataclass

# No two runs of blanks follow each other: matching a line of blanks would take quadratic time.
_START = rb"^[ \t]*(?:/[0-9]?[ \t]*)?(?:N[0-9]+[ \t]*)?"
_LABEL = re.compile(_START + rb"([A-Z_][A-Z_][A-Z0-9_]*)[ \t]*:(?!=)", re.IGNORECASE | re.MULTILINE)
_NUMBER = re.compile(rb"^[ \t]*(?:/[0-9]?[ \t]*)?N([0-9]{1,15})", re.IGNORECASE | re.MULTILINE)
_STRUCTURE = re.compile(
    rb"^[ \t]*(?:(/[0-9]?)[ \t]*)?(?:N[0-9]+[ \t]*)?(?:[A-Z_][A-Z_][A-Z0-9_]*[ \t]*:[ \t]*)?"
    rb"(IF|ELSE|ENDIF|FOR|ENDFOR|WHILE|ENDWHILE|LOOP|ENDLOOP|REPEAT|UNTIL)(?![A-Z0-9_])([^\n;]*)",
    re.IGNORECASE | re.MULTILINE,
)
_JUMPS = re.compile(rb"(?<![A-Z0-9_])GOTO[FBCS]?(?![A-Z0-9_])", re.IGNORECASE)

#: The keyword that begins a structure, by the one that ends it.
_ENDS: Final = {"ENDIF": "IF", "ENDFOR": "FOR", "ENDWHILE": "WHILE", "ENDLOOP": "LOOP", "UNTIL": "REPEAT"}

#: How deep control structures may nest.
MAX_NESTING: Final = 64


#: Endings of program names; a subprogram takes precedence over a main program.
SUFFIXES: Final = (".SPF", "_SPF", ".MPF", "_MPF", "")


@dataclass(slots=True, eq=False)
class _JumpTargets:
    """Lines of labels and block numbers, and the counterparts of keywords; each found on first use.

    repeated  the first and the last line of the part that a REPEAT repeats, by its line; None: there is none
    """

    labels: dict[str, list[int]] | None = None
    numbers: dict[int, list[int]] | None = None
    partners: dict[int, tuple[int, int]] | None = None
    repeated: dict[int, tuple[int, int] | None] = field(default_factory=dict)


class SinumerikText(SourceText):
    """A program file with the targets of its jumps."""

    def __init__(self, path: Path, *, whole: bool = False, encoding: str = "") -> None:
        # Shared by the copies that ``restarted`` makes.
        self._jump_targets = _JumpTargets()
        super().__init__(path, whole=whole, encoding=encoding)

    def label(self, name: str, here: int, *, forward: bool, backward: bool) -> int | None:
        """Return the line of a label: the next one after ``here`` if ``forward``, else the last one before it."""
        labels = self._jump_targets.labels
        if labels is None:
            labels = self._jump_targets.labels = {}
            for match in _LABEL.finditer(self.whole_bytes()):
                labels.setdefault(match.group(1).decode().upper(), []).append(self.line_of(match.start(1)))
        return _choose_line(labels.get(name, []), here, forward=forward, backward=backward)

    def repeated_part(self, names: tuple[str, ...], here: int, *, one_block: bool) -> tuple[int, int] | None:
        """Return the first and the last line of the part that a REPEAT or REPEATB repeats; None: there is none.

        here       its line
        names      its labels; a label is looked for towards the beginning of the program, then towards its end
        one_block  it is the block of the label alone
        """
        known = self._jump_targets.repeated
        if here not in known:
            known[here] = self._find_part(names, here, one_block)
        return known[here]

    def _find_part(self, names: tuple[str, ...], here: int, one_block: bool) -> tuple[int, int] | None:
        found = [self.label(name, here, forward=False, backward=True) for name in names]
        found = [
            line or self.label(name, here, forward=True, backward=False)
            for line, name in zip(found, names, strict=True)
        ]
        if None in found:
            return None
        begin, last = found[0], found[-1]
        assert begin is not None
        assert last is not None
        if len(names) == 1 and not one_block:
            end = self.label("ENDLABEL", begin, forward=True, backward=False)
            last = here - 1 if end is None or (begin < here < end) else end
        lines = range(begin, last + 1)
        if not lines or here in lines:
            return None
        part = b"\n".join(self.whole_bytes().split(b"\n")[begin - 1 : last])
        return None if _JUMPS.search(part) else (begin, last)

    def number(self, number: int, here: int, *, forward: bool, backward: bool) -> int | None:
        """Return the line of a block number, found like a label."""
        numbers = self._jump_targets.numbers
        if numbers is None:
            numbers = self._jump_targets.numbers = {}
            for match in _NUMBER.finditer(self.whole_bytes()):
                numbers.setdefault(int(match.group(1)), []).append(self.line_of(match.start(1)))
        return _choose_line(numbers.get(number, []), here, forward=forward, backward=backward)

    def partner(self, line: int) -> tuple[int, int]:
        """Return the counterparts of a keyword: (ELSE or 0, end) of a beginning, (0, beginning) of an end."""
        if self._jump_targets.partners is None:
            self._jump_targets.partners = self._match_structures()
        try:
            return self._jump_targets.partners[line]
        except KeyError:
            raise self.problem(line, Wording("NC142", "stray_control_word")) from None

    def _match_structures(self) -> dict[int, tuple[int, int]]:
        partners: dict[int, tuple[int, int]] = {}
        open_: list[tuple[str, int, int, bytes]] = []
        for match in _STRUCTURE.finditer(self.whole_bytes()):
            word, rest, skip = match.group(2).decode().upper(), match.group(3), match.group(1) or b""
            line = self.line_of(match.start(2))
            if (word == "IF" and _JUMPS.search(rest)) or (word == "REPEAT" and rest.strip()):
                continue
            if word == "ELSE":
                if not open_ or open_[-1][0] != "IF" or open_[-1][2]:
                    raise self.problem(line, Wording("NC142", "without_if", word="ELSE"))
                self._check_skip(open_[-1], word, line, skip)
                open_[-1] = ("IF", open_[-1][1], line, skip)
            elif word in _ENDS:
                if not open_ or open_[-1][0] != _ENDS[word]:
                    raise self.problem(line, Wording("NC142", "without_word", word=word, beginning=_ENDS[word]))
                self._check_skip(open_[-1], word, line, skip)
                _, begin, middle, _ = open_.pop()
                partners[begin] = (middle, line)
                partners[line] = (0, begin)
                if middle:
                    partners[middle] = (0, line)
            else:
                open_.append((word, line, 0, skip))
                if len(open_) > MAX_NESTING:
                    raise self.problem(line, Wording("NC141", "structures_too_deep", most=MAX_NESTING))
        if open_:
            raise self.problem(open_[-1][1], Wording("NC142", "never_ends", word=open_[-1][0]))
        return partners

    def _check_skip(self, opened: tuple[str, int, int, bytes], word: str, line: int, skip: bytes) -> None:
        """Refuse a part of a structure that block skip takes out without its beginning, or the other way round."""
        if skip.removesuffix(b"0") != opened[3].removesuffix(b"0"):
            raise self.problem(line, Wording("NC142", "skip_of_part", word=word, beginning=opened[0]))


def _choose_line(lines: list[int], here: int, *, forward: bool, backward: bool) -> int | None:
    if forward:
        at = bisect_right(lines, here)
        if at < len(lines):
            return lines[at]
    if backward:
        at = bisect_left(lines, here + 1)
        if at > 0:
            return lines[at - 1]
    return None
