"""What a verification is about: a run, what was wanted, and how to say where something is."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from trunnion.model.run import ProgrammedWord, Run, RunEvent
from trunnion.verification.expected.path import ExpectedPath
from trunnion.verification.matching.path_matching import Matching
from trunnion.verification.results import Check, Place

#: Places that are named one by one in each check.
MAX_PLACES = 8


@dataclass(frozen=True, slots=True)
class Settings:
    """What the CL file does not say, but whoever asked for the program does.

    tool         tool number or name in place of the one that LOAD/TOOL names; empty: as the CL file says
    work_offset  54..59, 505..599, or 600 more than the P of G54.1; None: one throughout, whichever
    edge         number of the cutting edge (D) under which the tool works; None: whichever
    span         degrees that the tool axis may be off between points; None: it is told, not judged
    span_tip     mm that the tip may be off its line between points without TCP; None: it is told, not judged
    absolute     the program's coordinate system is the CAM's absolute one, not that of the first operation
    top_rate     greatest F of inverse time that the control takes: no block is asked to be quicker; None: there is none
    top_feed     greatest F per minute that the control takes: no block is asked to be faster; None: there is none
    rapid_feed   mm/min at which lines stand for rapid motion; None: none do
    """

    tool: str = ""
    work_offset: int | None = None
    edge: int | None = None
    span: float | None = None
    span_tip: float | None = None
    absolute: bool = False
    rapid_feed: float | None = None
    max_inverse_time_feed: float | None = None
    max_feed: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Context:
    """One verification; ``expected`` and ``matching`` are None without a CL file."""

    run: Run
    expected: ExpectedPath | None
    matching: Matching | None
    settings: Settings

    def place(self, row: int, value: float, text: str, cl: int | None = None) -> Place:
        """A place by its row of the run, and of the CL files if there is one."""
        run = self.run
        file = run.state.file[row]
        if file:
            text = f"{Path(run.files[file]).name}: {text}"
        line, number = run.lines[row], run.block_numbers[row]
        if cl is None or self.expected is None:
            return Place(line, number, value, text)
        return Place(line, number, value, text, self.expected.section_at(cl).file, self.expected.point(cl).line)

    def place_at_cl(self, cl: int, value: float, text: str) -> Place:
        """A place by its row of the CL files, at the motion that answers to it."""
        assert self.matching is not None
        if cl not in self.matching.cl:
            return replace(self.place_of_missing(cl, text), value=value)
        return self.place(self.matching.nc[self.matching.cl.before(cl)], value, text, cl)

    def place_of_missing(self, cl: int, text: str) -> Place:
        """A place by its row of the CL files, where no motion answers to it: the block before which it should stand."""
        assert self.matching is not None
        k = self.matching.cl.before(cl)
        ends = [event for event in self.run.events if event.kind == "end"]
        if not len(self.matching.nc) and ends:
            # The program ends before the first of them.
            end = self.at(ends[0], 0.0, text)
            assert self.expected is not None
            return replace(end, cl_file=self.expected.section_at(cl).file, cl_line=self.expected.point(cl).line)
        if not len(self.run):
            return Place(0, -1, 0.0, text)
        row = self.matching.nc[k] if k < len(self.matching.nc) else self.after(self.matching.nc[-1] if k else 0)
        return self.place(row, 0.0, text, cl)

    def after(self, row: int) -> int:
        """The row after a row, or the last one."""
        return min(row + 1, len(self.run) - 1)

    def at(self, event: RunEvent, value: float, text: str) -> Place:
        """A place by something that happened."""
        if event.file:
            text = f"{Path(self.run.files[event.file]).name}: {text}"
        return Place(event.line, -1, value, text)

    @property
    def last_line(self) -> int:
        """The last line of the program itself of which anything is known."""
        lines = [e.line for e in self.run.events if not e.file] + [c.line for c in self.run.comments if not c.file]
        return max(lines, default=0)

    def rotary_positioning_block(self, row: int) -> Place | None:
        """The block that put the rotary axes where they stand in a row, if it is another one that is no cut itself."""
        run = self.run
        bits = int(ProgrammedWord.FIRST | ProgrammedWord.SECOND | ProgrammedWord.VECTOR)
        written = np.flatnonzero((run.programmed[max(row - 64, 0) : row + 1] & bits) != 0)
        if not len(written):
            return None
        by = max(row - 64, 0) + int(written[-1])
        if by == row or self.matching is None or by in self.matching.nc:
            return None
        return self.place(by, 0.0, f"this is where the rotary axes were put for {self.block(row)}")

    def block(self, row: int) -> str:
        """How a programmer names a row's block: ``N120``, or its line where it has no number."""
        number = self.run.block_numbers[row]
        return f"N{number}" if number >= 0 else f"line {self.run.lines[row]}"


def check_from_places(key: str, title: str, places: Sequence[Place], good: str, count: int | None = None) -> Check:
    """A check that is passed when there is nothing to say: ``good`` says so, else the first place does."""
    count = len(places) if count is None else count
    if not places:
        return Check(key, title, True, good)
    first = places[0]
    block = f"N{first.number}" if first.number >= 0 else f"line {first.nc_line}"
    more = f", and {count - 1} more" if count > 1 else ""
    return Check(key, title, False, f"{block}: {first.text}{more}", places=tuple(places[:MAX_PLACES]))
