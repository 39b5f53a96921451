"""From what a control did with a program back to the ``Toolpath`` that asks for it.

In:     a ``Run`` (what the reader found out), the program's text, and the definition of the control that it was written
        for: its templates say what the lines of a head mean, its ``phases`` what the comments between motions mean.
Out:    operations in the workpiece frame, mm, and the settings that a toolpath has no place for.

What belongs to the machine and not to the part is left out: moves to machine positions, and the placing of the rotary
axes before an operation's first position.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from trunnion.arrays import Ints
from trunnion.control.definition import Control
from trunnion.control.template import Template
from trunnion.convert.events import Events
from trunnion.convert.heads import marker, match, patterns
from trunnion.convert.lost import Remarks, remark_homes, remark_poses, remark_registers, remark_ways, remark_words
from trunnion.convert.moves import arcs_of, moves_of
from trunnion.convert.said import Item, items
from trunnion.convert.settings import number, settings_of
from trunnion.convert.source import Source
from trunnion.errors import Problem
from trunnion.reader import Run, Written
from trunnion.toolpath import Frame, Kind, Operation, Phase, Tool, Toolpath

_PHASES = {
    "rapid": Phase.RAPID,
    "approach": Phase.APPROACH,
    "engage": Phase.ENGAGE,
    "cut": Phase.CUT,
    "stepover": Phase.STEPOVER,
    "retract": Phase.RETRACT,
    "departure": Phase.DEPARTURE,
    "traverse": Phase.TRAVERSE,
}
#: How the templates of an operation's head and of its end are called; those of kinds of operations by what follows.
_HEADS = ("operation_start", "first_tool", "tool_change", "approach_", "plane_on_")
_ENDS = ("operation_end_",)


@dataclass(frozen=True, slots=True, eq=False)
class Converted:
    """A program as a toolpath.

    settings  what the program says and a toolpath has no place for, as ``--set`` takes it; only what is not the default
    remarks   what does not survive the way back
    """

    toolpath: Toolpath
    settings: dict[str, str]
    remarks: tuple[Problem, ...]


def convert(run: Run, control: Control) -> Converted:
    """Turn a program that was read without errors into a toolpath.

    Parameters
    ----------
    run
        Of the reader. Its files are looked into once more for what the columns do not hold.
    control
        Of the machine that the program was written for.
    """
    return _Converter(run, control).convert()


@dataclass(slots=True)
class _Part:
    """The part of a program that becomes an operation.

    line    where it begins
    begin   items from here on are said in it
    end     up to here; behind it the path has ended
    first   row of the run where it begins
    stop    row behind it
    rows    (n,) rows that move the tool at the workpiece
    values  what its head says
    """

    line: int
    begin: int
    first: int
    end: int = -1
    stop: int = 0
    rows: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    values: dict[str, str] = field(default_factory=dict)


class _Converter:
    """Converts one program."""

    def __init__(self, run: Run, control: Control) -> None:
        self._run = run
        self._control = control
        self._source = Source(run.files[0])
        self._remark = Remarks(run.files)
        axes = run.machine.axes
        self._letters = axes[run.machine.primary].name, axes[run.machine.secondary].name
        self._known: set[int] = set()
        # M number -> CL word; of words with one number OFF, ON and then the first
        self._coolants: dict[int, str] = {}
        for word in ("OFF", "ON", *control.coolant):
            if word in control.coolant:
                self._coolants.setdefault(control.coolant[word], word)

    def convert(self) -> Converted:
        """The whole program."""
        run, control = self._run, self._control
        said = items(run, self._source, self._remark)
        start = marker(control.templates["operation_start"])
        marked = bool(start) and any(item.text == start for item in said)
        parts = self._parts(said, start if marked else "")
        self._match_heads(parts)
        events = Events(self._phases(), self._coolants, self._known, marked, self._remark)
        owned = self._share(said, parts)
        operations = tuple(self._operation(part, own, events) for part, own in zip(parts, owned, strict=True))
        settings = settings_of(control, [(part.line, part.values) for part in parts], self._remark)
        rows = [part.rows for part in parts]
        remark_homes(run, self._remark)
        remark_registers(run, rows, self._remark)
        remark_ways(run, rows, self._remark)
        remark_poses(run, zip(rows, (operation.moves for operation in operations), strict=True), self._remark)
        remark_words(run.files, self._known, self._remark)
        return Converted(Toolpath(run.files[0], operations, settings.get("part", "")), settings, self._remark.problems)

    def _phases(self) -> dict[str, Phase]:
        """Comment -> phase; of phases with one comment the first."""
        found: dict[str, Phase] = {}
        for name, phase in _PHASES.items():
            if spoken := self._control.phases.get(name, "").removeprefix(";").strip():
                found.setdefault(spoken, phase)
        return found

    # Parts

    def _called(self, names: tuple[str, ...]) -> list[Template]:
        """The templates whose names begin so, in the order of ``names``."""
        templates = self._control.templates
        return [templates[key] for name in names for key in templates if key.startswith(name)]

    def _parts(self, said: Sequence[Item], start: str) -> list[_Part]:
        """Cut the program where operations begin: at the comment ``start``, or without one at tool changes."""
        ends = {marker(template) for template in self._called(_ENDS)} - {""}
        parts = [_Part(1, 0, 0)]
        for k, item in enumerate(said):
            last = parts[-1]
            if (item.text == start) if start else (item.kind == "tool_change"):
                last.stop = item.row
                last.end = k if last.end < 0 else last.end
                parts.append(_Part(item.line, k, item.row))
            elif start and item.text in ends and last.end < 0:
                last.end = k
        parts[-1].stop = len(self._run)
        parts[-1].end = len(said) if parts[-1].end < 0 else parts[-1].end
        for part in parts:
            part.rows = self._rows(part)
        return [part for part in parts if len(part.rows)]

    def _rows(self, part: _Part) -> Ints:
        """The rows that move the tool at the workpiece."""
        run = self._run
        rows = np.arange(part.first, part.stop)
        moved = ~run.machine_frame[rows]
        placed = moved & ((run.programmed[rows] & (Written.X | Written.Y | Written.Z)) != 0)
        if not placed.any():
            return rows[:0]
        begin = int(np.argmax(placed))
        last = int(np.flatnonzero(moved)[-1])
        gone = begin + np.flatnonzero(~moved[begin:last])
        if len(gone):
            row = int(rows[gone[0]])
            what = "moves to machine positions within an operation are left out"
            self._remark(int(run.block[row]), what, file=int(run.file[row]))
        kept = begin + np.flatnonzero(moved[begin:])
        if run.kind[rows[begin]] == Kind.ARC and rows[begin] > 0:
            return np.concatenate(([rows[begin] - 1], rows[kept]))  # an arc needs the place where it begins
        return rows[kept]

    def _match_heads(self, parts: Sequence[_Part]) -> None:
        """Find the lines of templates, and what they say."""
        templates, run = self._control.templates, self._run
        start = patterns([templates["program_start"]], *self._letters)
        head = patterns(self._called(_HEADS), *self._letters)
        tail = patterns([*self._called(_ENDS), templates["program_end"]], *self._letters)
        common: dict[str, str] = {}
        for k, part in enumerate(parts):
            after = parts[k + 1].line if k + 1 < len(parts) else self._source.count + 1
            first, last = (
                int(run.block[part.rows[end]]) if run.file[part.rows[end]] == 0 else after for end in (0, -1)
            )
            if k == 0:
                self._known |= match(self._source.texts(1, part.line if part.line > 1 else first), start, common)
            self._known |= match(self._source.texts(part.line, first), head, part.values)
            self._known |= match(self._source.texts(last + 1, after), tail, part.values)
            plane = {"plane": "frames"} if "plane_x" in part.values and "swivel_style" not in part.values else {}
            part.values = {**common, **part.values, **plane, **self._registers(part)}

    def _registers(self, part: _Part) -> dict[str, str]:
        """Work offset and edge in force at the first row."""
        offset, edge = int(self._run.offset[part.rows[0]]), int(self._run.edge[part.rows[0]])
        return ({"work_offset": f"G{offset}"} if offset else {}) | ({"edge": str(edge)} if edge >= 0 else {})

    def _share(self, said: Sequence[Item], parts: Sequence[_Part]) -> list[list[Item]]:
        """What is said in each operation; what stands outside of all belongs to the next, or else to the last."""
        owned: list[list[Item]] = []
        at = 0
        for k, part in enumerate(parts):
            stop = part.end if k + 1 < len(parts) else len(said)
            inside = range(part.begin, part.end)
            own = [said[n] for n in range(at, stop) if n in inside or self._matters(said[n])]
            row = int(part.rows[0])
            running = self._running(said[: part.begin])
            if running and not any(item.row <= row and self._is_coolant(item) for item in own):
                own.insert(0, running._replace(row=row))
            owned.append(own)
            at = stop
        return owned

    def _running(self, said: Sequence[Item]) -> Item | None:
        """What turned the coolant on that runs after all this; every operation of a toolpath asks for its own."""
        last = next((item for item in reversed(said) if self._is_coolant(item)), None)
        return None if last is None or last.value == "off" else last

    def _is_coolant(self, item: Item) -> bool:
        return item.kind == "coolant" or (item.kind == "m" and item.value in self._coolants)

    def _matters(self, item: Item) -> bool:
        """Whether an item outside an operation's path has anything to say to another operation."""
        if item.file == 0 and item.line in self._known:
            return False
        return not (item.kind == "coolant" and item.value == "off") and item.kind not in ("end", "cycle832")

    # Operations

    def _operation(self, part: _Part, said: Sequence[Item], events: Events) -> Operation:
        run, values = self._run, part.values
        phase, happened = events.of(said, run, part.rows, part.line)
        named = f"TOOL_{events.tool}" if events.tool else Path(run.files[0]).stem
        return Operation(
            name=values.get("operation", "") or named,
            tool=self._tool(values, events.tool),
            frame=Frame(),
            moves=moves_of(run, part.rows, phase, self._remark),
            arcs=arcs_of(run, part.rows),
            events=happened,
            line=part.line,
            intol=number(values.get("intol")),
            outtol=number(values.get("outtol")),
        )

    def _tool(self, values: dict[str, str], called: str) -> Tool:
        """The cutter; ``values`` gets the settings that call it as the program does, by ``called``."""
        kinds = {text: kind for kind, text in self._control.tool_types.items()}
        kind = kinds.get(values.get("tool_type", ""), "UNKNOWN")
        diameter = number(values.get("tool_diameter"))
        if kind == "BALL" or (kind == "UNKNOWN" and diameter):
            kind = "MILL"
        by_name = bool(called) and (not called.isdigit() or values.get("tool", "").startswith('"'))
        values.pop("tool", None)
        name = values.get("tool_name", "") or (called if by_name else "")
        if called:
            values["tool_call"] = "name" if by_name and name == called else "number"
        if by_name and name != called:
            values["tool"] = f'"{called}"'
        return Tool(
            kind=kind,
            name=name,
            diameter=diameter or 0.0,
            corner_radius=number(values.get("tool_corner_radius")) or 0.0,
            length=number(values.get("tool_length")) or 0.0,
        )
