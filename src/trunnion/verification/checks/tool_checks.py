"""The tools of a program against LOAD/TOOL in the CL files: which one, which cutting edge, which length."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.compensation.stretches import ADDED_RADII, RegisterValue
from trunnion.messages import Wording, phrase
from trunnion.model.columns import StepColumn
from trunnion.model.run import Run, RunEvent
from trunnion.model.tool_additions import LENGTHS, REPLACED
from trunnion.verification.checks.driven_path import cl_radius
from trunnion.verification.checks.lengths_at_part import numbers_changed_at_part
from trunnion.verification.checks.matched_rows import first_wrong_pair
from trunnion.verification.checks.unnumbered_tools import is_described, wrong_unnumbered_tools
from trunnion.verification.context import ComparedContext, check_from_places
from trunnion.verification.expected.spindle_and_tool import names_tool
from trunnion.verification.expected.states import tool_states
from trunnion.verification.results import Check, Place

#: Half the last digit of what a program adds to a tool, mm.
_DELTA: Final = 6e-5

#: Settings that add to a tool, by their words.
_DELTA_SETTINGS: Final = {"DL": "delta_length", "DR": "delta_radius"}


def check_tool(context: ComparedContext) -> Check:
    """Return the tool at every CL point with its edge and length, and no change to another tool."""
    run, matching = context.run, context.matching
    places: list[Place] = []
    asked: list[tuple[str, ...]] = []
    states = tool_states(context.expected)
    for state in states:
        names = state.value.names
        first, end = matching.pair_range(state.first, state.end)
        if not state.value.is_known or first == end:
            continue
        asked.append(names)
        bad = first_wrong_pair(matching, first, end, partial(_holds_other_tool, run, names))
        if bad is not None:
            places += _wrong_tool(context, *bad, names)
    places += _wrong_edges(context)
    if run.uses_length_numbers:
        places += _wrong_lengths(context)
    places += numbers_changed_at_part(context)
    known = [(hole.row, hole.tool_names) for hole in context.expected.holes if hole.tool_names]
    asked += dict.fromkeys(names for _, names in known)
    starts = (state.first for state in states if state.value.is_known)
    unnumbered = min((*starts, *(row for row, _ in known)), default=0)
    named = [state.value.names for state in states if not state.value.is_known]
    places += _foreign_changes(context, [*asked, *named], unnumbered) if asked else ()
    places += _foreign_deltas(context)
    places += wrong_unnumbered_tools(context, states)
    tools = tuple(Wording("tool", "named", tool=name) for name in dict.fromkeys(names[0] for names in asked))
    good = Wording("tool", "good", tools=tools)
    missing: tuple[Wording, ...] = ()
    if not tools:
        described = {each.operation.tool for each in context.expected.sections if is_described(each.operation.tool)}
        good = Wording("tool", "told_apart", count=len(described)) if described else Wording("tool", "none_asked")
        missing = (phrase("no_tool_called"),) if described and not any(run.tools) else ()
    found = check_from_places("tool", sorted(places, key=lambda p: p.nc_line), None if missing else good)
    return replace(found, missing=missing)


def _holds_other_tool(run: Run, names: tuple[str, ...], nc: Ints) -> Flags:
    wrong: Flags = np.array([not names_tool(text, names) for text in run.tools], np.bool_)
    return np.asarray(wrong[run.state.tool.at(nc)])


def _wrong_tool(context: ComparedContext, row: int, cl: int, names: tuple[str, ...]) -> Iterator[Place]:
    """Yield the row with a wrong tool, and the last word that called it."""
    run = context.run
    fault = tool_fault(run.tools[run.state.tool[row]], names)
    yield context.place_with_cl(row, 0.0, fault, cl)
    calls = [event for event in run.events if event.kind in ("tool", "tool_change") and event.before_row <= row]
    if calls:
        yield context.place_of_event(calls[-1], 0.0, Wording("tool", "last_call", fault=fault))


def _foreign_changes(context: ComparedContext, asked: list[tuple[str, ...]], unnumbered: int) -> Iterator[Place]:
    """Yield changes to a tool that the CL file never asks for, by number or by name.

    It gives its first ``unnumbered`` rows no number of a tool.
    """
    matching = context.matching
    for event in context.run.events:
        pair = matching.nc.count_before(event.before_row)
        if pair < len(matching.cl) and matching.cl[pair] < unnumbered:
            continue
        if event.kind == "tool_change":
            tool = str(event.value or "")
            if tool and tool != "0" and not any(names_tool(tool, names) for names in asked):
                yield context.place_of_event(event, 0.0, Wording("tool", "never_asked", tool=tool))


def _foreign_deltas(context: ComparedContext) -> Iterator[Place]:
    """Yield what the program adds to the length or the radius of a tool, unless the settings ask for it."""
    for event in context.run.events:
        if event.kind != "delta" or not isinstance(event.value, tuple):
            continue
        name, value = str(event.value[0]), float(event.value[1] or 0.0)
        asked = [*context.settings.tool_deltas.get(name, ()), *_radii_taken_off(context, event, name)]
        if value and not any(abs(value - wanted) <= _DELTA for wanted in asked):
            does = "replaces_length" if name in REPLACED else "adds_to_tool"
            said = Wording("tool", does, word=name, value=value)
            said = context.settings.repeated(said, _DELTA_SETTINGS.get(name, ""), f"{value:g}")
            yield context.place_of_event(event, value, said)


def _radii_taken_off(context: ComparedContext, event: RunEvent, name: str) -> Iterator[float]:
    """Yield what makes a difference of the radius in the tool table, as the centre line of a tool wants it."""
    if name in ADDED_RADII - LENGTHS and context.settings.register_holds is RegisterValue.RADIUS:
        radius = cl_radius(context, event.before_row)
        if radius is not None:
            yield -radius


def tool_fault(has: str, names: tuple[str, ...]) -> Wording:
    """Return what is wrong with the tool in the spindle, empty for none, where one of some names is expected."""
    wanted = names[0]
    return Wording("tool", "other_tool", has=has, wanted=wanted) if has else Wording("tool", "no_tool", wanted=wanted)


def _wrong_edges(context: ComparedContext) -> Iterator[Place]:
    """Yield the first motion under another cutting edge, and the first one home with an edge that is neither none nor
    it.
    """
    used, matching = context.run.state.edge, context.matching
    registers = {each.first: 0 if each.value.called else each.value.adjust for each in tool_states(context.expected)}
    known: list[int] = []
    for section in context.expected.sections:
        edge = setting = section.settings.edge
        if edge is None or setting is None:
            return
        if 0 < registers.get(section.first, 0) <= section.settings.last_edge:
            edge = registers[section.first]
        known += [edge, setting]  # before the first tool change that of the settings
        bad = first_wrong_pair(
            matching, *matching.pair_range(section.first, section.end), partial(_has_other_edge, used, edge)
        )
        if bad is not None:
            row, cl = bad
            has, said = int(used[row]), Wording("tool", "no_edge", wanted=edge)
            if has >= 0:
                said = Wording("tool", "other_edge", has=has, wanted=edge)
            yield context.place_with_cl(row, 0.0, _by_register(said, context, has, registers), cl)
    rows = context.run.state.machine_frame.rows_with(True)
    edges = used.at(rows)
    others = rows[(edges > 0) & ~np.isin(edges, known)]
    if len(others):
        row = int(others[0])
        said = Wording("tool", "edge_on_way_home", has=int(used[row]), wanted=known[0])
        yield context.place(row, 0.0, _by_register(said, context, int(used[row]), registers))


def _by_register(fault: Wording, context: ComparedContext, edge: int, registers: Mapping[int, int]) -> Wording:
    """Return a wrong edge with the setting that would explain it where it is the register of a tool."""
    is_register = edge > 0 and edge in registers.values()
    return context.settings.repeated(fault, "edge_from", "adjust") if is_register else fault


def _has_other_edge(used: StepColumn, edge: int, nc: Ints) -> Flags:
    return np.asarray(used.at(nc) != edge)


def _wrong_lengths(context: ComparedContext) -> Iterator[Place]:
    """Yield the first motion of each tool without its length: its own number, or the register of LOAD/TOOL."""
    run, matching = context.run, context.matching
    for state in tool_states(context.expected):
        numbers = state.value.lengths
        first, end = matching.pair_range(state.first, state.end)
        if not numbers or first == end:
            continue
        bad = first_wrong_pair(matching, first, end, partial(_has_other_length, run, numbers))
        if bad is not None:
            row, cl = bad
            yield context.place_with_cl(row, 0.0, length_fault(run.state.edge[row], numbers), cl)


def _has_other_length(run: Run, numbers: tuple[int, ...], nc: Ints) -> Flags:
    return ~np.isin(run.state.edge.at(nc), numbers)


def length_fault(number: int, allowed: tuple[int, ...]) -> Wording:
    """Return what is wrong with a length number, -1 for none, that is not allowed."""
    if number < 0:
        return Wording("tool", "no_length", wanted=allowed[0])
    return Wording("tool", "other_length", has=number, wanted=allowed[0])
