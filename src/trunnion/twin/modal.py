"""What is in force while a block of a program runs: its text, its functions, its tool.

In:     a run and the texts of its files.
Out:    a ``BlockState`` for a row.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import PurePath
from typing import Final

import numpy as np

from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

#: G functions of the motion; an arc that turns about the positive side of its axis is G3.
_LINEAR, _RAPID, _CLOCKWISE, _COUNTER_CLOCKWISE = 1, 0, 2, 3

#: M functions of the coolant by the word that turns it on or off.
_COOLANT_M: Final = {"mist": 7, "flood": 8, "off": 9}

#: G words of work offsets that have one.
_OFFSET_G: Final = (*range(54, 60), *range(505, 600))


@dataclass(frozen=True, slots=True)
class BlockState:
    """What is in force while a row runs; lines count from 1, 0 before the first block.

    blocks       texts of the line before, of the line itself and of the line after it
    file         name of its file: of the program or of a subprogram
    number       N number, empty where the block has none
    g, m         numbers of the functions in force, as far as they have numbers
    tool         as the program calls it; empty before the first
    feed         programmed feed in its unit; 0 before the first
    rpm          programmed spindle speed, signed by its sense; 0 while it stands
    tcp, rapid   tool centre point control is on; the block is a rapid
    """

    blocks: tuple[str, str, str]
    file: str
    line: int
    number: str
    g: tuple[int, ...]
    m: tuple[int, ...]
    tool: str
    feed: float
    rpm: float
    tcp: bool
    rapid: bool


class Blocks:
    """The blocks of a run; ``texts`` are those of its files, in their order."""

    def __init__(self, run: Run, texts: Sequence[str]) -> None:
        self._run = run
        self._lines = [[line.rstrip("\r") for line in text.split("\n")] for text in texts]
        self._names = [PurePath(file).name for file in run.files]
        coolant = [event for event in run.events if event.kind == "coolant"]
        self._coolant_rows = np.array([event.before_row for event in coolant], np.int64)
        self._coolant = [_COOLANT_M.get(str(event.value), 0) for event in coolant]
        self._spindle_was_on = bool(len(run)) and bool((run.state.spindle.values != 0).any())
        self.at = lru_cache(maxsize=256)(self._at)

    def _at(self, row: int) -> BlockState:
        """What is in force while a row runs; -1: before the first."""
        run = self._run
        if row < 0 or not len(run):
            first = self._lines[0][0] if self._lines and self._lines[0] else ""
            return BlockState(("", "", first), self._names[0], 0, "", (), (), "", 0.0, 0.0, False, False)
        state = run.state
        file, line, number = int(state.file[row]), run.lines[row], run.block_numbers[row]
        feed, sense = float(state.feed[row]), int(state.spindle[row])
        return BlockState(
            blocks=self._texts(file, line),
            file=self._names[file],
            line=line,
            number=f"N{number}" if number >= 0 else "",
            g=self._g_functions(row),
            m=self._m_functions(row, sense),
            tool=run.tools[int(state.tool[row])],
            feed=0.0 if math.isnan(feed) else feed,
            rpm=float(state.rpm[row]) * sense,
            tcp=bool(state.tcp[row]),
            rapid=int(run.kind[row]) == Kind.RAPID,
        )

    def _texts(self, file: int, line: int) -> tuple[str, str, str]:
        lines = self._lines[file] if file < len(self._lines) else []
        before, this, after = (lines[k].strip() if 0 <= k < len(lines) else "" for k in (line - 2, line - 1, line))
        return before, this, after

    def _g_functions(self, row: int) -> tuple[int, ...]:
        """Motion, compensation, work offset, kind of feed: what the run holds by number; none in plain language."""
        run, state = self._run, self._run.state
        if ".heidenhain." in run.language:
            return ()
        motion = _RAPID if run.kind[row] == Kind.RAPID else _LINEAR
        if run.kind[row] == Kind.ARC:
            k = int(np.searchsorted(run.arcs.row, row))
            normal = run.arcs.normal[k]
            motion = _COUNTER_CLOCKWISE if normal[np.argmax(np.abs(normal))] > 0.0 else _CLOCKWISE
        compensation = {1: 41, -1: 42}.get(int(state.compensation[row]), 40)
        offset = int(state.work_offset[row])
        offsets = (offset,) if offset in _OFFSET_G else ()
        return (motion, compensation, *offsets, int(state.feed_mode[row]))

    def _m_functions(self, row: int, sense: int) -> tuple[int, ...]:
        spindle = {1: (3,), -1: (4,)}.get(sense, (5,) if self._spindle_was_on else ())
        k = int(np.searchsorted(self._coolant_rows, row, "right")) - 1
        return (*spindle, self._coolant[k]) if k >= 0 and self._coolant[k] else spindle
