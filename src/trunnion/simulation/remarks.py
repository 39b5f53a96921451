"""What a simulation cannot know of its programs, and what it takes for granted."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import Final

import numpy as np

from trunnion.arrays import distinct
from trunnion.errors import Problem, Severity, merge_repeated, warning
from trunnion.machines import Machine
from trunnion.machines.inverse import slide_positions
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.model.stated_tips import StatedTips
from trunnion.model.tool_additions import SIZES
from trunnion.model.toolpath import Kind
from trunnion.model.unknown_setups import offset_name, rows_elsewhere
from trunnion.simulation.cutting.sweeps import sideways_exits, unknown_swivels
from trunnion.simulation.findings import file_of_row
from trunnion.simulation.simulator import CuttingModel
from trunnion.simulation.stock.deviation import Excess
from trunnion.simulation.stock.solids import StockShape
from trunnion.simulation.tool_deltas import is_told_of_length
from trunnion.simulation.tools.profile import ToolShape, cutting_width
from trunnion.wording import position

#: Sizes that differ by less are the same, mm.
_SAME: Final = 1e-3


def simulation_remarks(model: CuttingModel, runs: Sequence[Run], shapes: dict[str, ToolShape]) -> list[Problem]:
    """Return all remarks: errors where a crash may be hidden, else warnings."""
    return [
        *_remarks(runs, shapes), *_unknown_ways(runs, model.stock), *_lengths(runs, shapes),
        *_out_of_travel(runs[0].machine, model.stock),
    ]  # fmt: skip


def _out_of_travel(machine: Machine, stock: StockShape) -> Iterator[Problem]:
    """Slides that cannot bring the tool's tip to all corners of the stock while the rotary axes stand at zero."""
    corners = np.array(list(product(*zip(stock.low, stock.high, strict=True))))
    joints = slide_positions(machine, corners, np.zeros((len(corners), 2)))
    for k, axis in machine.own_columns:
        if axis.is_rotary or not axis.has_limits or not machine.is_placed(k):
            continue
        low, high = float(joints[:, k].min()), float(joints[:, k].max())
        beyond = max(axis.low - low, high - axis.high)
        if beyond > 0.0:
            yield warning(
                "stock",
                0,
                Wording(
                    "SIM130",
                    "reaches_mm_beyond",
                    beyond=beyond,
                    axis=axis.name,
                    low=low,
                    high=high,
                    limit_low=axis.low,
                    limit_high=axis.high,
                ),
            )


def _foreign_length(run: Run, row: int, number: int, names: Sequence[str]) -> list[Problem]:
    """Return a tool that cuts with a length number which is not its own: an error where that is another tool's."""
    name = run.tools[int(run.tool[row])]
    if not name.isdecimal() or int(name) == number:
        return []
    file, line = file_of_row(run, row), int(run.line[row])
    if str(number) in names:
        return [Problem(file, line, Wording("SIM160", "tool_cuts_length", name=name, number=number))]
    return [warning(file, line, Wording("SIM161", "tool_cuts_length", name=name, number=number))]


def _defined_sizes(run: Run, shapes: Mapping[str, ToolShape]) -> Iterator[Problem]:
    """Sizes that a program gives its tools (TOOL DEF): errors where the tools that cut have others."""
    for event in run.events:
        if event.kind != "delta" or not isinstance(event.value, tuple) or event.value[0] not in SIZES:
            continue
        kind, value, file = event.value[0], float(event.value[1] or 0.0), run.files[event.file]
        rows = np.flatnonzero(np.asarray(run.tool) == run.tool[min(event.before_row, len(run) - 1)])
        name = run.tools[int(run.tool[rows[0]])]
        shape = shapes.get(name)
        if kind == SIZES[0]:
            if shape is None or not shape.length:
                yield warning(file, event.line, Wording("SIM161", "tool_def_gives", name=name, value=value))
            elif abs(shape.length - value) > _SAME:
                yield Problem(
                    file, event.line, Wording("SIM163", "tool_def_gives", name=name, value=value, length=shape.length)
                )
        elif shape is not None and run.state.compensation.column()[rows].any():
            wide = cutting_width(shape)
            if abs(0.5 * wide - value) > _SAME:
                yield Problem(
                    file, event.line, Wording("SIM163", "tool_def_gives_tool", name=name, value=value, wide=0.5 * wide)
                )


def _edges(run: Run) -> Iterator[Problem]:
    """Cutting edges (Sinumerik: D2) whose offsets nobody knows."""
    for edge in distinct(run.edge[run.edge > 1]).tolist():
        row = int(np.flatnonzero(run.edge == edge)[0])
        yield warning(file_of_row(run, row), int(run.line[row]), Wording("SIM161", "works_edge_d", edge=edge))


def _lengths(runs: Sequence[Run], shapes: Mapping[str, ToolShape]) -> list[Problem]:
    """Cuts without a tool length, or with that of another tool, in programs that select lengths."""
    found: list[Problem] = []
    names = [*shapes, *(name for run in runs for name in run.tools)]
    for run in runs:
        found += _defined_sizes(run, shapes)
        found += () if run.uses_length_numbers else _edges(run)
        rows = np.flatnonzero(run.kind != Kind.RAPID)
        edge, tool = run.edge[rows], run.tool[rows]
        # A tool that no program has called may be measured by hand, as long as no other one has a length.
        called = np.array([name not in ("", "0") for name in run.tools])[tool] | (edge > 0).any()
        # 0 is no length: D0, and the number of a tool that is not known.
        without = ((edge <= 0) if run.uses_length_numbers else (edge == 0)) & called & ~run.machine_frame[rows]
        if without.any():
            row = int(rows[np.argmax(without)])
            found.append(Problem(file_of_row(run, row), int(run.line[row]), Wording("SIM160", "cuts_without_tool")))
        if run.uses_length_numbers:
            for number in distinct(edge[edge > 0]).tolist():
                own = np.flatnonzero(edge == number)
                others = own[tool[own] != tool[own[0]]]
                if len(others):
                    row = int(rows[others[0]])
                    found.append(
                        Problem(
                            file_of_row(run, row),
                            int(run.line[row]),
                            Wording("SIM160", "cuts_length_tool", tools=run.tools[int(tool[own[0]])], number=number),
                        )
                    )
                else:
                    found += _foreign_length(run, int(rows[own[0]]), number, names)
    return found


def _unknown_ways(runs: Sequence[Run], stock: StockShape) -> list[Problem]:
    """Motions near the stock whose way is not known: across the tool axis to machine positions, and swivels."""
    across, swivel = Wording("SIM144", "crosses_tool_axis"), Wording("SIM144", "swivels_beside_stock")
    found = []
    for run in runs:
        for rows, wording in (
            (sideways_exits(run, stock.low, stock.high), across),
            (unknown_swivels(run, stock.low, stock.high), swivel),
        ):
            found += [Problem(file_of_row(run, row), int(run.line[row]), wording) for row in rows.tolist()]
    return list(merge_repeated(found))


def _remarks(runs: Sequence[Run], shapes: dict[str, ToolShape]) -> list[Problem]:
    """Return what was taken for granted, and what is not simulated."""
    found = [warning(f"tool {name}", 0, remark) for name, shape in shapes.items() for remark in shape.remarks]
    for run in runs:
        found += merge_repeated(
            warning(each.file, each.line, each.wording)
            for each in run.diagnostics
            if each.severity is Severity.WARNING and not is_told_of_length(run, each.line, each.wording)
        )
        found += _unjudged(run)
        is_placed = run.machine.workpiece_zero is not None and run.machine.tool_length is not None
        if not is_placed and bool(run.state.machine_frame.values.any()):
            found.append(
                warning(
                    run.files[0],
                    0,
                    Wording("SIM145", "machine_positions_taken")
                    if run.machine.workpiece_zero is None
                    else Wording("SIM145", "machine_positions_taken_retracts"),
                )
            )
    return found


def _unjudged(run: Run) -> list[Problem]:
    """Motions with a coordinate that no block has stated: they are neither cut nor judged at an invented place."""
    tips, found = StatedTips.of(run, needs_gauge_point=True), []
    if len(tips.lost_feeds):
        row = int(tips.lost_feeds[0])
        found.append(
            Problem(
                file_of_row(run, row),
                int(run.line[row]),
                Wording("SIM143", "block_feed_from", count=len(tips.lost_feeds)),
            )
        )
    if len(tips.unjudged) > len(tips.lost_feeds):
        row = int(np.setdiff1d(tips.unjudged, tips.lost_feeds)[0])
        count = len(tips.unjudged) - len(tips.lost_feeds)
        wording = Wording("SIM146", "motion_before_all", count=count)
        if rows_elsewhere(run)[row]:
            offset = offset_name(run, int(run.work_offset[row]))
            wording = Wording("SIM146", "motion_elsewhere", count=count, offset=offset)
        found.append(warning(file_of_row(run, row), int(run.line[row]), wording))
    return found


def part_remarks(model: CuttingModel, lacking: Excess | None, slack: float, *, is_later: bool = False) -> list[Problem]:
    """Errors where the part cannot come out of the stock: what of it is missing before a set-up cuts anything.

    lacking   of the part, within the box of the stock
    slack     how far the surface of the stock may have been moved, mm
    is_later  whether the stock is what an earlier set-up has left
    """
    if model.part is None:
        return []
    beyond = max(float((model.stock.low - model.part.low).max()), float((model.part.high - model.stock.high).max()))
    if beyond > model.tolerance + slack:
        return [
            Problem(
                "part",
                0,
                Wording("SIM131", "reaches_mm_beyond", beyond=beyond)
                if is_later
                else Wording("SIM131", "reaches_mm_beyond_stock", beyond=beyond),
            )
        ]
    if lacking is not None and lacking.largest > model.limit + slack:
        variant = "missing_before_this_setup" if is_later else "missing_before_anything_is_cut"
        wording = Wording("SIM132", variant, depth=lacking.largest, position=position(lacking.places[0].at))
        return [Problem("part", 0, wording)]
    return []


def of_setup(remarks: Iterable[Problem], name: str) -> list[Problem]:
    """Remarks that name the set-up they are of; an empty name is that of the only one."""
    return [replace(each, wording=each.wording.within("of", name=name)) if name else each for each in remarks]
