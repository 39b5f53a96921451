"""What a page shows: the machine and what is on it, the program's text, and its motion as columns.

In:     a ``Verification``, the bodies of tools, meshes around the part.
Out:    ``ViewContent``: one record of names and numbers, columns by name, texts by name.
Units:  mm, degrees, seconds, mm/min.
"""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trunnion.machines import Machine
from trunnion.machines.links import link_chain
from trunnion.messages import LIBRARY, Words
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind, Toolpath
from trunnion.records import dataclass
from trunnion.simulation.collisions.bodies import Body, BodyKind, machine_bodies, tool_bodies
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.text import parse_tool
from trunnion.verification import stand_lines
from trunnion.verification.comparison import Alignment
from trunnion.verification.driven_rows import DrivenRows
from trunnion.verification.results import Check, Verification, durations
from trunnion.viewer.motion import motion_columns
from trunnion.viewer.shown import Mark, said
from trunnion.viewer.stock import StockView

Column = NDArray[np.float32] | NDArray[np.int32]

#: Of a check, so many places are shown at most.
_MOST_PLACES: Final = 50

#: A rotary axis that turns further in one rapid rewinds, degrees.
_REWIND: Final = 180.0

#: Names by which programs empty the spindle.
_NO_TOOL: Final = ("", "0")

#: A tool whose form nothing states is drawn as a needle of this diameter and length, mm.
_NEEDLE: Final = (1.0, 60.0)

_COLOURS: Final = {
    BodyKind.CUTTER: "#d9a441", BodyKind.SHANK: "#8f979e", BodyKind.HOLDER: "#5c6670", BodyKind.FIXTURE: "#7b8f6a",
    BodyKind.PART: "#6f94b8",
}  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class ViewContent:
    """What a page shows.

    scene    names and numbers, as JSON has them, and what is said as ``shown.said`` takes it
    columns  by name, (k,) float32 or int32
    texts    UTF-8, of the program and its subprograms in the order of ``scene["files"]``, then of its CL files in that
             of ``scene["clFiles"]``
    rows     the rows that it shows of the program
    stock    as it is cut, where that was simulated
    """

    scene: Mapping[str, Any]
    columns: Mapping[str, Column]
    texts: tuple[bytes, ...]
    rows: DrivenRows
    stock: StockView | None = None

    def said(self, words: Words = LIBRARY) -> dict[str, Any]:
        """Return the scene as JSON has it, in the words of who looks."""
        found: dict[str, Any] = said(self.scene, words)
        return found


def view_content(
    verification: Verification,
    texts: Sequence[str],
    cl_texts: Mapping[str, str],
    tools: Mapping[str, ToolShape],
    clamped: Sequence[Body] = (),
    rows: DrivenRows | None = None,
) -> ViewContent:
    """Put together what a page shows.

    verification    of the program; with its columns, motions take their times
    texts           of the files of its run, in their order
    cl_texts        of its CL files, by the names that its operations have for them
    tools           bodies of tools by their names in the program; others are drawn as needles
    clamped         part and fixtures
    rows            that are shown of it: those of the tool's centre; None: those of its blocks

    Raises ``InputError`` if a mesh of the machine cannot be used.
    """
    machine = verification.machine
    rows = rows or DrivenRows(verification.run, np.arange(len(verification.run)))
    run = rows.run
    cl_files = {name: k for k, name in enumerate(cl_texts)}
    seconds = rows.seconds(durations(verification)[0] if len(verification.seconds) else np.zeros(0))
    lengths = {k: _length(tools.get(name), run.length_of(name)) for k, name in enumerate(run.tools)}
    motion = motion_columns(run, seconds, lengths)
    bodies = [*machine_bodies(machine), *clamped]
    for k, name in enumerate(run.tools):
        shape = tools.get(name)
        bodies += _needle(machine, name, lengths[k]) if shape is None else tool_bodies(shape, machine, name, lengths[k])
    columns: dict[str, Column] = {
        "row": motion.row.astype(np.int32),
        "seconds": motion.seconds.astype(np.float32),
        "known": motion.known.astype(np.int32),
        "line": run.lines.column(np.int32),
        "file": run.file.astype(np.int32),
        "kind": run.kind.astype(np.int32),
        "tool": run.state.tool.column().astype(np.int32),
        "feed": rows.column(_tip_feeds(verification)),
        "cl": rows.column(verification.cl_line.astype(np.int32)),
    }
    for k in range(5):
        columns[f"axis-{k}"] = motion.joints[:, k].astype(np.uint32).view(np.int32)
    for k, body in enumerate(bodies):
        columns[f"vertices-{k}"] = body.mesh.vertices.astype(np.float32).ravel()
        columns[f"faces-{k}"] = body.mesh.faces.astype(np.int32).ravel()
    scene = {
        "title": verification.program,
        "machine": machine_scene(machine),
        "bodies": [body_scene(body, machine) for body in bodies],
        "tools": [
            {"name": name, "length": lengths[k], "known": name in tools or name in _NO_TOOL}
            for k, name in enumerate(run.tools)
        ],
        "files": list(run.files),
        "clFiles": list(cl_texts),
        "clText": len(texts),
        "operations": [
            {"name": one.name, "first": one.first, "end": one.end, "cl": cl_files.get(one.cl_file, -1)}
            for one in rows.operations(verification.operations)
        ],
        "events": [*_events(run), *_rewinds(run)],
        "findings": [*_findings(verification.checks, rows), *_diagnostics(run)],
        "timed": bool(len(seconds)),
        "remarks": [],
        **proof_scene(verification),
    }
    return ViewContent(scene, columns, tuple(text.encode() for text in (*texts, *cl_texts.values())), rows)


def with_phases(content: ViewContent, verification: Verification, toolpaths: Sequence[Toolpath]) -> ViewContent:
    """Return what a page shows, with the phases of motions as the toolpaths know them that they come from."""
    if not toolpaths:
        return content
    phase = content.rows.column(_phases(verification, toolpaths))
    return replace(content, columns={**content.columns, "phase": phase})


def proof_scene(verification: Verification) -> dict[str, Any]:
    """Return what the page says of the proof."""
    standing = verification.standing
    return {
        "checks": verification.checks, "standing": standing.line, "verdict": str(standing.verdict),
        "stands": partial(_stands, verification.checks),
    }  # fmt: skip


def _stands(checks: Sequence[Check], words: Words) -> list[str]:
    return list(stand_lines(checks, words))


def side_by_side(first: ViewContent, second: ViewContent, alignment: Alignment) -> ViewContent:
    """Put a second program beside the first, where both go along the same tool path.

    first, second  what a page would show of each alone; the stock is that of the first
    alignment      of their runs. Columns of the second begin with ``b-``; ``pair-one`` and ``pair-two`` are rows that
                   go together
    """
    differences = [
        Mark("difference", row, *_place(first, row), each.wording)
        for each in alignment.differences
        for row in (first.rows.row(each.one),)
    ]
    one, two = (each.rows.row_of[alignment.pairs[:, k]] for k, each in enumerate((first, second)))
    columns = {f"b-{name}": column for name, column in second.columns.items()}
    columns |= {"pair-one": one.astype(np.int32), "pair-two": two.astype(np.int32)}
    against = {
        **second.scene,
        "firstText": len(first.texts),
        "differing": [second.rows.row(each.two) for each in alignment.differences],
        "pairs": len(alignment.pairs),
    }
    scene = {
        **first.scene,
        "title": " | ".join(f"{each.scene['title']} ({each.scene['machine']['key']})" for each in (first, second)),
        "findings": [*first.scene["findings"], *differences],
        "against": against,
    }
    return replace(first, scene=scene, columns={**first.columns, **columns}, texts=(*first.texts, *second.texts))


def _place(content: ViewContent, row: int) -> tuple[int, int]:
    """Line and file of a row."""
    line, file = (content.columns[name] for name in ("line", "file"))
    return (int(line[row]), int(file[row])) if len(line) else (0, 0)


def _phases(verification: Verification, toolpaths: Sequence[Toolpath]) -> NDArray[np.int32]:
    """Return the ``Phase`` of each row, (n,), as the CL line has it that the row belongs to; -1 for none."""
    found = np.full(len(verification.run), -1, np.int32)
    if not len(verification.cl_line):
        return found
    for toolpath in toolpaths:
        line = np.concatenate([operation.moves.line for operation in toolpath.operations])
        phase = np.concatenate([operation.moves.phase.astype(np.int32) for operation in toolpath.operations])
        order = np.argsort(line, kind="stable")
        line, phase = line[order], phase[order]
        for rows in (slice(one.first, one.end) for one in verification.operations if one.cl_file == toolpath.file):
            wanted = verification.cl_line[rows]
            at = np.minimum(np.searchsorted(line, wanted), len(line) - 1)
            found[rows] = np.where(line[at] == wanted, phase[at], -1)
    return found


def _tip_feeds(verification: Verification) -> NDArray[np.float32]:
    """Speed of the tip, (n,), mm/min; -1 where it is not known."""
    feed = verification.tip_feed if len(verification.tip_feed) else np.full(len(verification.run), np.nan)
    return np.nan_to_num(feed, nan=-1.0, posinf=-1.0).astype(np.float32)


def _length(shape: ToolShape | None, stated: float | None) -> float:
    """From tip to gauge point, mm: that of the definition or the command, else of the tool; 0 if nothing states it.

    What is only drawn counts for no length: tips and axis values are those of a control without one.
    """
    if stated is not None:
        return stated
    if shape is None or shape.is_drawn_only:
        return 0.0
    return shape.length or shape.top


def _needle(machine: Machine, name: str, length: float) -> Iterable[Body]:
    """Yield what stands for a tool of unknown form; nothing for no tool."""
    if name in _NO_TOOL:
        return
    diameter, length = _NEEDLE
    shape = parse_tool(f"1=flat:{diameter},length={length},flutes={length}", {})
    yield from tool_bodies(shape, machine, name, length)


def machine_scene(machine: Machine) -> dict[str, Any]:
    """Return the chain of a machine, mm and degrees, as ``web/kinematics.js`` takes it."""
    chain = link_chain(machine)
    return {
        "key": machine.key,
        "name": machine.name,
        "partAxes": chain.part_axes,
        "zero": machine.workpiece_zero,
        "gauge": machine.spindle_point,
        "spindle": machine.spindle_direction,
        "axes": [
            {
                "name": axis.name,
                "rotary": axis.is_rotary,
                "direction": chain.direction[k].tolist(),
                "point": chain.point[k].tolist(),
                "low": axis.low if math.isfinite(axis.low) and not axis.endless else None,
                "high": axis.high if math.isfinite(axis.high) and not axis.endless else None,
                "rapid": axis.rapid,
                "placed": machine.is_placed(k),
                "displayLow": None if math.isnan(axis.display_low) else axis.display_low,
            }
            for k, axis in machine.own_columns
        ],
    }


def body_scene(body: Body, machine: Machine) -> dict[str, Any]:
    """Name, link, kind, tool and colour of a body."""
    own = next((each.colour for each in machine.bodies if each.name == body.name), None)
    colour = own if body.kind is BodyKind.MACHINE and own else _COLOURS.get(body.kind, "#9aa0a6")
    tool = body.tool if body.kind in (BodyKind.CUTTER, BodyKind.SHANK, BodyKind.HOLDER) else None
    return {"name": body.name, "link": body.link, "kind": str(body.kind), "tool": tool, "colour": colour}


def _events(run: Run) -> Iterator[Mark]:
    """Tool changes and stops, with the row before which they happen."""
    for event in run.events:
        if event.kind in ("tool", "tool_change", "stop"):
            yield Mark(event.kind, event.before_row, event.line, event.file, str(event.value))


def _rewinds(run: Run) -> list[Mark]:
    """Rapids in which a rotary axis turns by more than half a turn: the way back of one that has wound itself up."""
    joints = np.vstack([run.start[None], run.joints])
    turned = np.abs(np.diff(joints[:, list(run.machine.rotary)], axis=0)).max(axis=1, initial=0.0)
    rows = np.flatnonzero((turned > _REWIND) & (run.kind == Kind.RAPID))
    return [Mark.at(run, "rewind", row) for row in rows.tolist()]


def _findings(checks: Sequence[Check], rows: DrivenRows) -> Iterator[Mark]:
    """Yield the places of the checks that have not passed, as rows."""
    run = rows.run
    numbers = {name: k for k, name in enumerate(run.files)}
    for check in checks:
        for place in () if check.passed else check.places[:_MOST_PLACES]:
            file = numbers.get(place.nc_file, 0)
            row = rows.row(place.row) if place.row >= 0 else _row_of(run, file, place.nc_line)
            yield Mark(check.key, row, place.nc_line, file, place.said)


def _row_of(run: Run, file: int, line: int) -> int:
    """Return the row at a line: the first one of that line, else of the nearest line after it that moves, else before
    it.

    Rows are in the order in which the program runs, which is not that of lines where there are subprograms and jumps.
    """
    rows = np.flatnonzero(run.file == file)
    if not len(rows):
        return max(len(run) - 1, 0)
    lines = run.line[rows]
    after = lines[lines >= line]
    return int(rows[np.argmax(lines == (after.min() if len(after) else lines.max()))])


def _diagnostics(run: Run) -> Iterator[Mark]:
    """Yield what the reader did not understand, at its line."""
    numbers = {name: k for k, name in enumerate(run.files)}
    for each in run.errors:
        file = numbers.get(each.file, 0)
        text = each.wording.with_cure()
        text = text.within("with_code", code=each.code) if each.code else text
        yield Mark("word", _row_of(run, file, each.line), each.line, file, text)
