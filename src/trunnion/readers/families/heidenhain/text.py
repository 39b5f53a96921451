"""Targets of the jumps in a Klartext program: labels."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from trunnion.readers.program.source_text import SourceText

#: Endings of program names.
SUFFIXES: Final = (".H", "")

# No two runs of blanks follow each other: matching a line of blanks would take quadratic time.
_LABEL = re.compile(
    rb'^[ \t]*(?:/[ \t]*)?(?:[0-9]+[ \t]*)?LBL[ \t]*(?:([0-9]{1,5})|"([^"\r\n]{1,64})")', re.IGNORECASE | re.MULTILINE
)


@dataclass(slots=True)
class _JumpTargets:
    """Lines of labels; found on first use."""

    labels: dict[str, int] | None = None


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
                number, text = match.groups()
                key = str(int(number)) if number is not None else self.text_of(text).upper()
                labels.setdefault(key, self.line_of(match.start(1 if number is not None else 2)))
            labels.pop("0", None)
        return labels.get(name)
