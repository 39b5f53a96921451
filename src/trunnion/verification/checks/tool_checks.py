"""The tools of a program against LOAD/TOOL in the CL files: which one, which cutting edge, which length."""

from collections.abc import Iterator, Mapping
from functools import partial
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.compensation.stretches import ADDED_RADII, RegisterValue
from trunnion.model.columns import StepColumn
from trunnion.model.run import Run, RunEvent
from trunnion.model.tool_additions import LENGTHS, REPLACED
from trunnion.verification.checks.driven_path import cl_radius
from trunnion.verification.checks.matched_rows import first_wrong_pair
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
    unnumbered = next((state.first for state in states if state.value.is_known), 0)
    places += _foreign_changes(context, asked, unnumbered) if asked else ()
    places += _foreign_deltas(context)
    good = ", ".join(dict.fromkeys(f"tool {names[0]}" for names in asked)) or "the CL file names no tool"
    return check_from_places("tool", "tools as the CL file says", sorted(places, key=lambda p: p.nc_line), good)


def _holds_other_tool(run: Run, names: tuple[str, ...], nc: Ints) -> Flags:
    wrong: Flags = np.array([not names_tool(text, names) for text in run.tools], np.bool_)
    return np.asarray(wrong[run.state.tool.at(nc)])


def _wrong_tool(context: ComparedContext, row: int, cl: int, names: tuple[str, ...]) -> Iterator[Place]:
    """Yield the row with a wrong tool, and the last word that called it."""
    run = context.run
    text = tool_fault(run.tools[run.state.tool[row]], names)
    yield context.place_with_cl(row, 0.0, text, cl)
    calls = [event for event in run.events if event.kind in ("tool", "tool_change") and event.before_row <= row]
    if calls:
        yield context.place_of_event(calls[-1], 0.0, f"{text}: this is the last block that calls a tool")


def _foreign_changes(context: ComparedContext, asked: list[tuple[str, ...]], unnumbered: int) -> Iterator[Place]:
    """Yield changes to a tool that the CL file never asks for; it gives its first ``unnumbered`` rows no number of a
    tool.
    """
    matching = context.matching
    for event in context.run.events:
        pair = matching.nc.count_before(event.before_row)
        if pair < len(matching.cl) and matching.cl[pair] < unnumbered:
            continue
        if event.kind == "tool_change":
            tool = str(event.value or "")
            if tool and tool != "0" and not any(names_tool(tool, names) for names in asked):
                text = f"changes to tool {tool}, which the CL file never asks for"
                yield context.place_of_event(event, 0.0, text)


def _foreign_deltas(context: ComparedContext) -> Iterator[Place]:
    """Yield what the program adds to the length or the radius of a tool, unless the settings ask for it."""
    for event in context.run.events:
        if event.kind != "delta" or not isinstance(event.value, tuple):
            continue
        name, value = str(event.value[0]), float(event.value[1] or 0.0)
        asked = [*context.settings.tool_deltas.get(name, ()), *_radii_taken_off(context, event, name)]
        if value and not any(abs(value - wanted) <= _DELTA for wanted in asked):
            does = "puts {:g} mm in the place of the tool's length" if name in REPLACED else "adds {:g} mm to the tool"
            repeat = context.settings.repeat(_DELTA_SETTINGS.get(name, ""), f"{value:g}")
            text = f"{name} {does.format(value)}, which nothing asks for{repeat}"
            yield context.place_of_event(event, value, text)


def _radii_taken_off(context: ComparedContext, event: RunEvent, name: str) -> Iterator[float]:
    """Yield what makes a difference of the radius in the tool table, as the centre line of a tool wants it."""
    if name in ADDED_RADII - LENGTHS and context.settings.register_holds is RegisterValue.RADIUS:
        radius = cl_radius(context, event.before_row)
        if radius is not None:
            yield -radius


def tool_fault(has: str, names: tuple[str, ...]) -> str:
    """Return what is wrong with the tool in the spindle, empty for none, where one of some names is expected."""
    return f"{f'tool {has}' if has else 'no tool'} is in the spindle; the CL file wants {names[0]}"


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
            has = f"with D{used[row]}" if used[row] >= 0 else "without a D word"
            text = f"works {has}, not with D{edge}{_by_register(context, int(used[row]), registers)}"
            yield context.place_with_cl(row, 0.0, text, cl)
    rows = context.run.state.machine_frame.rows_with(True)
    edges = used.at(rows)
    others = rows[(edges > 0) & ~np.isin(edges, known)]
    if len(others):
        row = int(others[0])
        repeat = _by_register(context, int(used[row]), registers)
        yield context.place(row, 0.0, f"D{used[row]} is not the edge of this tool, D{known[0]}{repeat}")


def _by_register(context: ComparedContext, edge: int, registers: Mapping[int, int]) -> str:
    """Return the setting to tell again where a wrong edge is the register of a tool; empty elsewhere."""
    return context.settings.repeat("edge_from", "adjust") if edge > 0 and edge in registers.values() else ""


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


def length_fault(number: int, allowed: tuple[int, ...]) -> str:
    """Return what is wrong with a length number, -1 for none, that is not allowed."""
    has = "without a tool length" if number < 0 else f"with the length of H{number}"
    return f"works {has}; the CL file wants H{allowed[0]}"
