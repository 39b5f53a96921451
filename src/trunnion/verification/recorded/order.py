"""Which row of a program each position of a recording belongs to, as far as the machine told the line that it ran.

In:     a ``Run`` and a ``Recording``.
Out:    ``ToldRows``.
"""

from collections.abc import Mapping
from pathlib import PurePath
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.model.recording import LINE, PROGRAM, Mark, Recording
from trunnion.model.run import Run
from trunnion.records import dataclass

#: The machine did not tell a line; or the program does not run: one before its first block.
UNTOLD: Final = -1
BEFORE: Final = -2

#: Lines after the last one with a block that are still of the program.
_LAST_LINES: Final = 2

#: A program that runs once more goes from its last tenth to its first one, or to one of so many motions.
_BEGINNING: Final = 8
_TENTH: Final = 10


@dataclass(frozen=True, slots=True, eq=False)
class ToldRows:
    """What the machine told of each of k positions.

    row      (k,)  row of the run; ``UNTOLD`` or ``BEFORE``
    foreign  (k,)  it ran another program
    strange  (k,)  it told a line that the program does not have
    name     what the machine calls the program, if that is none of the names of its files
    """

    row: Ints
    foreign: Flags
    strange: Flags
    name: str = ""

    def goes_back(self, n: int, gaps: Flags) -> Ints:
        """Positions at which the machine is in an earlier row of n than before, and does not run it once more.

        Nobody knows whether it did in ``gaps`` (k,), the positions before which the connection was broken.
        """
        at = np.flatnonzero(self.row >= 0)
        rows = self.row[at]
        falls = np.flatnonzero(np.diff(rows) < 0)
        stopped = np.concatenate(([0], np.cumsum(self.row == BEFORE)))
        ended = (rows[falls] >= n - 1 - n // _TENTH) | (stopped[at[falls + 1]] > stopped[at[falls]])
        again = ended & (rows[falls + 1] <= max(_BEGINNING, n // _TENTH))
        broken = np.cumsum(gaps)[at]
        return np.asarray(at[falls + 1][~again & (broken[falls + 1] == broken[falls])])


def told_rows(run: Run, recording: Recording) -> ToldRows:
    """Find the rows that the machine told."""
    k = len(recording)
    row, foreign, strange = np.full(k, UNTOLD, np.int64), np.zeros(k, np.bool_), np.zeros(k, np.bool_)
    file, name = np.zeros(k, np.int64), ""
    if (programs := recording.texts.get(PROGRAM)) is not None:
        numbers = {_stem(path): number for number, path in reversed(list(enumerate(run.files)))}
        known = [numbers.get(_stem(each), -1) if each else 0 for each in programs.names]
        named = [each for each in programs.names if each]
        if named and not any(_stem(each) in numbers for each in named):
            name = named[-1]
        else:
            file = np.array(known, np.int64)[programs.codes]
            foreign = file < 0
    lines = recording.values.get(LINE)
    if lines is None or not (np.nan_to_num(lines) > 0.0).any() or not len(run):
        return ToldRows(row, foreign, strange, name)
    gaps = recording.marked(Mark.GAP)
    rows = _Rows(run)
    last = np.array([rows.last_line(each) for each in range(max(len(run.files), 1))])
    strange = np.isfinite(lines) & ~foreign & ((lines > last[np.maximum(file, 0)] + _LAST_LINES) | (lines < 0.0))
    for at in np.flatnonzero(np.isfinite(lines) & ~foreign & ~strange).tolist():
        row[at] = rows.row_of(int(file[at]), int(min(max(lines[at], 0.0), 2.0**31)), anew=bool(gaps[at]))
    return ToldRows(_without_pauses(row), foreign, strange, name)


def _without_pauses(row: Ints) -> Ints:
    """Rows told, without lines before the first block in the midst of a program that goes on where it was."""
    found = row.copy()
    told = np.flatnonzero(row >= 0)
    for one, two in zip(told[:-1].tolist(), told[1:].tolist(), strict=True):
        if two > one + 1 and row[two] >= row[one] > _BEGINNING:
            found[one + 1 : two] = UNTOLD
    return found


class _Rows:
    """The rows of lines; of a line that runs several times, the next time of it."""

    def __init__(self, run: Run) -> None:
        file, line = run.state.file.column().astype(np.int64), run.line.astype(np.int64)
        key = (file << 32) + line
        order = np.argsort(key, kind="stable")
        self._rows, self._keys = order, key[order]
        self._last = {0: 0}
        for number, at in [(e.file, e.line) for e in run.events] + [(c.file, c.line) for c in run.comments]:
            self._last[number] = max(self._last.get(number, 0), at)
        self._now = 0
        self._known: dict[tuple[int, int], Ints] = {}

    def last_line(self, file: int) -> int:
        """Return the last line of a file in which anything is."""
        at = int(np.searchsorted(self._keys, (file + 1) << 32))
        moves = int(self._keys[at - 1]) - (file << 32) if at and self._keys[at - 1] >> 32 == file else 0
        return max(moves, self._last.get(file, 0))

    def row_of(self, file: int, line: int, *, anew: bool) -> int:
        """Return the row of a line; of one without motion the row before it."""
        if line <= 0:
            self._now = 0
            return BEFORE
        rows = self._known.get((file, line))
        if rows is None:
            rows = self._known[file, line] = self._rows_of(file, line)
        if not len(rows):
            return BEFORE
        at = int(np.searchsorted(rows, self._now))
        self._now = int(rows[at]) if at < len(rows) else int(rows[0])
        return self._now

    def _rows_of(self, file: int, line: int) -> Ints:
        key = (file << 32) + line
        at = int(np.searchsorted(self._keys, key, "right"))
        if at == 0 or self._keys[at - 1] >> 32 != file:
            return np.zeros(0, np.int64)
        return np.asarray(self._rows[np.searchsorted(self._keys, self._keys[at - 1]) : at])


def _stem(name: str) -> str:
    """Return what files of a program have in common on computer and control: ``/_N_MPF_DIR/_N_HUB_MPF`` and
    ``hub.mpf``.
    """
    text = PurePath(name.replace("\\", "/")).name.casefold()
    for prefix, suffixes in _DECORATIONS.items():
        if text.startswith(prefix):
            text = text.removeprefix(prefix)
            for suffix in suffixes:
                text = text.removesuffix(suffix)
            return text
    return text.rpartition(".")[0] if text.endswith(_ENDINGS) else text


_DECORATIONS: Final[Mapping[str, tuple[str, ...]]] = {"_n_": ("_mpf", "_spf")}
_ENDINGS: Final = (".mpf", ".spf", ".h", ".nc", ".ngc", ".iso", ".i", ".txt", ".tap", ".cnc", ".eia", ".min")
