"""Operations to whose tool the CL files give no number: what they say of it tells it from the others.

A program calls such a tool as it likes. Two tools that the CL files describe differently must not be called alike, and
one that they call alike must not be two: that is how a tool change that is missing, or one too many, shows.
"""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.tool_faults import told_apart, tool_differences
from trunnion.model.toolpath import Tool
from trunnion.records import dataclass
from trunnion.verification.checks.matched_rows import first_wrong_pair
from trunnion.verification.context import ComparedContext
from trunnion.verification.expected.path import Section
from trunnion.verification.expected.spindle_and_tool import ExpectedTool, names_tool
from trunnion.verification.expected.states import StateRange
from trunnion.verification.matching.hole_matching import match_holes
from trunnion.verification.results import Place


@dataclass(frozen=True, slots=True)
class _Use:
    """How the program calls the tool of a stretch of an operation at its first row, with the CL row of that.

    names       what it must call it; empty: the CL files do not say
    first, end  pairs of the stretch; none where it has holes alone
    """

    call: str
    section: Section
    names: tuple[str, ...]
    row: int
    cl: int
    first: int = 0
    end: int = 0

    @property
    def tool(self) -> Tool:
        return self.section.operation.tool

    def is_called(self, call: str) -> bool:
        """Whether a program that calls this tool means the one of this use, or the tool that belongs there."""
        return bool(self.call and names_tool(call, (self.call,))) or names_tool(call, self.names)


def wrong_unnumbered_tools(context: ComparedContext, states: Sequence[StateRange[ExpectedTool]]) -> Iterator[Place]:
    """Yield the first motion of each operation under a tool that cannot be its own, where no number says which is."""
    uses = [use for number in range(len(context.expected.sections)) for use in _uses(context, states, number)]
    for k, use in enumerate(uses):
        if use.names or not is_described(use.tool):
            continue
        if use.call:
            fault = _fault(use, uses[:k]) or _is_another(use, [each for each in uses[k + 1 :] if each.names])
            found = None if fault is None else (use.row, use.cl, fault)
            found = found or _change_within(context, use)
            if found is not None:
                row, cl, said = found
                hint = f"{use.section.operation.name}:{context.run.tools[context.run.state.tool[row]]}"
                yield context.place_with_cl(row, 0.0, context.settings.repeated(said, "tool", hint), cl)
        elif any(context.run.tools):
            yield context.place_with_cl(use.row, 0.0, Wording("tool", "no_tool", wanted=_described(use.tool)), use.cl)


def is_described(tool: Tool) -> bool:
    """Whether a CL file says anything of a tool, its name or its form."""
    return bool(tool.name) or tool.kind != "UNKNOWN"


def _described(tool: Tool) -> str:
    return tool.name or f"{tool.kind} {tool.diameter:g}"


def _uses(context: ComparedContext, states: Sequence[StateRange[ExpectedTool]], number: int) -> Iterator[_Use]:
    """Yield the tools of a section, each from its first motion on; holes count where no other motion does."""
    run, expected, matching = context.run, context.expected, context.matching
    section = expected.sections[number]
    is_found = False
    for state in (each for each in states if section.first <= each.first < section.end):
        first, end = matching.pair_range(state.first, state.end)
        if first < end:
            is_found = True
            row, cl = int(matching.nc[first]), int(matching.cl[first])
            yield _Use(_called(run, row), section, _names(state.value), row, cl, first, end)
    begin, stop = (0, *expected.hole_ends)[number], expected.hole_ends[number]
    if is_found or begin == stop:
        return
    for match in match_holes(run, expected):
        if begin <= match.index < stop:
            hole = expected.holes[match.index]
            row = match.first + match.shares_first_row
            yield _Use(_called(run, row), section, hole.tool_names, row, min(hole.row, len(expected) - 1))
            return


def _called(run: Run, row: int) -> str:
    return str(run.tools[run.state.tool[row]])


def _names(tool: ExpectedTool) -> tuple[str, ...]:
    return tool.names if tool.is_known else ()


def _fault(use: _Use, before: Sequence[_Use]) -> Wording | None:
    """Return what is wrong with a tool, where some others were used before it."""
    if names_tool(use.call, (use.tool.name,)):
        return None
    fault = _is_another(use, before)
    if fault is not None:
        return fault
    for other in before:
        is_same = use.tool.name and use.tool.name == other.tool.name and not any(tool_differences(other.tool, use.tool))
        # What somebody has stated of another operation says nothing of this one, unless that goes on.
        if is_same and other.call and not other.is_called(use.call) and (other is before[-1] or not other.names):
            return Wording("tool", "same_by_two", has=use.call, called=other.call, other=other.section.operation.name)
    return None


def _is_another(use: _Use, others: Sequence[_Use]) -> Wording | None:
    """Return the fault that the program calls a tool as it calls another one of the CL files."""
    for other in others:
        differing = list(told_apart(other.tool, use.tool))
        is_its_name = bool(other.tool.name) and names_tool(use.call, (other.tool.name,))
        if differing and (is_its_name or other.is_called(use.call)):
            return Wording(
                "tool", "two_by_one", has=use.call, other=other.section.operation.name, differing=tuple(differing)
            )
    return None


def _change_within(context: ComparedContext, use: _Use) -> tuple[int, int, Wording] | None:
    """Return the first motion of a stretch that another tool makes than the one before, with its CL row."""
    run = context.run
    bad = first_wrong_pair(context.matching, use.first, use.end, partial(_is_made_by_another, run, use.call))
    if bad is None:
        return None
    said = Wording("tool", "changes_within", has=_called(run, bad[0]), called=use.call)
    return (*bad, said)


def _is_made_by_another(run: Run, call: str, nc: Ints) -> Flags:
    wrong: Flags = np.array([text != call for text in run.tools], np.bool_)
    return np.asarray(wrong[run.state.tool.at(nc)])
