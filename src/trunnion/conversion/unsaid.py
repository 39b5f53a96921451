"""What a program needs and does not say, or may leave out: a toolpath, and what is made of it, would hide that.

In:     the run, the rows of its operations and its text.
Out:    the first cut without a work offset; a warning for cuts with the spindle at rest or without a tool, and for each
        stretch of blocks with ``/`` that hold what no OPSKIP can: tool changes, heads and ends, tool lengths, and moves
        of the machine.
"""

import re
from collections.abc import Collection, Iterator, Sequence

import numpy as np

from trunnion.arrays import Ints
from trunnion.conversion.program_text import ProgramText
from trunnion.conversion.unsupported import Warnings
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind

#: Events that the head of an operation says again, whether they may be skipped or not.
_OF_HEADS = frozenset({"spindle", "speed", "offset"})

#: Tips, mm, and tool axes within this are the same.
_SAME = 1e-6

#: Words that call a tool length before the first motion.
_LENGTH = re.compile(r"(?<![A-Z])[HD]\d")


def warn_of_missing_words(run: Run, operations: Sequence[Ints], warn: Warnings) -> None:
    """Warn of the first cut with the spindle at rest, of the first without a tool, and of a program without an end.

    operations   the rows (n,) of each operation
    """
    rows = np.concatenate([np.zeros(0, np.int64), *operations])
    cuts = rows[run.kind[rows] != Kind.RAPID]
    in_cycles = np.zeros(len(run), np.bool_)
    for hole in run.spindle_holes:  # what the spindle does there is told by their cycles
        in_cycles[hole.first : hole.end] = True
    cuts = cuts[~in_cycles[cuts]]
    _warn_at_first(run, cuts[run.spindle[cuts] == 0], "cuts_without_spindle", warn)
    if all(event.kind != "end" for event in run.events):
        warn(int(run.line[-1]), Wording("CNV154", "no_end"), int(run.file[-1]))
    empty = np.array([not name.strip("0") for name in run.tools])
    _warn_at_first(run, cuts[empty[run.tool[cuts]]], "cuts_without_tool", warn)


def cut_without_offset(run: Run, operations: Sequence[Ints]) -> tuple[str, int] | None:
    """Return file and line of the first cut while no work offset is selected, None if there is none.

    run         with lines at the feed of rapids as rapids
    operations  the rows (n,) of each operation: what turns only rotary axes before its first position is no cut
    """
    rows = np.concatenate([np.zeros(0, np.int64), *operations])
    cuts = rows[(run.work_offset[rows] == 0) & ~run.machine_frame[rows] & (run.kind[rows] != Kind.RAPID)]
    return (run.files[int(run.file[cuts[0]])], int(run.line[cuts[0]])) if len(cuts) else None


def warn_of_skipped_words(
    run: Run, operations: Sequence[Ints], text: ProgramText, template_lines: Collection[int], warn: Warnings
) -> None:
    """Warn of blocks with ``/`` that say what the new program does in any case.

    In a program with jumps or subprograms the signs are refused.

    operations      the rows (n,) of each operation
    text            that of the main file
    template_lines  lines of it that were written from templates
    """
    if len(run.files) > 1 or bool((np.diff(run.line) < 0).any()):
        return
    for first, end in _stretches(text):
        row, after = np.searchsorted(run.line, (first, end)).tolist()
        inside = [event for event in run.events if first <= event.line < end]
        begins = {int(rows[0]) for rows in operations if len(rows)}
        # What is said before the first motion of an operation is written in its head.
        in_head = any(event.kind in _OF_HEADS and event.before_row in begins for event in inside)
        has_tool = any(event.kind == "tool_change" for event in inside)
        found = {
            "skips_tool": has_tool,
            # A call without a motion counts from the motion behind it.
            "skips_length": _calls_length(run, row, after)
            or (
                (row == 0 or _calls_length(run, after, after + 1))
                and any(_LENGTH.search(line) for _, line in text.line_texts(first, end))
            ),
            "skips_head": not has_tool and (in_head or any(line in template_lines for line in range(first, end))),
            "skips_machine_move": bool(run.machine_frame[row:after].any()),
        }
        for variant, is_lost in found.items():
            if is_lost:
                warn(first, Wording("CNV153", variant))


def warn_of_other_meanings(run: Run, warn: Warnings) -> None:
    """Warn of blocks that do something else while blocks before them are skipped: a toolpath states positions in full.

    Programs with jumps or subprograms are refused anyway.
    """
    if len(run.files) > 1 or bool((np.diff(run.line) < 0).any()):
        return
    for skipped in run.skipped:
        other = skipped.run
        signs = (event for event in run.events if event.kind == "block_skip" and event.value in skipped.levels)
        gone = np.unique([event.line for event in signs])
        rows = np.flatnonzero(~np.isin(run.line, gone))
        if len(rows) != len(other) or (run.line[rows] != other.line).any():
            continue  # a cycle that is skipped takes others with it: its blocks are reported by themselves
        at_part = ~run.machine_frame[rows]
        differs = np.zeros(len(rows), np.bool_)
        for column in ("tip", "axis"):
            here, there = getattr(run, column)[rows], getattr(other, column)
            differs |= at_part & (np.abs(here - there).max(axis=1) > _SAME)
        differs |= (run.kind[rows] != other.kind) | ((run.kind[rows] != Kind.RAPID) & (run.feed[rows] != other.feed))
        for row in np.flatnonzero(differs)[:1].tolist():
            first = int(gone[gone < other.line[row]].max(initial=0))
            warn(int(other.line[row]), Wording("CNV155", "means_something_else", skipped=first))
            return


def _stretches(text: ProgramText) -> Iterator[tuple[int, int]]:
    """Yield the lines with block skip signs: the first of each stretch, and the one behind its last."""
    first = 0
    for line, on in text.skip_changes():
        if on:
            first = line
        elif first:
            yield first, line
            first = 0
    if first:
        yield first, text.line_count + 1


def _calls_length(run: Run, row: int, end: int) -> bool:
    """Whether a length is called from a row up to another; what holds from the first row on is no change of it."""
    columns = (run.state.edge, run.state.length_axis)
    return any(bool(((each.rows >= max(row, 1)) & (each.rows < end)).any()) for each in columns)


def _warn_at_first(run: Run, rows: Ints, variant: str, warn: Warnings) -> None:
    if len(rows):
        warn(int(run.line[rows[0]]), Wording("CNV154", variant), int(run.file[rows[0]]))
