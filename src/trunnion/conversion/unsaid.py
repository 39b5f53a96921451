"""What a program needs and does not say, or may leave out: a toolpath, and what is made of it, would hide that.

In:     the run, the rows of its operations and its text.
Out:    a warning for cuts with the spindle at rest or without a tool, and for each stretch of blocks with ``/`` that
        hold what no OPSKIP can: tool changes, heads and ends, tool lengths, and moves of the machine.
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

#: Words that call a tool length before the first motion.
_LENGTH = re.compile(r"(?<![A-Z])[HD]\d")


def warn_of_missing_words(run: Run, operations: Sequence[Ints], warn: Warnings) -> None:
    """Warn of the first cut with the spindle at rest, and of the first without a tool.

    operations   the rows (n,) of each operation
    """
    rows = np.concatenate([np.zeros(0, np.int64), *operations])
    cuts = rows[run.kind[rows] != Kind.RAPID]
    in_cycles = np.zeros(len(run), np.bool_)
    for hole in run.spindle_holes:  # what the spindle does there is told by their cycles
        in_cycles[hole.first : hole.end] = True
    cuts = cuts[~in_cycles[cuts]]
    kinds = {event.kind for event in run.events}
    if kinds & {"speed", "spindle"}:
        _warn_at_first(run, cuts[run.spindle[cuts] == 0], "cuts_without_spindle", warn)
    if kinds & {"tool", "tool_change"}:
        empty = np.array([not name.strip("0") for name in run.tools])
        _warn_at_first(run, cuts[empty[run.tool[cuts]]], "cuts_without_tool", warn)


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
            "skips_length": _calls_length(run, row, after)
            or (row == 0 and any(_LENGTH.search(line) for _, line in text.line_texts(first, end))),
            "skips_head": not has_tool and (in_head or any(line in template_lines for line in range(first, end))),
            "skips_machine_move": bool(run.machine_frame[row:after].any()),
        }
        for variant, is_lost in found.items():
            if is_lost:
                warn(first, Wording("CNV153", variant))


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
