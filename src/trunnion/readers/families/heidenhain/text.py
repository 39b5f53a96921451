"""Targets of the jumps in a Klartext program: labels."""

import re
from dataclasses import field
from pathlib import Path
from typing import Final

from trunnion.readers.program.source_text import SourceText
from trunnion.records import dataclass

#: Endings of program names.
SUFFIXES: Final = (".H", "")

# No two runs of blanks follow each other: matching a line of blanks would take quadratic time.
_LABEL = re.compile(
    rb'^[ \t]*(?:/[ \t]*)?(?:[0-9]+[ \t]*)?LBL[ \t]*(?:([0-9]{1,5})|"([^"\r\n]{1,64})")', re.IGNORECASE | re.MULTILINE
)


@dataclass(slots=True)
class _JumpTargets:
    """Lines of labels, found on first use.

    passed   lines of the labels that were passed so far, in a program without jumps
    doubled  label, line and first line of each that is set once more and has not been taken
    told     lines of those that were found
    """

    labels: dict[str, int] | None = None
    passed: dict[str, int] = field(default_factory=dict)
    doubled: list[tuple[str, int, int]] = field(default_factory=list)
    told: set[int] = field(default_factory=set)


class KlartextText(SourceText):
    """A program file with the targets of its jumps."""

    def __init__(self, path: Path, *, whole: bool = False, encoding: str = "") -> None:
        # Shared by the copies that ``restarted`` makes.
        self._jump_targets = _JumpTargets()
        super().__init__(path, whole=whole, encoding=encoding)

    def label(self, name: str) -> int | None:
        """Return the first line of a label, by number or name, or None; label 0 ends subprograms and is no target."""
        labels = self._jump_targets.labels
        if labels is None:
            labels = self._jump_targets.labels = {}
            for match in _LABEL.finditer(self.whole_bytes()):
                self._set(labels, self._name_of(match), self.line_of(match.start(1 if match[1] is not None else 2)))
        return labels.get(name)

    def subprogram(self, name: str) -> list[tuple[int, str]] | None:
        """Return the lines of a label, each with its number, up to label 0 or the end; None: it is not set."""
        first = self.label(name)
        if first is None:
            return None
        here, found = self.line, []
        self.jump(first + 1)
        while self.fill():
            number, raw = self.line, self.next_line()
            if (match := _LABEL.match(raw.encode("latin-1", "replace"))) and self._name_of(match) == "0":
                break
            found.append((number, raw))
        self.jump(here)
        return found

    def pass_label(self, raw: str, line: int) -> None:
        """Remember the label that a line sets, if it sets one and no jump has found them all."""
        if self._jump_targets.labels is None and (match := _LABEL.match(raw.encode("latin-1", "replace"))):
            self._set(self._jump_targets.passed, self._name_of(match), line)

    def take_doubled_labels(self) -> list[tuple[str, int, int]]:
        """Return each label that is set more than once, its line, and the line that set it first; at most once."""
        found, self._jump_targets.doubled = self._jump_targets.doubled, []
        return found

    def _name_of(self, match: re.Match[bytes]) -> str:
        return str(int(match[1])) if match[1] is not None else self.text_of(match[2]).upper()

    def _set(self, labels: dict[str, int], name: str, line: int) -> None:
        """Set a label; label 0 ends subprograms and is no target."""
        if name != "0" and labels.setdefault(name, line) != line and line not in self._jump_targets.told:
            self._jump_targets.told.add(line)
            self._jump_targets.doubled.append((name, line, labels[name]))
