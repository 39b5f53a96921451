"""Targets of the O words in a LinuxCNC program: subprograms, branches and loops."""

import re
from dataclasses import field
from pathlib import Path
from typing import Final

from trunnion.messages import Wording
from trunnion.readers.program.source_text import SourceText
from trunnion.records import dataclass

#: Endings of program names.
SUFFIXES: Final = (".NGC", ".NC", "")

#: How deep control structures may nest.
MAX_NESTING: Final = 64

_O_WORD = re.compile(
    rb"^[ \t]*(?:(/)[ \t]*)?(?:N[ \t]*[0-9]+[ \t]*)?O[ \t]*(<[^<>\n]{1,100}>|[0-9]{1,9})[ \t]*"
    rb"(SUB|ENDSUB|IF|ELSEIF|ELSE|ENDIF|WHILE|ENDWHILE|DO|REPEAT|ENDREPEAT|BREAK|CONTINUE)(?![A-Z0-9_])",
    re.IGNORECASE | re.MULTILINE,
)

_LOOPS: Final = ("WHILE", "DO", "REPEAT")


@dataclass(slots=True)
class Structure:
    """The lines of a subprogram, branch or loop.

    word         keyword that begins it
    begin, end   first and last line
    branches     lines of ELSEIF and ELSE, and of the end
    skipped      a slash stands before the first line
    """

    word: str
    begin: int
    skipped: bool
    end: int = 0
    branches: list[int] = field(default_factory=list)


@dataclass(slots=True)
class _JumpTargets:
    """Subprograms by label, and structures by the lines of their keywords; found on first use."""

    found: tuple[dict[str, Structure], dict[int, Structure]] | None = None


def label_of(text: str) -> str:
    """Return a label in normal form: a number without leading zeros, or a name in capitals without blanks."""
    plain = "".join(text.split()).upper()
    return plain if plain.startswith("<") else str(int(plain))


class LinuxcncText(SourceText):
    """A program file with the targets of its O words."""

    def __init__(self, path: Path, *, whole: bool = False, encoding: str = "") -> None:
        # Shared by the copies that ``restarted`` makes.
        self._jump_targets = _JumpTargets()
        super().__init__(path, whole=whole, encoding=encoding)

    def subprogram(self, label: str) -> Structure | None:
        """Return a subprogram of this file, or None."""
        return self._structures()[0].get(label)

    def next_o_word(self, line: int) -> int | None:
        """Return the first line from one on that has an O word; None if there is none."""
        match = self.search(_O_WORD, line)
        return None if match is None else self.line_of(match.start(2))

    def structure(self, line: int) -> Structure:
        """Return the structure that the O word of a line belongs to."""
        try:
            return self._structures()[1][line]
        except KeyError:
            raise self.problem(line, Wording("NC142", "stray_o_word")) from None

    def _structures(self) -> tuple[dict[str, Structure], dict[int, Structure]]:
        if self._jump_targets.found is None:
            self._jump_targets.found = self._match()
        return self._jump_targets.found

    def _match(self) -> tuple[dict[str, Structure], dict[int, Structure]]:
        subprograms: dict[str, Structure] = {}
        by_line: dict[int, Structure] = {}
        open_: list[tuple[str, Structure]] = []
        for match in _O_WORD.finditer(self.whole_bytes()):
            label, skipped = label_of(match.group(2).decode("latin-1")), match.group(1) is not None
            word = match.group(3).decode().upper()
            line = self.line_of(match.start(2))
            top = open_[-1] if open_ and open_[-1][0] == label else None
            if word in ("BREAK", "CONTINUE"):
                inside = [kept for name, kept in open_ if name == label and kept.word in _LOOPS]
                if not inside:
                    raise self.problem(line, Wording("NC142", "outside_loop", word=word))
                by_line[line] = inside[-1]
            elif word in ("ELSEIF", "ELSE"):
                if top is None or top[1].word != "IF":
                    raise self.problem(line, Wording("NC142", "without_if", word=word))
                self._check_skip(top[1], word, line, skipped=skipped)
                top[1].branches.append(line)
                by_line[line] = top[1]
            elif word.startswith("END") or (word == "WHILE" and top is not None and top[1].word == "DO"):
                opening = word.removeprefix("END") if word.startswith("END") else "DO"
                if top is None or top[1].word != opening:
                    raise self.problem(line, Wording("NC142", "without_beginning", word=word))
                structure = open_.pop()[1]
                self._check_skip(structure, word, line, skipped=skipped)
                structure.end = line
                structure.branches.append(line)
                by_line[line] = structure
            else:
                structure = Structure(word, line, skipped)
                if word == "SUB" and (other := subprograms.setdefault(label, structure)) is not structure:
                    raise self.problem(line, Wording("NC163", "doubled_subprogram", label=label[:60], line=other.begin))
                by_line[line] = structure
                open_.append((label, structure))
                if len(open_) > MAX_NESTING:
                    raise self.problem(line, Wording("NC141", "structures_too_deep", most=MAX_NESTING))
        if open_:
            structure = open_[-1][1]
            raise self.problem(structure.begin, Wording("NC142", "never_ends", word=structure.word))
        return subprograms, by_line

    def _check_skip(self, structure: Structure, word: str, line: int, *, skipped: bool) -> None:
        """Refuse a part of a structure that block skip takes out without its beginning, or the other way round."""
        if skipped is not structure.skipped:
            raise self.problem(line, Wording("NC142", "skip_of_part", word=word, beginning=structure.word))
