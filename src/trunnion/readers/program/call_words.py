"""What a text says of calls: which programs it calls, and whether it is a subprogram that only others call.

In:     the bytes of a program, and how programs of its family call and return.
Out:    names of what it calls; the word by which it looks like a subprogram, with its line. Nothing is run.
"""

import re
from pathlib import Path
from typing import Final

from trunnion.records import dataclass

#: Larger files are no subprograms, bytes.
_MOST_BYTES: Final = 2_000_000

_NO_NAME: Final = re.compile(r"[/\\:]")
_NUMBERED: Final = re.compile(r"O?0*([0-9]{1,8})")

#: M2 and M30, which end a program on all controls.
ENDS: Final = rb"(?<![A-Z0-9_])M[ \t]*0*(?:2|30)(?![0-9.=])"


def _pattern(text: bytes) -> re.Pattern[bytes]:
    return re.compile(text, re.IGNORECASE | re.MULTILINE)


@dataclass(frozen=True, slots=True)
class CallWords:
    """How programs of a family call others, and what only subprograms have.

    calls     regular expression of calls; its group is the name
    returns   of the word that ends or begins a subprogram
    programs  of the words that only a program has that runs by itself
    remarks   of comments
    bodies    of where subprograms begin and end (its group) within a file: what else it has counts; empty: all counts
    numbered  programs are called by their numbers; more digits than four say how often first
    """

    calls: bytes
    returns: bytes
    programs: bytes = ENDS
    remarks: bytes = rb";[^\n]*"
    bodies: bytes = b""
    numbered: bool = False

    def called(self, text: bytes) -> frozenset[str]:
        """Return the names of what a text calls, as ``name`` gives them."""
        found = (match[1].decode("latin-1") for match in _pattern(self.calls).finditer(self._plain(text)))
        names = {self.name(each) for each in found}
        if self.numbered:
            names |= {f"{int(each) % 10_000}" for each in names if each.isdigit()}
        return frozenset(names)

    def name(self, written: str) -> str:
        """Return a name of a call, or of a file without its ending, as calls are compared."""
        name = _NO_NAME.split(written.strip())[-1].upper()
        number = _NUMBERED.fullmatch(name) if self.numbered else None
        return number[1] if number is not None else name

    def subprogram_mark(self, text: bytes) -> tuple[str, int] | None:
        """Return the word by which a text looks like a subprogram alone, and its line; None: it runs by itself."""
        plain = self._plain(text)
        rest = self._outside(plain) if self.bodies else plain
        found = _pattern(self.returns).search(plain)
        if found is None or _pattern(self.programs).search(rest) is not None:
            return None
        return " ".join(found[0].decode("latin-1").upper().split()), plain.count(b"\n", 0, found.start()) + 1

    def mark_of(self, file: Path) -> tuple[str, int] | None:
        """Return the same of a file; None for one that is too large, or cannot be read."""
        try:
            return self.subprogram_mark(file.read_bytes()) if file.stat().st_size <= _MOST_BYTES else None
        except OSError:
            return None

    def _outside(self, plain: bytes) -> bytes:
        """Return what stands in no subprogram."""
        parts, at, inside = list[bytes](), 0, False
        for match in _pattern(self.bodies).finditer(plain):
            if match[1] is not None:
                at, inside = match.end(), False
            elif not inside:
                parts.append(plain[at : match.start()])
                inside = True
        return b"\n".join((*parts, b"" if inside else plain[at:]))

    def _plain(self, text: bytes) -> bytes:
        return _pattern(self.remarks).sub(b"", text)
