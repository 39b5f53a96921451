"""Where the jumps of a Klartext program lead: its labels."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from trunnion.readers.program.source_text import SourceText, decode

#: How names of programs end.
SUFFIXES: Final = (".H", "")

# Blanks are matched in one place each: two runs of them side by side would take quadratic time on a line of blanks.
_LABEL = re.compile(
    rb'^[ \t]*(?:/[ \t]*)?(?:[0-9]+[ \t]*)?LBL[ \t]*(?:([0-9]{1,5})|"([^"\r\n]{1,64})")', re.IGNORECASE | re.MULTILINE
)


@dataclass(slots=True)
class _JumpTargets:
    """Where the labels of a text stand, found out when they are first asked for."""

    labels: dict[str, int] | None = None


class KlartextText(SourceText):
    """A program file with the places where its jumps lead."""

    def __init__(self, path: Path, *, whole: bool = False) -> None:
        # Shared by all that run the same text: see ``restarted``.
        self._jump_targets = _JumpTargets()
        super().__init__(path, whole=whole)

    def label(self, name: str) -> int | None:
        """Line of a label, by its number or its name; of several the first. Label 0 ends subprograms and is none."""
        labels = self._jump_targets.labels
        if labels is None:
            labels = self._jump_targets.labels = {}
            for match in _LABEL.finditer(self.whole_bytes()):
                number, text = match.groups()
                key = str(int(number)) if number is not None else decode(text).upper()
                labels.setdefault(key, self.line_of(match.start(1 if number is not None else 2)))
            labels.pop("0", None)
        return labels.get(name)
