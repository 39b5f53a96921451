"""What a simulation cannot know of its programs, and what it takes for granted."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import Final

import numpy as np

from trunnion.errors import Problem, Severity, merge_repeated
from trunnion.machines import Machine
from trunnion.machines.inverse import slide_positions
from trunnion.model.run import Run
from trunnion.model.stated_tips import StatedTips
from trunnion.model.toolpath import Kind
from trunnion.simulation.cutting.sweeps import sideways_exits, unknown_swivels
from trunnion.simulation.findings import file_of_row
from trunnion.simulation.simulator import CuttingModel
from trunnion.simulation.stock.deviation import Excess
from trunnion.simulation.stock.solids import StockShape
from trunnion.simulation.tool_deltas import SIZES, is_told_of_length
from trunnion.simulation.tools.profile import ToolShape, cutting_width
from trunnion.wording import counted, position

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
    for k, axis in enumerate(machine.axes):
        if axis.is_rotary or not axis.has_limits or not machine.is_placed(k):
            continue
        low, high = float(joints[:, k].min()), float(joints[:, k].max())
        beyond = max(axis.low - low, high - axis.high)
        if beyond > 0.0:
            what = (
                f"reaches {beyond:.3f} mm beyond the travel of {axis.name}: its corners need {low:.3f} to {high:.3f},"
                f" limits are {axis.low:g} and {axis.high:g}; rotary axes at zero"
            )
            yield Problem("stock", 0, what, "check its place and the workpiece zero", Severity.WARNING, code="SIM130")


def _foreign_length(run: Run, row: int, number: int, names: Sequence[str]) -> list[Problem]:
    """A tool that cuts with a length number which is not its own: an error where that is another tool's."""
    name = run.tools[int(run.tool[row])]
    if not name.isdecimal() or int(name) == number:
        return []
    file, line = file_of_row(run, row), int(run.line[row])
    if str(number) in names:
        return [
            Problem(
                file, line, f"tool {name} cuts with the length of tool {number}", "select its own length", code="SIM160"
            )
        ]
    what = f"tool {name} cuts with length number {number}, which is taken for its own length"
    return [Problem(file, line, what, severity=Severity.WARNING, code="SIM161")]


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
            told = f"TOOL DEF gives tool {name} the length {value:g} mm"
            if shape is None or not shape.length:
                yield Problem(
                    file, event.line, f"{told}, which is taken for its own", severity=Severity.WARNING, code="SIM161"
                )
            elif abs(shape.length - value) > _SAME:
                what = f"{told}, and from tip to gauge point it has {shape.length:g} mm: its tip is not on the path"
                yield Problem(file, event.line, what, "let both be the same", code="SIM163")
        elif shape is not None and run.state.compensation.column()[rows].any():
            wide = cutting_width(shape)
            if abs(0.5 * wide - value) > _SAME:
                what = f"TOOL DEF gives tool {name} the radius {value:g} mm for radius compensation"
                yield Problem(
                    file, event.line, f"{what}, and it has {0.5 * wide:g} mm", "let both be the same", code="SIM163"
                )


def _edges(run: Run) -> Iterator[Problem]:
    """Cutting edges (Sinumerik: D2) whose offsets nobody knows."""
    for edge in np.unique(run.edge[run.edge > 1]).tolist():
        row = int(np.flatnonzero(run.edge == edge)[0])
        what = f"works with edge D{edge}, whose length is taken for that of the tool"
        cure = "check that its offsets are those of the tip"
        yield Problem(file_of_row(run, row), int(run.line[row]), what, cure, Severity.WARNING, code="SIM161")


def _lengths(runs: Sequence[Run], shapes: Mapping[str, ToolShape]) -> list[Problem]:
    """Cuts without a tool length, or with that of another tool, in programs that select lengths."""
    found: list[Problem] = []
    names = [*shapes, *(name for run in runs for name in run.tools)]
    for run in runs:
        found += _defined_sizes(run, shapes)
        found += () if run.uses_length_numbers else _edges(run)
        rows = np.flatnonzero(run.kind != Kind.RAPID)
        edge, tool = run.edge[rows], run.tool[rows]
        unset = -1 if run.uses_length_numbers else 0
        # A tool that no program has called may be measured by hand, as long as no other one has a length.
        called = np.array([name not in ("", "0") for name in run.tools])[tool] | (edge > 0).any()
        without = (edge == unset) & called & ~run.machine_frame[rows]
        if without.any():
            row = int(rows[np.argmax(without)])
            what, cure = "cuts without a tool length: the spindle goes where the tip should", "select it before the cut"
            found.append(Problem(file_of_row(run, row), int(run.line[row]), what, cure, code="SIM160"))
        if run.uses_length_numbers:
            for number in np.unique(edge[edge > 0]).tolist():
                own = np.flatnonzero(edge == number)
                others = own[tool[own] != tool[own[0]]]
                if len(others):
                    row = int(rows[others[0]])
                    what = f"cuts with the length of tool {run.tools[int(tool[own[0]])]}, number {number}"
                    found.append(
                        Problem(file_of_row(run, row), int(run.line[row]), what, "select its own length", code="SIM160")
                    )
                else:
                    found += _foreign_length(run, int(rows[own[0]]), number, names)
    return found


def _unknown_ways(runs: Sequence[Run], stock: StockShape) -> list[Problem]:
    """Motions near the stock whose way is not known: across the tool axis to machine positions, and swivels."""
    across = "goes to a machine position across the tool axis, and the tool is no higher than the stock"
    first = (
        "retract along the tool axis first, or give the workpiece zero and the tool length, so that the way is known"
    )
    swivel = "turns rotary axes without TCP beside the stock, and nobody knows about which place"
    known = "retract to a machine position first, or give the workpiece zero and the tool length"
    found = []
    for run in runs:
        for rows, what, cure in (
            (sideways_exits(run, stock.low, stock.high), across, first),
            (unknown_swivels(run, stock.low, stock.high), swivel, known),
        ):
            found += [
                Problem(file_of_row(run, row), int(run.line[row]), what, cure, code="SIM144") for row in rows.tolist()
            ]
    return list(merge_repeated(found))


def _remarks(runs: Sequence[Run], shapes: dict[str, ToolShape]) -> list[Problem]:
    """What was taken for granted, and what is not simulated."""
    found = [
        Problem(f"tool {name}", 0, remark, severity=Severity.WARNING, code="SIM155")
        for name, shape in shapes.items()
        for remark in shape.remarks
    ]
    for run in runs:
        found += merge_repeated(
            Problem(each.file, each.line, each.text, severity=Severity.WARNING, code=each.code)
            for each in run.diagnostics
            if each.severity is Severity.WARNING and not is_told_of_length(run, each.line, each.text)
        )
        compensated = run.state.compensation.rows_with(1), run.state.compensation.rows_with(-1)
        rows = np.concatenate(compensated)
        if len(rows):
            row = int(rows.min())
            what = "radius compensation is on: the programmed path is taken for that of the tool's centre"
            cure = "compensation for wear is simulated as it should be; a programmed contour is not"
            found.append(
                Problem(file_of_row(run, row), int(run.line[row]), what, cure, Severity.WARNING, code="SIM147")
            )
        found += _unjudged(run)
        missing = "workpiece zero" if run.machine.workpiece_zero is None else "tool length of the run"
        is_placed = run.machine.workpiece_zero is not None and run.machine.tool_length is not None
        if not is_placed and bool(run.state.machine_frame.values.any()):
            what = f"machine positions are taken as retracts along the tool axis: the {missing} is not known"
            cure = "give the workpiece zero and the tool length"
            found.append(Problem(run.files[0], 0, what, cure, Severity.WARNING, code="SIM145"))
    return found


def _unjudged(run: Run) -> list[Problem]:
    """Motions with a coordinate that no block has stated: they are neither cut nor judged at an invented place."""
    tips, found = StatedTips.of(run), []
    if len(tips.lost_feeds):
        what = f"{counted(len(tips.lost_feeds), 'block')} at feed, from here on, where nobody knows where the tool is"
        cure = "give the workpiece zero and the tool length, or state X, Y and Z in workpiece coordinates before"
        row = int(tips.lost_feeds[0])
        found.append(
            Problem(file_of_row(run, row), int(run.line[row]), f"{what}: they are not cut", cure, code="SIM143")
        )
    if len(tips.unjudged) > len(tips.lost_feeds):
        row = int(np.setdiff1d(tips.unjudged, tips.lost_feeds)[0])
        count = len(tips.unjudged) - len(tips.lost_feeds)
        what = f"{counted(count, 'motion')} before all coordinates of the tool are stated, from here on: not judged"
        cure = "give the workpiece zero and the tool length"
        found.append(Problem(file_of_row(run, row), int(run.line[row]), what, cure, Severity.WARNING, code="SIM146"))
    return found


def part_remarks(model: CuttingModel, lacking: Excess | None, slack: float, *, is_later: bool = False) -> list[Problem]:
    """Errors where the part cannot come out of the stock: what of it is missing before a set-up cuts anything.

    lacking   of the part, within the box of the stock
    slack     how far the surface of the stock may have been moved, mm
    is_later  whether the stock is what an earlier set-up has left
    """
    if model.part is None:
        return []
    before = "this set-up cuts anything" if is_later else "anything is cut"
    cure = "check the size of the stock, and the zero of part and stock"
    beyond = max(float((model.stock.low - model.part.low).max()), float((model.part.high - model.stock.high).max()))
    if beyond > model.tolerance + slack:
        what = f"reaches {beyond:.3f} mm beyond the stock: it cannot come out, and what is outside is not compared"
        return [
            Problem("part", 0, what, "check the pose, and the zero of the part" if is_later else cure, code="SIM131")
        ]
    if lacking is not None and lacking.largest > model.limit + slack:
        what = f"is missing {lacking.largest:.3f} mm deep at {position(lacking.places[0].at)} before {before}"
        if is_later:
            cure = "check what the earlier set-ups took there, the pose, and the zero of the part"
        return [Problem("part", 0, what, cure, code="SIM132")]
    return []


def of_setup(remarks: Iterable[Problem], name: str) -> list[Problem]:
    """Remarks that name the set-up they are of; an empty name is that of the only one."""
    return [replace(each, what=f"{name}: {each.what}") if name else each for each in remarks]
