"""What is in force while a block of a program runs: its text, its functions, its tool.

In:     a run in time and the texts of its files.
Out:    a ``BlockState`` for a row, or for an event between two rows.
"""

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import PurePath
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.model.toolpath import Kind
from trunnion.records import dataclass
from trunnion.timing import TimedRun
from trunnion.twin.switches import SWITCHES, switched

#: G functions of the motion; an arc that turns about the positive side of its axis is G3.
_LINEAR, _RAPID, _CLOCKWISE, _COUNTER_CLOCKWISE = 1, 0, 2, 3

#: M functions of the coolant by the word that turns it on or off.
_COOLANT_M: Final = {"mist": 7, "flood": 8, "off": 9}

#: Kinds of feed by their G words.
_PER_REVOLUTION, _INVERSE_TIME = 95, 93

#: Numbers of blocks in the texts of programs.
_NUMBER: Final = re.compile(r"\s*/?\d?\s*[Nn]\s*(\d+)")
_PLAIN_NUMBER: Final = re.compile(r"\s*(\d+)\b")

#: G words of work offsets that have one.
_OFFSET_G: Final = (*range(54, 60), *range(505, 600))


@dataclass(frozen=True, slots=True)
class BlockState:
    """What is in force while a row runs or an event happens; lines count from 1, 0 before the first block.

    blocks       texts of the line before, of the line itself and of the line after it
    file         name of its file: of the program or of a subprogram
    number       N number, empty where the block has none
    g, m         numbers of the functions in force, as far as they have numbers
    tool         as the program calls it; empty before the first
    feed         programmed speed along the path, mm/min (of the tip where F counts degrees); 0 before the first
    tcp          tool centre point control is on
    door, clamp  whether they are closed; None before the first word that operates them
    """

    blocks: tuple[str, str, str]
    file: str
    line: int
    number: str
    g: tuple[int, ...]
    m: tuple[int, ...]
    tool: str
    feed: float
    tcp: bool
    door: bool | None = None
    clamp: bool | None = None


class Blocks:
    """The blocks of a run in time; ``texts`` are those of its files, in their order."""

    def __init__(self, timed: TimedRun, texts: Sequence[str]) -> None:
        run = timed.run
        self._run, self._timed = run, timed
        self._lines = [[line.strip() for line in text.split("\n")] for text in texts]
        self._names = [PurePath(file).name for file in run.files]
        events = [each.event for each in timed.events]
        self._gap = np.array([min(event.before_row, len(run)) for event in events], np.int64)
        self._begins = np.array([each.seconds for each in timed.events])
        self._ends = self._begins + np.array([each.takes for each in timed.events])
        self._coolant = [0]
        for event in events:
            told = _COOLANT_M.get(str(event.value), 0) if event.kind == "coolant" else self._coolant[-1]
            self._coolant.append(told)
        self._switches = {name: switched(run.machine, name, events) for name in SWITCHES}
        self._spindle_was_on = bool(len(run)) and bool((run.state.spindle.values != 0).any())
        self._at = lru_cache(maxsize=256)(self._made)

    def at(self, seconds: Floats, row: Ints, is_end: Flags, told_rpm: Floats) -> tuple[BlockState, ...]:
        """Return what is in force at times (k,).

        row       (k,)  that runs, or was run last; -1: none
        is_end    (k,)  it ends there, and what comes after it has not begun
        told_rpm  (k,)  speed that the spindle has been told
        """
        found = []
        for now, here, ends, rpm in zip(
            seconds.tolist(), row.tolist(), is_end.tolist(), told_rpm.tolist(), strict=True
        ):
            first = passed = int(np.searchsorted(self._gap, here, "right"))
            while (
                not ends and passed < len(self._gap) and self._gap[passed] == here + 1 and self._begins[passed] <= now
            ):
                passed += 1
            changed = -1  # the last tool change that is over
            for k in range(first, passed):
                if self._timed.events[k].event.kind == "tool_change" and self._ends[k] <= now:
                    changed = k
            found.append(self._at(here, passed, passed > first, changed, int(np.sign(rpm))))
        return tuple(found)

    def before_start(self) -> BlockState:
        """Return what is in force before the program has been started."""
        return self._at(-1, 0, False, -1, 0)

    def _made(self, row: int, passed: int, is_event: bool, changed: int, sense: int) -> BlockState:
        """Return what is in force after ``passed`` events; the last of them is what happens if ``is_event``."""
        state = self._of_row(row)
        door, clamp = (self._switches[name][passed] for name in ("door", "clamp"))
        state = replace(state, m=self._m_functions(passed, sense), door=door, clamp=clamp)
        if changed >= 0:
            state = replace(state, tool=str(self._timed.events[changed].event.value or ""))
        if not is_event:
            return state
        event = self._timed.events[passed - 1].event
        texts = self._texts(event.file, event.line)
        return replace(
            state, blocks=texts, file=self._names[event.file], line=event.line, number=self._number_in(texts[1])
        )

    def _of_row(self, row: int) -> BlockState:
        """Return what is in force while a row runs; -1: before the first."""
        run = self._run
        if row < 0 or not len(run):
            first = self._lines[0][0] if self._lines and self._lines[0] else ""
            return BlockState(("", "", first), self._names[0], 0, "", (), (), "", 0.0, tcp=False)
        state = run.state
        file, line, number = int(state.file[row]), run.lines[row], run.block_numbers[row]
        return BlockState(
            blocks=self._texts(file, line),
            file=self._names[file],
            line=line,
            number=f"N{number}" if number >= 0 else "",
            g=self._g_functions(row),
            m=(),
            tool=run.tools[int(state.tool[row])],
            feed=self._feed(row),
            tcp=bool(state.tcp[row]),
        )

    def _feed(self, row: int) -> float:
        """Return the programmed speed along the path; of a rapid, that of its F word, if this says one by itself.

        Clients are told mm a minute: where F counts degrees, it is what the tip goes then.
        """
        rate, state = float(self._timed.rates[row]), self._run.state
        if math.isfinite(rate):
            return rate * float(self._timed.in_mm[row])
        feed, mode = float(state.feed[row]), int(state.feed_mode[row])
        if math.isnan(feed) or mode == _INVERSE_TIME:
            return 0.0
        return feed * float(state.rpm[row]) if mode == _PER_REVOLUTION else feed

    def _number_in(self, text: str) -> str:
        """Return the number of a block by its text."""
        found = (_PLAIN_NUMBER if ".heidenhain." in self._run.language else _NUMBER).match(text)
        return f"N{found.group(1)}" if found else ""

    def _texts(self, file: int, line: int) -> tuple[str, str, str]:
        lines = self._lines[file] if file < len(self._lines) else []
        before, this, after = (lines[k] if 0 <= k < len(lines) else "" for k in (line - 2, line - 1, line))
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

    def _m_functions(self, passed: int, sense: int) -> tuple[int, ...]:
        spindle = {1: (3,), -1: (4,)}.get(sense, (5,) if self._spindle_was_on else ())
        return (*spindle, self._coolant[passed]) if self._coolant[passed] else spindle
