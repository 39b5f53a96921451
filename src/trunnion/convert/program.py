"""From what a control did with a program back to the ``Toolpath`` that asks for it.

In:     a ``Run`` (what the reader found out), the program's text, and the definition of the control that it was written
        for: its templates say what the lines of a head mean, its ``phases`` what the comments between motions mean.
Out:    operations in the workpiece frame, mm, and the settings that a toolpath has no place for.

What belongs to the machine and not to the part is left out: moves to machine positions, and the placing of the rotary
axes before an operation's first position.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from trunnion.arrays import Ints
from trunnion.control.definition import Control
from trunnion.convert.events import Events
from trunnion.convert.heads import Head, marker, match, patterns
from trunnion.convert.points import DECIMALS, arcs_of, feeds_of, points_of, rests, with_rests
from trunnion.convert.source import Source
from trunnion.convert.timeline import Item, items
from trunnion.errors import Problem, Severity
from trunnion.reader import Run, Written
from trunnion.reader.sinumerik.words import G_SILENT, SILENT
from trunnion.toolpath import Frame, Kind, Moves, Operation, Phase, Tool, Toolpath

#: Remarks of one kind that are made one by one.
_NAMED = 5

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

#: Words without effect on the path that every operation says, or that are said by other means.
_SAID_ANYHOW = frozenset({"G40", "G60", "G601", "FNORM"})


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
        Of the reader. Its first file is looked into once more for the lines of heads.
    control
        Of the machine that the program was written for.
    """
    return _Converter(run, control).convert()


@dataclass(slots=True)
class _Stretch:
    """The part of a program that becomes an operation: its items, its rows ``first`` to ``stop``, and its lines.

    The rows go from ``first`` to ``stop``, the lines from ``line`` to ``end_line``. ``end`` counts the items before the
    comment that ends the path.
    """

    line: int
    first: int
    stop: int = 0
    end_line: int = 0
    end: int | None = None
    items: list[Item] = field(default_factory=list)
    kept: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    head: Head = field(default_factory=Head)


class _Converter:
    """Converts one program; what is in force goes on from one operation to the next."""

    def __init__(self, run: Run, control: Control) -> None:
        self._run = run
        self._control = control
        self._file = run.files[0]
        self._source = Source(run)
        self._remarks: list[Problem] = []
        self._settings: dict[str, str] = {}
        axes = run.machine.axes
        self._letters = axes[run.machine.primary].name, axes[run.machine.secondary].name
        self._start = marker(control.templates["operation_start"]).strip()
        ends = ("operation_end_five_axis", "operation_end_three_axis")
        self._ends = {marker(control.templates[name]).strip() for name in ends} - {""}
        self._phases: dict[str, Phase] = {}
        for name, phase in _PHASES.items():
            if spoken := control.phases.get(name, "").removeprefix(";").strip():
                self._phases.setdefault(spoken, phase)

    def convert(self) -> Converted:
        """The whole program."""
        run, control = self._run, self._control
        anyhow = {f"G{code}" for code in control.in_force.values()}
        said = items(run, self._source, anyhow, self._ends, self._remark)
        self._marked = bool(self._start) and any(self._text_of(item) == self._start for item in said)
        coolants: dict[int, str] = {}
        for word in (word for word in ("OFF", "ON", *control.coolant) if word in control.coolant):
            coolants.setdefault(control.coolant[word], word)
        self._events = Events(self._phases, coolants, self._marked, self._remark)
        stretches = self._stretches(said)
        for stretch in stretches:
            stretch.kept = self._kept_rows(stretch)
        self._match_heads(stretches)
        self._hand_over(stretches)
        full = [stretch for stretch in stretches if len(stretch.kept)]
        operations = tuple(self._operation(stretch) for stretch in full)
        self._collect_settings(full)
        self._remark_silent(full)
        self._remark_poles(full)
        part = self._settings.get("part", "")
        return Converted(Toolpath(self._file, operations, part), self._settings, tuple(self._remarks))

    def _remark(self, line: int, what: str, cure: str = "") -> None:
        self._remarks.append(Problem(self._file, line, what, cure, Severity.WARNING))

    @staticmethod
    def _text_of(item: Item) -> str:
        """The text of a comment; nothing for other items."""
        return str(item.value).strip() if item.kind == "comment" else ""

    def _stretches(self, items: Iterable[Item]) -> list[_Stretch]:
        """Cut the program where operations begin: at their first line, or where there is none, at tool changes."""
        stretches = [_Stretch(1, 0)]
        for item in items:
            text = str(item.value).strip() if item.kind == "comment" else ""
            begins = text == self._start.strip() if self._marked else item.kind == "tool_change"
            if begins:
                stretches[-1].stop = item.row
                stretches[-1].end_line = stretches[-1].end_line or item.line
                stretches.append(_Stretch(item.line, item.row))
            elif self._marked and text in self._ends and stretches[-1].end is None:
                stretches[-1].end = len(stretches[-1].items)
                stretches[-1].end_line = item.line
            stretches[-1].items.append(item)
        stretches[-1].stop = len(self._run)
        stretches[-1].end_line = stretches[-1].end_line or self._source.count + 1
        return stretches

    def _kept_rows(self, stretch: _Stretch) -> Ints:
        """The rows that move the tool at the part."""
        run = self._run
        rows = np.arange(stretch.first, stretch.stop)
        moved = ~run.machine_frame[rows]
        inside = np.flatnonzero(moved)
        if not len(inside):
            return rows[:0]
        placed = (run.programmed[rows] & (Written.X | Written.Y | Written.Z)) != 0
        begin = np.flatnonzero(moved & placed)
        if not len(begin):
            return rows[:0]
        first = int(begin[0])
        if run.kind[rows[first]] == Kind.ARC and first + stretch.first:
            moved[first - 1] = first > 0  # an arc needs the place where it begins
            first = max(first - 1, 0)
        gone = np.flatnonzero(~moved[first:])
        last = int(inside[-1])
        if len(gone) and first + gone[0] < last:
            line = int(run.block[rows[first + gone[0]]])
            self._remark(line, "moves to machine positions within an operation are left out")
        moved[:first] = False
        return rows[moved]

    def _match_heads(self, stretches: Sequence[_Stretch]) -> None:
        """Find the lines of templates, and what they say."""
        templates = self._control.templates
        start = patterns([templates["program_start"]], *self._letters)
        names = ("operation_start", "first_tool", "tool_change", "approach_five_axis", "approach_three_axis")
        head = patterns([templates[name] for name in names], *self._letters)
        ends = ("operation_end_five_axis", "operation_end_three_axis", "program_end")
        tail = patterns([templates[name] for name in ends], *self._letters)
        for k, stretch in enumerate(stretches):
            next_line = stretches[k + 1].line if k + 1 < len(stretches) else self._source.count + 1
            if k == 0:
                match(self._source.texts(1, next_line), start, stretch.head)
            if len(stretch.kept) and self._run.file[stretch.kept].max() == 0:
                first, last = (int(self._run.block[stretch.kept[end]]) for end in (0, -1))
                match(self._source.texts(stretch.line, first), head, stretch.head)
                match(self._source.texts(last + 1, next_line), tail, stretch.head)

    def _hand_over(self, stretches: Sequence[_Stretch]) -> None:
        """What stands outside all operations goes to the next one, and after the last to the last."""
        waiting: list[Item] = []
        last: _Stretch | None = None
        for k, stretch in enumerate(stretches):
            inside = stretch.items if stretch.end is None else stretch.items[: stretch.end]
            behind = [] if stretch.end is None else stretch.items[stretch.end :]
            behind = [item for item in behind if self._matters(item, stretch)]
            if len(stretch.kept):
                stretch.items = [*waiting, *inside]
                stretch.head.values = {**(stretches[0].head.values if k else {}), **stretch.head.values}
                waiting, last = behind, stretch
            else:
                waiting += [item for item in inside if self._matters(item, stretch)] + behind
        if last is not None:
            for item in waiting:
                if item.kind == "tool_change":
                    what = f"the tool change to {item.value} after the last operation is not carried over"
                    self._remark(item.line, what)
            last.items += [item for item in waiting if item.kind not in ("tool", "tool_change")]

    def _matters(self, item: Item, stretch: _Stretch) -> bool:
        """Whether an item outside an operation's path has anything to say to another operation."""
        if item.file == 0 and item.line in stretch.head.lines:
            return False
        return not (item.kind == "coolant" and item.value == "off") and item.kind not in ("end", "cycle832")

    # Operations

    def _operation(self, stretch: _Stretch) -> Operation:
        run, source, values = self._run, self._source, stretch.head.values
        points = points_of(run, stretch.kept, source.in_order)
        if self._marked and source.in_order:
            said: dict[int, list[Item]] = {}
            for item in stretch.items:
                said.setdefault(item.line, []).append(item)
            still = rests(source, points, stretch.end_line, said, stretch.head.lines, set(self._phases))
            points = with_rests(points, still)
        feed, per_rev, lost = feeds_of(run, points)
        if lost:
            what = f"{len(lost)} blocks with G93 turn the tool about a tip that rests: they have no feed in mm/min"
            self._remark(lost[0], what, "their feed becomes 0")
        phase, events = self._events.of(stretch.items, points, stretch.head.lines, source.in_order, stretch.line)
        tool = self._tool_of(values)
        named = f"TOOL_{self._events.tool}" if self._events.tool else Path(self._file).stem
        tip = np.round(run.tip[points.row], DECIMALS) + 0.0
        return Operation(
            name=values.get("operation", "") or named,
            tool=tool,
            frame=Frame(),
            moves=Moves(tip, run.axis[points.row], points.kind, phase, feed, per_rev, points.line),
            arcs=arcs_of(run, points),
            events=tuple(events),
            line=stretch.line,
            intol=_float(values.get("intol")),
            outtol=_float(values.get("outtol")),
        )

    def _tool_of(self, values: dict[str, str]) -> Tool:
        kinds = {text: kind for kind, text in self._control.tool_types.items()}
        kind = kinds.get(values.get("tool_type", ""), "UNKNOWN")
        diameter = _float(values.get("tool_diameter"))
        if kind == "BALL" or (kind == "UNKNOWN" and diameter):
            kind = "MILL"
        name = values.get("tool_name", "")
        if self._events.tool and (not self._events.tool.isdigit() or values.get("tool", "").startswith('"')):
            name = name or self._events.tool
            if name == self._events.tool:
                self._settings["tool_call"] = "name"
            else:
                self._settings["tool"] = f'"{self._events.tool}"'
        return Tool(
            kind=kind,
            name=name,
            diameter=diameter or 0.0,
            corner_radius=_float(values.get("tool_corner_radius")) or 0.0,
            length=_float(values.get("tool_length")) or 0.0,
        )

    # Settings

    def _collect_settings(self, stretches: Sequence[_Stretch]) -> None:
        """The settings that make the same heads again."""
        control = self._control
        merged: dict[str, str] = {}
        for stretch in stretches:
            values = dict(stretch.head.values)
            values.setdefault("work_offset", self._offset(stretch))
            given = {name: value for name, value in values.items() if name in control.settings}
            given.pop("tool", None)
            method = given.get("method", control.settings.get("method", "")).upper()
            usual = next((mode for part, mode in control.kinds if part.upper() in method), None)
            if given.get("cycle832") == usual:
                given.pop("cycle832", None)
            intol, outtol = _float(values.get("intol")), _float(values.get("outtol"))
            fallback = _float(control.settings.get("fallback_tolerance")) or 0.0
            expected = intol + outtol if intol is not None and outtol is not None else fallback
            tolerance = _float(given.get("tolerance"))
            if tolerance is None or abs(tolerance - expected) < 5e-6:
                given.pop("tolerance", None)
            for name, value in given.items():
                if merged.setdefault(name, value) != value:
                    what = f"{name} is {value!r} here and {merged[name]!r} before; one program has one"
                    self._remark(stretch.line, what, f"the first is taken; see --set {name}=…")
        for name, value in merged.items():
            if value and not _same(value, control.settings[name]):
                self._settings.setdefault(name, value)

    def _offset(self, stretch: _Stretch) -> str:
        """The work offset in force at the first row."""
        code = int(self._run.offset[stretch.kept[0]])
        return f"G{code}" if code else self._control.settings.get("work_offset", "")

    # Remarks

    def _remark_silent(self, stretches: Sequence[_Stretch]) -> None:
        """Say which words on the way of operations only drive the machine: a toolpath has no place for them."""
        if not self._source.in_order:
            return
        told = 0
        for stretch in stretches:
            first, last = (int(self._run.block[stretch.kept[end]]) for end in (0, -1))
            for number in self._source.resting(first, last, stretch.kept, stretch.head.lines):
                words = [word for word in self._source.words(number) if word not in _SAID_ANYHOW]
                lost = [w for w in words if w in SILENT or (w[0] == "G" and w[1:].isdigit() and int(w[1:]) in G_SILENT)]
                told += bool(lost)
                if lost and told <= _NAMED:
                    self._remark(number, f"{' '.join(lost)} is not carried over", "say it in a template")
        if told > _NAMED:
            self._remark(0, f"and {told - _NAMED} more lines with words that are not carried over")

    def _remark_poles(self, stretches: Sequence[_Stretch]) -> None:
        """Say where the axis next to the workpiece turns under a tool that stands along it."""
        run = self._run
        first = run.machine.rotary[0]
        axis = run.machine.axes[first]
        if run.machine.linear[0] < first:
            return  # slides below it: there is no one direction of the part
        direction = np.array(axis.direction)
        for stretch in stretches:
            rows = stretch.kept
            along = np.linalg.norm(np.cross(run.axis[rows], direction), axis=1) < 1e-7
            if not along.any():
                continue
            before = np.concatenate(([axis.home], run.joints[rows[:-1], first]))
            turned = np.flatnonzero(along & (np.abs((run.joints[rows, first] - before + 180) % 360 - 180) > 1e-6))
            if len(turned):
                what = (
                    f"{axis.name} turns at {len(turned)} points where the tool stands along it, which no tool axis says"
                )
                self._remark(int(run.block[rows[turned[0]]]), what, "the axis stays where it is there")


def _float(text: str | None) -> float | None:
    try:
        return float(text) if text else None
    except ValueError:
        return None


def _same(a: str, b: str) -> bool:
    """Whether two settings say the same, as text or as numbers."""
    first, second = _float(a), _float(b)
    return a == b or (first is not None and first == second)
